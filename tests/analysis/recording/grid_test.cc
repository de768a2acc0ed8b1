#include "analysis/recording/grid.h"

#include <gtest/gtest.h>

#include "config/config_error.h"

namespace contour::diagnosis {
namespace {

std::vector<std::size_t> Lines(std::size_t count) {
  std::vector<std::size_t> lines;
  for (std::size_t i = 0; i < count; ++i) lines.push_back(i + 2);
  return lines;
}

Grid Find(const std::vector<double>& time_s) { return FindGrid("f.csv", time_s, Lines(time_s.size())); }

std::string Error(const std::vector<double>& time_s) {
  try {
    Find(time_s);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(Grid, RowsThatAreMissingLeaveTheirPlaces) {
  const Grid grid = Find({5.0, 5.002, 5.004, 5.010, 5.012});
  EXPECT_DOUBLE_EQ(grid.period_s, 2e-3);
  EXPECT_EQ(grid.index, (std::vector<std::size_t>{0, 1, 2, 5, 6}));
}

TEST(Grid, WhatIsNearlyAMicrosecondIsOneAndOtherPeriodsStay) {
  EXPECT_EQ(Find({0.0, 0.0010000001, 0.002, 0.003}).period_s, 1e-3);
  EXPECT_NEAR(Find({0.0, 1.0 / 3000, 2.0 / 3000, 3.0 / 3000}).period_s, 1.0 / 3000, 1e-12);
}

TEST(Grid, TheMeanOverTheWholeCountsNotTheMedianStep) {
  // A clock that reads 1.00 ms nearly always and 1.01 ms now and then.
  std::vector<double> time_s = {0.0};
  for (int i = 0; i < 1000; ++i) time_s.push_back(time_s.back() + (i % 10 == 0 ? 1.1e-3 : 1e-3));
  EXPECT_NEAR(Find(time_s).period_s, 1.01e-3, 1e-9);
}

TEST(Grid, TimeThatStandsGoesBackOrIsOffTheGridIsNamedWithItsLine) {
  EXPECT_NE(Error({0.0, 1e-3, 1e-3}).find("f.csv:4: time_s"), std::string::npos);
  EXPECT_NE(Error({0.0, 2e-3, 1e-3}).find("expected time to go on"), std::string::npos);
  EXPECT_NE(Error({0.0, 1e-3, 2e-3, 3e-3, 3.2e-3, 5e-3}).find("f.csv:6: time_s"), std::string::npos);
  EXPECT_NE(Error({0.0, 1e-3, 2e-3, 3.4e-3, 4e-3, 5e-3}).find("off a grid"), std::string::npos);
  EXPECT_NE(Error({0.0, 1e-3}).find("fewer than three rows"), std::string::npos);
}

TEST(Grid, TimesOfTooFewDigitsAreToldFromAClockThatGoesBack) {
  const std::string still = Error({0.0, 0.0, 0.01, 0.01, 0.02});
  EXPECT_NE(still.find("2 of 4 times are those of the row before"), std::string::npos) << still;
  EXPECT_NE(still.find("--sample-rate HZ, on the mean 200 Hz"), std::string::npos) << still;
  EXPECT_EQ(Error({0.0, 2e-3, 1e-3}).find("--sample-rate"), std::string::npos);
  EXPECT_NE(Error({1.0, 1.0, 1.0}).find("--sample-rate HZ"), std::string::npos);
}

TEST(Grid, AfterAGapTheGridBeginsAnew) {
  std::vector<double> time_s;
  for (int i = 0; i < 50; ++i) time_s.push_back(1e-3 * i);
  for (int i = 0; i < 50; ++i) time_s.push_back(0.2364 + 1e-3 * i);  // off the first grid by 0.4 rows
  const Grid grid = Find(time_s);
  EXPECT_EQ(grid.period_s, 1e-3);
  EXPECT_EQ(grid.index[50], 236U);
  EXPECT_EQ(grid.index[99], 285U);
}

TEST(Grid, RowsThatComeAsTheyComeAreRefusedWithTheirSteps) {
  std::vector<double> time_s = {0.0};
  for (int i = 0; i < 200; ++i) time_s.push_back(time_s.back() + (i % 3 == 0 || i % 7 == 2 ? 12e-3 : 10e-3));
  const std::string error = Error(time_s);
  EXPECT_NE(error.find("10 to 12 ms"), std::string::npos) << error;
  EXPECT_NE(error.find("--resample 9"), std::string::npos) << error;
}

}  // namespace
}  // namespace contour::diagnosis
