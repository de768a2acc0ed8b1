#include "analysis/prediction_error/extras.h"

#include <gtest/gtest.h>

#include <cmath>

namespace contour::diagnosis {
namespace {

constexpr std::size_t kRows = 50;

/// The table from -1 to 1 mm about a middle of 10 mm, angles of 2 rad per mm, at constant speed.
Signals Slide() {
  Signals s;
  s.middle_m = 0.01;
  for (std::size_t k = 0; k < kRows; ++k) {
    s.table_m.push_back(-1e-3 + 2e-3 * static_cast<double>(k) / (kRows - 1));
    s.angle_rad.push_back(2e3 * s.table_m.back());
    s.velocity.push_back(-4.0);
  }
  return s;
}

AxisModel TwoBodies() {
  AxisModel m;
  m.two_inertia = m.friction_on_load = true;
  return m;
}

TEST(Extras, NothingStatedIsNoSignal) {
  AxisModel m;
  AddExtras({}, Slide(), m);
  EXPECT_FALSE(m.motor_force || m.load_force || m.level || m.viscous || m.scale_error_m);
}

TEST(Extras, TheScaleReadsTheWobbleOfTheLeadAtTheRows) {
  StatedExtras x;
  x.wobble_m = {{0.3e-6, 1.0, 0.4}};
  AxisModel m = TwoBodies();
  const Signals s = Slide();
  AddExtras(x, s, m);
  ASSERT_TRUE(m.scale_error_m);
  ASSERT_EQ(m.scale_error_m->size(), kRows);
  for (std::size_t k = 0; k < kRows; ++k)
    EXPECT_NEAR((*m.scale_error_m)[k], 0.3e-6 * std::sin(s.angle_rad[k] + 0.4), 1e-15);
}

TEST(Extras, CoggingActsOnTheMotorWithBothEndsOfARow) {
  StatedExtras x;
  x.cogging = {{0.02, 3.0, 0.4}, {0.01, 1.0, 0.0}};
  AxisModel m = TwoBodies();
  const Signals s = Slide();
  AddExtras(x, s, m);
  ASSERT_TRUE(m.motor_force);
  EXPECT_FALSE(m.load_force);
  ASSERT_EQ(m.motor_force->size(), 2 * kRows);
  const double a = s.angle_rad[20];
  EXPECT_NEAR((*m.motor_force)[20], 0.02 * std::sin(3.0 * a + 0.4) + 0.01 * std::sin(a), 1e-4);
}

TEST(Extras, ASpringActsOnTheLoadByTheTablesOwnPlace) {
  StatedExtras x;
  x.spring = {{0.009, 0.011}, {1.0, 3.0}};
  AxisModel m = TwoBodies();
  AddExtras(x, Slide(), m);
  ASSERT_TRUE(m.load_force);
  EXPECT_NEAR((*m.load_force)[0], 1.0, 1e-12);
  EXPECT_NEAR(m.load_force->back(), 3.0, 1e-12);
}

TEST(Extras, DragActsWhereFrictionActsAndResists) {
  StatedExtras x;
  x.drag = {{0.1, 8.0, 2.0, 0.0}};
  AxisModel on_load = TwoBodies(), on_motor = TwoBodies();
  on_motor.friction_on_load = false;
  AddExtras(x, Slide(), on_load);
  AddExtras(x, Slide(), on_motor);
  ASSERT_TRUE(on_load.load_force && on_motor.motor_force);
  EXPECT_FALSE(on_load.motor_force || on_motor.load_force);
  EXPECT_NEAR((*on_load.load_force)[5], 0.1 * 0.25, 1e-12);
  x.drag[0].knee = 1.0;  // y (1 + knee) / (y + knee) at half the speed: 2 / 3
  AxisModel knee = TwoBodies();
  AddExtras(x, Slide(), knee);
  EXPECT_NEAR((*knee.load_force)[5], 0.1 * 2.0 / 3.0, 1e-12);
}

TEST(Extras, FactorsOfTheLevelMultiply) {
  StatedExtras x;
  x.friction_rel = {{0.0, 1.0}, {0.1, 0.1}};
  x.ball_ripple = {{0.2, 1.0, 0.0}};
  AxisModel m;
  const Signals s = Slide();
  AddExtras(x, s, m);
  ASSERT_TRUE(m.level);
  EXPECT_NEAR((*m.level)[30], 1.1 * (1.0 + 0.2 * std::sin(s.angle_rad[30])) - 1.0, 2e-4);
}

TEST(Extras, ViscosityFollowsTheTemperatureWhereThereIsOne) {
  StatedExtras x;
  x.viscous_rate_1_K = -0.02;
  x.reference_degC = 20.0;
  AxisModel without, with;
  Signals s = Slide();
  AddExtras(x, s, without);
  EXPECT_FALSE(without.viscous);
  s.temperature_K.assign(kRows, 1.0);
  s.mean_degC = 24.0;
  AddExtras(x, s, with);
  ASSERT_TRUE(with.viscous);
  EXPECT_NEAR((*with.viscous)[3], -0.1, 1e-12);
}

}  // namespace
}  // namespace contour::diagnosis
