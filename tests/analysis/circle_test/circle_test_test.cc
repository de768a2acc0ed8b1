#include "analysis/circle_test/circle_test.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace contour {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

const std::array<CircleAxis, kCircleAxes> kAxes{
    {{"x", 40e6, 10.0, 89.0, 5e-3}, {"y", 40e6, 10.0, 89.0, 5e-3}}};

struct Truth {
  std::array<double, kCircleAxes> share{0.3, 0.1}, wobble_m{0.3e-6, 0.2e-6}, phase{0.4, -1.1};
  double radius_m = 10e-3, rate_rad_s = 5.0, friction_N = 45.0;
};

struct Recorded {
  std::vector<CircleRow> rows;
  std::vector<std::array<double, kCircleAxes>> table_m;
};

/// A straight way in, three turns, and a stop. Friction turns round within 20 um.
Recorded Draw(const Truth& t) {
  Recorded out;
  const double turn_s = kTwoPi / std::abs(t.rate_rad_s);
  for (double time_s = -0.2; time_s < 3.0 * turn_s; time_s += 1e-3) {
    const double angle = t.rate_rad_s * std::max(time_s, 0.0);
    CircleRow row;
    row.time_s = time_s;
    row.speed_m_s =
        time_s < 0.0 ? 0.5 * t.radius_m * std::abs(t.rate_rad_s) : t.radius_m * std::abs(t.rate_rad_s);
    std::array<double, kCircleAxes> table_m{};
    for (std::size_t i = 0; i < kCircleAxes; ++i) {
      const double at = i == 0 ? std::cos(angle) : std::sin(angle);
      const double along = (i == 0 ? -std::sin(angle) : std::cos(angle)) * t.rate_rad_s * t.radius_m;
      const double acceleration_m_s2 = -t.rate_rad_s * t.rate_rad_s * t.radius_m * at;
      const double friction_N =
          t.friction_N * std::tanh(along / (0.02 * t.radius_m * std::abs(t.rate_rad_s)));
      table_m[i] = 0.1 + t.radius_m * at;  // the centre is 0.1 m off
      const double wound_m = ((1.0 - t.share[i]) * friction_N + kAxes[i].table_mass_kg * acceleration_m_s2) /
                             kAxes[i].stiffness_N_m;
      row.motor_m[i] = table_m[i] + wound_m;
      table_m[i] += t.wobble_m[i] * std::sin(kTwoPi * row.motor_m[i] / kAxes[i].lead_m + t.phase[i]);
      row.force_N[i] = friction_N + kAxes[i].mass_kg * acceleration_m_s2;
    }
    out.rows.push_back(row);
    out.table_m.push_back(table_m);
  }
  return out;
}

std::vector<CirclePoint> Measure(const Recorded& r) {
  const RowRange turns = TurnsOfCircle(r.rows);
  return RadiiOf({r.table_m.begin() + static_cast<std::ptrdiff_t>(turns.begin),
                  r.table_m.begin() + static_cast<std::ptrdiff_t>(turns.end)});
}

TEST(FitCircle, FindsShareAndWobbleOfBothAxes) {
  for (const double direction : {1.0, -1.0}) {
    Truth t;
    t.rate_rad_s *= direction;
    const Recorded r = Draw(t);
    const CircleTestResult found = FitCircle(kAxes, r.rows, Measure(r));
    for (std::size_t i = 0; i < kCircleAxes; ++i) {
      const CircleAxisFound& a = found.axes[i];
      EXPECT_NEAR(a.motor_share.value, t.share[i], 0.02) << direction;
      EXPECT_LT(a.motor_share.std, 0.03);
      ASSERT_TRUE(a.wobble_seen);
      EXPECT_NEAR(a.wobble_sine.value, t.wobble_m[i] * std::cos(t.phase[i]), 0.03e-6);
      EXPECT_NEAR(a.wobble_cosine.value, t.wobble_m[i] * std::sin(t.phase[i]), 0.03e-6);
    }
    EXPECT_LT(found.after_m, 0.2 * found.before_m);
    EXPECT_EQ(WhatIsWrong(found, kAxes), "");
  }
}

TEST(FitCircle, LeavesTheWobbleWhereTheCircleIsTooSmallForIt) {
  Truth t;
  t.radius_m = 0.1e-3;
  t.rate_rad_s = 4.9;
  const Recorded r = Draw(t);
  const CircleTestResult found = FitCircle(kAxes, r.rows, Measure(r));
  EXPECT_FALSE(found.axes[0].wobble_seen);
  EXPECT_NEAR(found.axes[0].motor_share.value, 0.3, 0.03);
  EXPECT_NEAR(found.axes[1].motor_share.value, 0.1, 0.03);
}

TEST(FitCircle, RefusesWhatIsNoCircle) {
  Recorded r = Draw({});
  const std::vector<CirclePoint> measured = Measure(r);
  EXPECT_THROW(FitCircle(kAxes, {}, measured), std::invalid_argument);
  EXPECT_THROW(FitCircle(kAxes, r.rows, {}), std::invalid_argument);
  EXPECT_THROW(FitCircle(kAxes, r.rows, {measured.begin(), measured.begin() + 90}), std::invalid_argument);
  std::vector<CircleRow> half(r.rows.begin(), r.rows.begin() + 800);
  EXPECT_THROW(FitCircle(kAxes, half, measured), std::invalid_argument);
  for (CircleRow& row : r.rows) row.motor_m[1] *= 0.5;
  EXPECT_THROW(FitCircle(kAxes, r.rows, measured), std::invalid_argument);
}

TEST(WhatIsWrong, NamesAShareThatTheCircleDoesNotTellOrThatIsNone) {
  // The motors' own circle: no wind-up is in it.
  const Recorded r = Draw({});
  std::vector<std::array<double, kCircleAxes>> motors;
  for (const CircleRow& row : r.rows) motors.push_back(row.motor_m);
  const RowRange turns = TurnsOfCircle(r.rows);
  const CircleTestResult own = FitCircle(kAxes, r.rows,
                                         RadiiOf({motors.begin() + static_cast<std::ptrdiff_t>(turns.begin),
                                                  motors.begin() + static_cast<std::ptrdiff_t>(turns.end)}));
  EXPECT_NE(WhatIsWrong(own, kAxes).find("axis x"), std::string::npos);
  CircleTestResult vague;
  vague.axes[1].motor_share.std = 0.5;
  EXPECT_NE(WhatIsWrong(vague, kAxes).find("axis y"), std::string::npos);
  CircleTestResult negative;
  negative.axes[0].motor_share = {-0.2, 0.02};
  EXPECT_NE(WhatIsWrong(negative, kAxes).find("less than none"), std::string::npos);
}

}  // namespace
}  // namespace contour
