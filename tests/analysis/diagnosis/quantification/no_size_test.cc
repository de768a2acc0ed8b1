// A size that ended at a bound of what is allowed is one only where the log says something of it.

#include "analysis/diagnosis/quantification/no_size.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/analysis/support/fitted_axis.h"

namespace contour::diagnosis {
namespace {

class NoSizeTest : public testing::Test {
 protected:
  /// Of a cause with its first amplitude there, told with an interval.
  bool Marked(const std::string& kind, double amplitude, const std::string& name,
              const Interval& told) const {
    Fit fit;
    fit.point = axis_.base.point;
    fit.point.effects = {axis_.Of(kind)};
    fit.point.amplitudes.emplace_back(fit.point.effects[0]->steps.size(), 0.0);
    fit.point.amplitudes[0][0] = amplitude;
    Accepted accepted;
    accepted.places = {0};
    Diagnosis out;
    out.causes.emplace_back();
    out.causes[0].kind = kind;
    out.causes[0].parameters[name] = told;
    MarkNoSize(axis_.problem, fit, accepted, out);
    return out.causes[0].no_size;
  }

  test::FittedAxis axis_;
};

// Before: of slow sound axes whose model states no bristle, a share of 90 % (-0.07 to 94) was told.
TEST_F(NoSizeTest, AtABoundAnIntervalThatHoldsZeroIsNone) {
  EXPECT_TRUE(Marked("presliding_hysteresis", 0.9, "share_rel", {0.9, -0.0007, 0.94}));
  EXPECT_FALSE(Marked("presliding_hysteresis", 0.9, "share_rel", {0.9, 0.8, 0.94}));
  EXPECT_FALSE(Marked("presliding_hysteresis", 0.5, "share_rel", {0.5, -0.1, 0.9})) << "not at a bound";
}

TEST_F(NoSizeTest, NorIsAnIntervalThatReachesTheOtherBound) {
  const SharedEffect effect = axis_.Of("stribeck");
  const Effect& e = *effect;
  ASSERT_FALSE(e.low.empty());
  const auto ratio = [&](double a) {
    Point point = axis_.base.point;
    point.effects = {effect};
    point.amplitudes = {{a, 0.0}};
    return CauseNamed("stribeck").parameters({axis_.problem, point, 0}).at("Fs_over_Fc");
  };
  const double low = ratio(e.low[0]), high = ratio(e.high[0]);
  EXPECT_TRUE(Marked("stribeck", e.high[0], "Fs_over_Fc", {high, low, 1.02 * high}));
  EXPECT_TRUE(Marked("stribeck", e.low[0], "Fs_over_Fc", {low, low, 1.02 * high}));
  EXPECT_FALSE(Marked("stribeck", e.high[0], "Fs_over_Fc", {high, 0.5 * (low + high), 1.02 * high}));
}

TEST_F(NoSizeTest, WhatHasNoBoundsIsNeverAtOne) {
  EXPECT_FALSE(Marked("constant_torque", 0.02, "torque_Nm", {0.02, -0.01, 0.05}));
}

TEST_F(NoSizeTest, ADelayThatIsNotThereIsASize) {
  const double none_s = axis_.Of("input_delay")->low[0];
  EXPECT_FALSE(Marked("input_delay", none_s, "delay_us", {1e6 * none_s, 1e6 * none_s, -80.0}));
}

}  // namespace
}  // namespace contour::diagnosis
