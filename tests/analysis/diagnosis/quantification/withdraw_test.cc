#include "analysis/diagnosis/quantification/withdraw.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "tests/analysis/support/fitted_axis.h"

namespace contour::diagnosis {
namespace {

/// A torque that is there, behind (or before) a spring that is not; sizes as Quantify would have told them.
class WithdrawTest : public testing::Test {
 protected:
  void Accept(const std::vector<std::string>& kinds) {
    Point point = axis_.base.point;
    for (const std::string& kind : kinds) {
      accepted_.places.push_back(point.effects.size());
      accepted_.scatter.push_back(1.0);
      point.effects.push_back(axis_.Of(kind));
      point.amplitudes.emplace_back(point.effects.back()->steps.size(), 0.0);
      out_.causes.emplace_back();
      out_.causes.back().kind = kind;
      out_.candidates.push_back({kind, 20.0, 20.0, true});
    }
    out_.blocks.emplace_back();
    fit_ = FitPoint(axis_.problem, point);
  }
  void Size(std::size_t cause, const std::string& name, const Interval& interval) {
    out_.causes[cause].parameters[name] = interval;
  }
  bool Withdraw() { return WithdrawIdle(axis_.problem, fit_, accepted_, out_); }

  test::FittedAxis axis_{{{"constant_torque", 0.3, 0.0, 0.0, 0.0}}};
  Fit fit_;
  Accepted accepted_;
  Diagnosis out_;
};

TEST_F(WithdrawTest, WhatIsZeroWithinItsIntervalGoesAndTheRestIsFittedAgain) {
  Accept({"cable_spring", "constant_torque"});
  Size(0, "torque_at_stroke_end_Nm", {-0.001, -0.003, 0.0005});
  Size(1, "torque_Nm", {0.02, 0.018, 0.022});
  const std::size_t parameters = ParameterCount(fit_.point);
  ASSERT_TRUE(Withdraw());
  ASSERT_EQ(out_.causes.size(), 1U);
  EXPECT_EQ(out_.causes[0].kind, "constant_torque");
  EXPECT_EQ(accepted_.places, std::vector<std::size_t>{0});
  EXPECT_EQ(accepted_.scatter.size(), 1U);
  ASSERT_EQ(fit_.point.effects.size(), 1U);
  EXPECT_EQ(fit_.point.effects[0]->kind, "constant_torque");
  EXPECT_LT(ParameterCount(fit_.point), parameters);
  const double torque_Nm = 0.3 * axis_.made.axis.stated.friction.Fc_plus;
  EXPECT_NEAR(fit_.point.amplitudes[0][0], torque_Nm, 0.1 * torque_Nm);
  EXPECT_EQ(fit_.covariance.rows(), static_cast<Eigen::Index>(ParameterCount(fit_.point)));
  EXPECT_FALSE(out_.candidates[0].accepted);
  EXPECT_TRUE(out_.candidates[1].accepted);
  EXPECT_TRUE(out_.blocks.empty()) << "they were those of the first";
  ASSERT_EQ(out_.notes.size(), 1U);
  EXPECT_NE(out_.notes[0].find("cable_spring"), std::string::npos);
  EXPECT_FALSE(Withdraw()) << "the torque is not zero";
}

// Before: an encoder's error inside its lines was told with a slope of 1.05, at which the reading runs
// backwards.
TEST_F(WithdrawTest, WhatTheFitTookToWhereNoSuchCauseCanBeGoes) {
  Accept({"constant_torque", "torque_saturation"});
  Size(0, "torque_Nm", {0.02, 0.018, 0.022});
  Size(1, "loss_at_rated_rel", {0.1, 0.08, 0.12});
  fit_.point.amplitudes[1][0] = 0.1;
  EXPECT_FALSE(Withdraw());
  // A torque that grows faster than its current, as no motor's does.
  fit_.point.amplitudes[1][0] = -0.1;
  Size(1, "loss_at_rated_rel", {-0.1, -0.12, -0.08});
  ASSERT_TRUE(Withdraw());
  ASSERT_EQ(out_.causes.size(), 1U);
  EXPECT_EQ(out_.causes[0].kind, "constant_torque");
  ASSERT_EQ(out_.notes.size(), 1U);
  EXPECT_NE(out_.notes[0].find("more than such a cause can have"), std::string::npos);
}

TEST_F(WithdrawTest, WhereASlowObserversFitEndedGoesAlong) {
  Accept({"cable_spring", "constant_torque"});
  Size(0, "torque_at_stroke_end_Nm", {-0.001, -0.003, 0.0005});
  Size(1, "torque_Nm", {0.02, 0.018, 0.022});
  accepted_.by_slow_observer = fit_.point;
  ASSERT_TRUE(Withdraw());
  ASSERT_EQ(accepted_.by_slow_observer.effects.size(), 1U);
  EXPECT_EQ(accepted_.by_slow_observer.effects[0]->kind, "constant_torque");
  EXPECT_EQ(accepted_.by_slow_observer.amplitudes.size(), 1U);
}

TEST_F(WithdrawTest, BesideAShapeFromOutsideTheCatalogueNothingGoes) {
  Accept({"cable_spring"});
  Size(0, "torque_at_stroke_end_Nm", {0.0001, -0.002, 0.002});
  out_.causes.emplace_back();
  out_.causes.back().kind = "outside:force of time";
  EXPECT_FALSE(Withdraw());
}

TEST_F(WithdrawTest, OneNumberBeyondZeroIsEnoughToStayWhereChanceIsOutOfTheQuestion) {
  Accept({"constant_torque", "friction_drift"});
  Size(0, "torque_Nm", {0.02, 0.018, 0.022});
  Size(1, "change_rel", {0.1, -0.1, 0.3});
  Size(1, "time_constant_s", {30.0, 10.0, 90.0});
  out_.causes[1].log_evidence_gain = 60.0;
  EXPECT_FALSE(Withdraw());
  EXPECT_EQ(out_.causes.size(), 2U);
  EXPECT_EQ(out_.blocks.size(), 1U);
  out_.causes[1].log_evidence_gain = 10.0;
  EXPECT_TRUE(Withdraw());
  EXPECT_EQ(out_.causes.size(), 1U);
}

// Before: a delay of -45 us (-97 to 3) stood before the saturation that it had been taken for.
TEST_F(WithdrawTest, ANumberOfTheModelGoesLikeAnyOtherCause) {
  Accept({"input_delay", "constant_torque"});
  Size(0, "delay_us", {-45.0, -97.0, 3.0});
  Size(1, "torque_Nm", {0.02, 0.018, 0.022});
  ASSERT_TRUE(Withdraw());
  ASSERT_EQ(out_.causes.size(), 1U);
  EXPECT_EQ(out_.causes[0].kind, "constant_torque");
  ASSERT_EQ(fit_.point.effects.size(), 1U);
  EXPECT_EQ(fit_.point.effects[0]->kind, "constant_torque");
}

TEST_F(WithdrawTest, AFactorOnAllForcesStays) {
  Accept({"torque_constant"});
  Size(0, "ratio", {0.1, -0.1, 0.3});
  EXPECT_FALSE(Withdraw());
}

TEST_F(WithdrawTest, TheLastOneOfAllMayGoToo) {
  Accept({"cable_spring"});
  Size(0, "torque_at_stroke_end_Nm", {0.0001, -0.002, 0.002});
  ASSERT_TRUE(Withdraw());
  EXPECT_TRUE(out_.causes.empty());
  EXPECT_TRUE(fit_.point.effects.empty());
  EXPECT_NEAR(fit_.cost, axis_.base.cost, 1.0);
}

TEST_F(WithdrawTest, JitterIsNotInTheFitAndCountsForNoPlace) {
  Accept({"constant_torque", "cable_spring"});
  Size(0, "torque_Nm", {0.02, 0.018, 0.022});
  Size(1, "torque_at_stroke_end_Nm", {0.0001, -0.002, 0.002});
  out_.causes.insert(out_.causes.begin(), Cause{});
  out_.causes[0].kind = "sample_jitter";
  ASSERT_TRUE(Withdraw());
  ASSERT_EQ(out_.causes.size(), 2U);
  EXPECT_EQ(out_.causes[1].kind, "constant_torque");
  EXPECT_EQ(fit_.point.effects[0]->kind, "constant_torque");
}

TEST_F(WithdrawTest, WhatThePriorsDecideStays) {
  Accept({"torque_constant"});
  Size(0, "factor", {0.0, -0.1, 0.1});
  EXPECT_FALSE(Withdraw());
}

}  // namespace
}  // namespace contour::diagnosis
