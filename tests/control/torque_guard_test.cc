#include "control/torque_guard.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace contour {
namespace {

constexpr double kPeriod = 1e-3;
constexpr double kRadius = 5e-3 / (2.0 * std::numbers::pi);
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

GuardedAxis Axis() {
  AxisLimits limits;
  limits.position_mm = {-200.0, 200.0};
  limits.velocity_mm_s = 250.0;
  limits.acceleration_mm_s2 = 5000.0;
  limits.jerk_mm_s3 = 2e5;
  limits.torque_Nm = 1.5;
  limits.torque_rate_Nm_s = 200.0;
  limits.following_error_mm = 0.5;
  limits.safe_travel_mm = 2.0;
  return {ToSi(limits, kRadius), kRadius};
}

TorqueGuard Guard(const GuardedAxis& axis = Axis()) {
  PerAxis<GuardedAxis> axes;
  axes.push_back(axis);
  return TorqueGuard(GuardConfig{}, axes, kPeriod);
}

AxisFeedback At(double position_mm) {
  AxisFeedback feedback;
  feedback.position_rad = position_mm * 1e-3 / kRadius;
  feedback.fresh = true;
  feedback.valid = true;
  return feedback;
}

struct Case {
  std::string name;
  double wanted_Nm = 0.1;
  AxisFeedback feedback = At(0.0);
  double reference_mm = 0.0;
  bool enabled = true;
  double before_mm = 0.0;  // where the axis was one cycle earlier
  double torque_Nm = 0.1;
  Reason limit = Reason::kNone;
  Reason fault = Reason::kNone;
};

class GuardTruthTable : public ::testing::TestWithParam<Case> {};

TEST_P(GuardTruthTable, SaysWhatItMust) {
  const Case& c = GetParam();
  TorqueGuard guard = Guard();
  guard.Limit(0, 0.0, At(c.before_mm), c.before_mm * 1e-3, true);
  const GuardedTorque out = guard.Limit(0, c.wanted_Nm, c.feedback, c.reference_mm * 1e-3, c.enabled);
  EXPECT_DOUBLE_EQ(out.torque_Nm, c.torque_Nm);
  EXPECT_EQ(out.limit, c.limit) << Name(out.limit);
  EXPECT_EQ(out.fault, c.fault) << Name(out.fault);
}

AxisFeedback Old(std::uint32_t cycles) {
  AxisFeedback feedback = At(0.0);
  feedback.fresh = false;
  feedback.age_cycles = cycles;
  return feedback;
}

AxisFeedback Never() {
  AxisFeedback feedback = At(0.0);
  feedback.valid = false;
  feedback.fresh = false;
  return feedback;
}

std::vector<Case> Cases() {
  std::vector<Case> cases;
  cases.push_back({.name = "within_everything"});
  cases.push_back({.name = "rate_up", .wanted_Nm = 0.5, .torque_Nm = 0.2, .limit = Reason::kTorqueRateLimit});
  cases.push_back(
      {.name = "rate_down", .wanted_Nm = -0.5, .torque_Nm = -0.2, .limit = Reason::kTorqueRateLimit});
  cases.push_back({.name = "above_torque_and_rate",
                   .wanted_Nm = 9.0,
                   .torque_Nm = 0.2,
                   .limit = Reason::kTorqueRateLimit});
  cases.push_back(
      {.name = "not_a_number", .wanted_Nm = kNaN, .torque_Nm = 0.0, .fault = Reason::kNotANumber});
  cases.push_back(
      {.name = "infinite", .wanted_Nm = kInfinity, .torque_Nm = 0.0, .fault = Reason::kNotANumber});
  cases.push_back({.name = "position_not_a_number",
                   .feedback = At(kNaN),
                   .torque_Nm = 0.0,
                   .fault = Reason::kNotANumber});
  cases.push_back({.name = "reference_not_a_number",
                   .reference_mm = kNaN,
                   .torque_Nm = 0.0,
                   .fault = Reason::kNotANumber});
  cases.push_back({.name = "stale_1", .feedback = Old(1)});
  cases.push_back({.name = "stale_2", .feedback = Old(2)});
  cases.push_back({.name = "stale_3", .feedback = Old(3), .torque_Nm = 0.0, .fault = Reason::kStaleFeedback});
  cases.push_back(
      {.name = "never_any", .feedback = Never(), .torque_Nm = 0.0, .fault = Reason::kStaleFeedback});
  cases.push_back({.name = "following", .reference_mm = 0.49});
  cases.push_back({.name = "following_too_far",
                   .reference_mm = 0.51,
                   .torque_Nm = 0.0,
                   .fault = Reason::kFollowingError});
  cases.push_back({.name = "following_old_feedback", .feedback = Old(2), .reference_mm = 0.51});
  cases.push_back({.name = "outside_position",
                   .feedback = At(200.01),
                   .reference_mm = 200.0,
                   .before_mm = 199.9,
                   .torque_Nm = 0.0,
                   .fault = Reason::kPositionLimit});
  cases.push_back({.name = "too_fast",
                   .feedback = At(0.31),
                   .reference_mm = 0.31,
                   .torque_Nm = 0.0,
                   .fault = Reason::kVelocityLimit});
  cases.push_back({.name = "fast", .feedback = At(0.29), .reference_mm = 0.29});
  cases.push_back({.name = "disabled", .enabled = false, .torque_Nm = 0.0});
  cases.push_back({.name = "disabled_stale", .feedback = Old(9), .enabled = false, .torque_Nm = 0.0});
  cases.push_back(
      {.name = "disabled_far_from_reference", .reference_mm = 50.0, .enabled = false, .torque_Nm = 0.0});
  cases.push_back({.name = "disabled_not_a_number",
                   .wanted_Nm = kNaN,
                   .enabled = false,
                   .torque_Nm = 0.0,
                   .fault = Reason::kNotANumber});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Cases, GuardTruthTable, ::testing::ValuesIn(Cases()),
                         [](const auto& test_case) { return test_case.param.name; });

TEST(TorqueGuard, HoldsAtTheTorqueLimit) {
  TorqueGuard guard = Guard();
  GuardedTorque out;
  for (int i = 0; i < 10; ++i) out = guard.Limit(0, 5.0, At(0.0), 0.0, true);
  EXPECT_DOUBLE_EQ(out.torque_Nm, 1.5);
  EXPECT_EQ(out.limit, Reason::kTorqueLimit);
}

TEST(TorqueGuard, AFaultTakesTheTorqueAwayAtOnceAndTheRateStartsFromThere) {
  TorqueGuard guard = Guard();
  for (int i = 0; i < 10; ++i) guard.Limit(0, 1.5, At(0.0), 0.0, true);
  EXPECT_DOUBLE_EQ(guard.Limit(0, kNaN, At(0.0), 0.0, true).torque_Nm, 0.0);
  EXPECT_DOUBLE_EQ(guard.Limit(0, 1.5, At(0.0), 0.0, true).torque_Nm, 0.2);
}

TEST(TorqueGuard, SpeedIsMeasuredOverTheCyclesThatWereMissed) {
  TorqueGuard guard = Guard();
  guard.Limit(0, 0.0, At(0.0), 0.0, true);
  guard.Limit(0, 0.0, Old(1), 0.0, true);
  EXPECT_EQ(guard.Limit(0, 0.0, At(0.5), 0.5e-3, true).fault, Reason::kNone);  // 0.5 mm in two cycles
  EXPECT_EQ(guard.Limit(0, 0.0, At(1.0), 1e-3, true).fault, Reason::kVelocityLimit);
}

// A SYNC that waited for another node's frame, and the one behind it that did not.
TEST(TorqueGuard, SpeedIsMeasuredOverTheTimeBetweenTheSyncs) {
  for (const double late_s : {0.0, 165e-6}) {
    for (const double sign : {1e-3, -1e-3}) {
      TorqueGuard guard = Guard();
      const auto at = [&](double mm, double apart_s) {
        return guard.Limit(0, 0.0, At(1e3 * sign * mm), sign * mm, true, apart_s).fault;
      };
      at(0.0, 0.0);
      EXPECT_EQ(at(0.33, late_s), late_s > 0.0 ? Reason::kNone : Reason::kVelocityLimit);
      EXPECT_EQ(at(0.58, -late_s), Reason::kNone);
      EXPECT_EQ(at(0.94, late_s), Reason::kVelocityLimit) << "too fast all the same";
    }
  }
}

TEST(TorqueGuard, AnAxisOutsideItsLimitsCanBeDrivenBackButNotFurther) {
  TorqueGuard guard = Guard();
  guard.Limit(0, 0.0, At(201.0), 0.201, false);
  EXPECT_EQ(guard.Limit(0, -0.1, At(201.0), 0.201, true).fault, Reason::kNone);
  EXPECT_EQ(guard.Limit(0, -0.1, At(200.9), 0.2009, true).fault, Reason::kNone);
  for (int i = 0; i < 6; ++i) guard.Limit(0, 0.1, At(200.9 + 0.1 * i), 0.2009 + 1e-4 * i, true);
  EXPECT_EQ(guard.Limit(0, 0.1, At(201.51), 0.2015, true).fault, Reason::kPositionLimit);
}

TEST(TorqueGuard, WithoutARateLimitTheFullTorqueComesAtOnce) {
  GuardedAxis axis = Axis();
  axis.limits.torque_rate_Nm_s = kInfinity;
  TorqueGuard guard = Guard(axis);
  EXPECT_DOUBLE_EQ(guard.Limit(0, -1.4, At(0.0), 0.0, true).torque_Nm, -1.4);
}

TEST(TorqueGuard, RefusesNonsense) {
  GuardedAxis axis = Axis();
  axis.limits.torque_Nm = 0.0;
  EXPECT_THROW(Guard(axis), std::invalid_argument);
}

}  // namespace
}  // namespace contour
