#include "tools/improve/kept_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace contour::improve {
namespace {

Comparison Of(std::vector<double> before, std::vector<double> after) {
  return Compare({std::move(before), std::move(after)}, 0.005);
}

TEST(KeptModel, ADifferenceCountsBeyondTheScatterOfTheRepeats) {
  // Deviations of 0.100 and 0.168 in the logarithms, two means of three: 2.776 * 0.1386 * sqrt(2 / 3) =
  // 0.314.
  const Comparison c = Of({0.9, 1.0, 1.1}, {0.5, 0.6, 0.7});
  EXPECT_NEAR(c.log_chance, 0.314, 1e-3);
  EXPECT_NEAR(c.repeatability_um, 1.0 - std::exp(-0.314), 1e-3);
  EXPECT_TRUE(c.better());
  EXPECT_FALSE(c.worse());
  EXPECT_FALSE(Of({0.9, 1.0, 1.1}, {0.7, 0.8, 0.9}).better());
  EXPECT_TRUE(Of({0.5, 0.6, 0.7}, {0.9, 1.0, 1.1}).worse());
}

// Before: one scatter in um, that of the old model, made a tenth of the error chance (4.1 um of 3.6).
TEST(KeptModel, ATenthOfTheErrorIsNoChanceHoweverTheOldModelScatters) {
  EXPECT_TRUE(Compare({{2.5, 2.7, 5.7}, {0.37, 0.36, 0.38}}, 0.005, 2).better());
  EXPECT_FALSE(Compare({{2.5, 2.7, 5.7}, {2.2, 3.9, 2.4}}, 0.005, 2).better());
}

TEST(KeptModel, WhatIsLargerInTheMeanIsNotBetterForItsLogarithms) {
  std::vector<double> after(9, 0.3);
  after.push_back(12.0);
  const Comparison c = Of(std::vector<double>(10, 1.0), after);
  ASSERT_LT(c.log_ratio, 0.0);
  EXPECT_FALSE(c.better());
}

TEST(KeptModel, AnErrorOfNothingCountsAsTheResolution) {
  EXPECT_TRUE(Of({1.0, 1.01}, {0.0, 0.0}).better());
  EXPECT_FALSE(Of({0.0, 0.0}, {0.004, 0.003}).worse());
}

TEST(KeptModel, QuantilesAreThoseOfTables) {
  EXPECT_NEAR(StudentQuantile(2, 0.025), 4.303, 1e-3);
  EXPECT_NEAR(StudentQuantile(4, 0.025), 2.776, 1e-3);
  EXPECT_NEAR(StudentQuantile(10, 0.025), 2.228, 1e-3);
  EXPECT_NEAR(StudentQuantile(4, 0.0125), 3.495, 1e-3);
  EXPECT_NEAR(StudentQuantile(4, 0.005), 4.604, 1e-3);
  EXPECT_NEAR(StudentQuantile(1, 0.1), 3.078, 2e-3);
}

TEST(KeptModel, OfSeveralModelsEachMustBeBetterByMore) {
  const Repeats r{{0.9, 1.0, 1.1}, {0.6, 0.7, 0.8}};
  EXPECT_TRUE(Compare(r, 0.005, 1).better());
  EXPECT_FALSE(Compare(r, 0.005, 4).better());
}

/// Many candidates make it hard to prove that one is better, but no easier to be higher on the path.
TEST(KeptModel, APathThatIsHigherByADeviationIsReasonEnough) {
  const Comparison check = Compare({{1.0, 1.01, 0.99}, {0.5, 0.51, 0.49}}, 0.005, 6);
  const Comparison higher = Compare({{1.06, 1.02, 0.99}, {1.0, 1.1, 1.34}}, 0.005, 6);
  EXPECT_FALSE(higher.worse());
  EXPECT_FALSE(Judge(higher, check).keep);
  const Comparison alike = Compare({{1.06, 1.02, 0.99}, {1.0, 1.03, 1.07}}, 0.005, 6);
  EXPECT_TRUE(Judge(alike, check).keep);
}

TEST(KeptModel, RepeatsThatAreAlikeToTheLastBitStillHaveTheResolution) {
  EXPECT_FALSE(Of({1.0, 1.0}, {0.996, 0.996}).better());
  EXPECT_TRUE(Of({1.0, 1.0}, {0.99, 0.99}).better());
}

TEST(KeptModel, OnePassTellsNothingOfRepeatability) {
  EXPECT_THROW(Of({1.0}, {0.5, 0.5}), std::invalid_argument);
  EXPECT_THROW(Of({1.0, 1.0}, {0.5}), std::invalid_argument);
}

TEST(KeptModel, KeptWhereTheUnseenProgramIsBetterAndThePathNotWorse) {
  const Comparison better = Of({1.0, 1.01, 0.99}, {0.5, 0.51, 0.49});
  const Comparison worse = Of({0.5, 0.51, 0.49}, {1.0, 1.01, 0.99});
  const Comparison same = Of({1.0, 1.1, 0.9}, {1.0, 1.1, 0.9});
  EXPECT_TRUE(Judge(better, better).keep);
  EXPECT_TRUE(Judge(same, better).keep);
  EXPECT_FALSE(Judge(better, same).keep) << "fitted, and no better where it was not";
  EXPECT_FALSE(Judge(better, worse).keep);
  EXPECT_FALSE(Judge(worse, better).keep);
  EXPECT_NE(Judge(better, same).why.find("beyond repeatability"), std::string::npos);
}

}  // namespace
}  // namespace contour::improve
