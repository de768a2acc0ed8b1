#include "analysis/diagnosis/decision/evidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/analysis/support/fitted_axis.h"

namespace contour::diagnosis {
namespace {

class EvidenceTest : public testing::Test {
 protected:
  EvidenceTest() {
    options_.evidence = [this](const Evidence& e) { told_.push_back(e); };
    accepted_.fit = axis_.base;
    accepted_.explained = 77.0;
    threshold_.accepted = 2;
  }

  test::FittedAxis axis_;
  ScoreThreshold threshold_{.flips = 21.0, .calibrated = 20.0};
  Accepted accepted_;
  DiagnoseOptions options_;
  std::vector<Evidence> told_;
};

TEST_F(EvidenceTest, EveryKindIsToldOnceWithItsBestPlace) {
  std::vector<Scored> scored =
      ScoreEffects(axis_.problem, axis_.base, {axis_.Of("cable_spring"), axis_.Of("input_delay")});
  scored[0].drop = 50.0;
  scored[1].drop = 40.0;  // the shorter one of the first
  TellEvidence(axis_.problem, accepted_, scored, {}, threshold_, options_);
  ASSERT_EQ(told_.size(), 2u);
  EXPECT_EQ(told_[0].kind, "cable_spring");
  EXPECT_EQ(told_[0].screened, 50.0);
  EXPECT_EQ(told_[0].accepted, 2);
  EXPECT_EQ(told_[0].explained, 77.0);
  EXPECT_FALSE(told_[0].in_base);
  EXPECT_EQ(told_[0].flips, 20.0);
  EXPECT_TRUE(std::isnan(told_[0].refitted) && std::isnan(told_[0].tested)) << "it was not fitted";
  EXPECT_EQ(told_[1].kind, "input_delay");
  EXPECT_TRUE(told_[1].in_base);
}

TEST_F(EvidenceTest, WhatWasFittedIsToldWithItsScore) {
  const std::vector<Scored> scored = ScoreEffects(axis_.problem, axis_.base, {axis_.Of("constant_torque")});
  Hypothesis h;
  h.fit = axis_.With(axis_.Of("constant_torque"));
  h.score = 15.0;
  TellEvidence(axis_.problem, accepted_, scored, {h}, threshold_, options_);
  ASSERT_EQ(told_.size(), 1u);
  EXPECT_NEAR(told_[0].refitted, 15.0 + Penalty(h.effect()), 1e-9);
  EXPECT_TRUE(std::isfinite(told_[0].tested) && std::isfinite(told_[0].unseen));
  told_.clear();
  h.given_up = true;
  TellEvidence(axis_.problem, accepted_, scored, {h}, threshold_, options_);
  EXPECT_TRUE(std::isnan(told_[0].refitted));
}

TEST_F(EvidenceTest, OfWhatIsLeftTheBestOfEachClassIsTold) {
  std::vector<RemainingStructure> left(3);
  left[0].structure_class = kUnexplainedTorque;
  left[0].score = 9.0;
  left[0].drop = 60.0;
  left[0].bins = 40.0;
  left[0].asked = 12.0;
  left[1].structure_class = kUnexplainedTorque;
  left[1].score = 4.0;
  left[2].structure_class = kUnexplainedAll;
  left[2].score = 1.0;
  TellStructure(accepted_, left, options_);
  ASSERT_EQ(told_.size(), 2u);
  for (const Evidence& e : told_) {
    if (e.kind != kUnexplainedTorque) continue;
    EXPECT_EQ(e.tested, 9.0);
    EXPECT_EQ(e.screened, 60.0);
    EXPECT_EQ(e.penalty, 40.0);
    EXPECT_EQ(e.asked, 12.0);
    EXPECT_EQ(e.unseen, 3.0);
  }
}

TEST_F(EvidenceTest, WhereNobodyAsksNothingIsDone) {
  options_.evidence = nullptr;
  TellEvidence(axis_.problem, accepted_, ScoreEffects(axis_.problem, axis_.base, {axis_.Of("input_delay")}),
               {}, threshold_, options_);
  TellStructure(accepted_, std::vector<RemainingStructure>(1), options_);
  EXPECT_TRUE(told_.empty());
}

}  // namespace
}  // namespace contour::diagnosis
