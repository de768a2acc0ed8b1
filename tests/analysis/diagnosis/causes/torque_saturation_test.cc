#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "torque_saturation";

TEST(TorqueSaturation, LosesItsShareAtTheRatedTorque) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "");
  const AxisModel m = test::With(axis, e, {0.1});
  // Delivered is u (1 - saturation u^2): 0.9 of 0.64 Nm, and 0.975 of half of it.
  const auto delivered = [&](double u) { return u * (m.torque_gain - m.saturation * u * u); };
  EXPECT_NEAR(delivered(0.64), 0.9 * 0.64, 1e-12);
  EXPECT_NEAR(delivered(0.32), 0.975 * 0.32, 1e-12);
  EXPECT_EQ(test::Told(axis, e, {0.1}), (NamedValues{{"loss_at_rated_rel", 0.1}}));
}

TEST(TorqueSaturation, OfALinearAxisIsOfItsRatedForce) {
  const test::KnownAxis axis({.linear = true});
  const AxisModel m = test::With(axis, test::OnGrid(axis, kKind, ""), {0.1});
  EXPECT_NEAR(m.saturation * axis.stated.rated * axis.stated.rated, 0.1, 1e-12);
}

TEST(TorqueSaturation, WithoutARatedTorqueIsToldAtTheLargestOfTheLog) {
  test::KnownAxis axis;
  axis.stated.rated = 0.0;
  const double largest = 0.5;
  axis.log.command.assign(test::KnownAxis::kRows, -largest);
  const AxisModel m = test::With(axis, test::OnGrid(axis, kKind, ""), {0.1});
  EXPECT_NEAR(m.saturation * largest * largest, 0.1, 1e-12);
}

TEST(TorqueSaturation, IsAddedToWhatTheModelHas) {
  const test::KnownAxis axis;
  AxisModel m = axis.problem.nominal;
  m.saturation = 0.05 / (0.64 * 0.64);
  test::OnGrid(axis, kKind, "")->apply({0.1}, m);
  EXPECT_NEAR(m.saturation * 0.64 * 0.64, 0.15, 1e-12);
}

TEST(TorqueSaturation, ATorqueThatGrowsWithCurrentIsImplausible) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "");
  const auto implausible = *CauseNamed(kKind).implausible;
  EXPECT_TRUE(implausible(axis.problem, *e, {-0.018}));
  EXPECT_FALSE(implausible(axis.problem, *e, {0.018}));
}

/// Asked for 0.5 Nm by turns, of which the motion needs what a limit leaves; the effects that come of it.
std::vector<SharedEffect> WithALimitOf(double limit, test::KnownAxis& axis) {
  for (std::size_t k = 0; k < test::KnownAxis::kRows; ++k) {
    axis.log.command[k] = 0.5 * std::sin(0.016 * static_cast<double>(k));
    axis.problem.signals->model_torque[k] = std::clamp(axis.log.command[k], -limit, limit);
  }
  return test::GridOf(axis, kKind);
}

TEST(TorqueSaturation, ALimitBeginsWhereTheMotionNeedsNoMoreWhateverIsAsked) {
  test::KnownAxis axis;
  axis.log.command.assign(test::KnownAxis::kRows, 0.0);
  const std::vector<SharedEffect> grid = WithALimitOf(0.4, axis);
  ASSERT_EQ(grid.size(), 2U);
  const double limit = 1.0 / grid[1]->start[0];
  EXPECT_NEAR(limit, 0.4, 0.02);
  // At its top 0.5 Nm are asked for: what is beyond the limit is not given.
  const std::size_t top = 98;
  EXPECT_NEAR(test::MeanOverRow(test::With(axis, grid[1], {2.5}).motor_force, top), -0.1, 1e-3);
  EXPECT_EQ(test::With(axis, grid[1], {0.0}).motor_force, nullptr);
  EXPECT_EQ(test::Told(axis, grid[1], {2.5}), (NamedValues{{"limit_Nm", 0.4}}));
  // One that was never asked for is none.
  const auto implausible = *CauseNamed(kKind).implausible;
  EXPECT_TRUE(implausible(axis.problem, *grid[1], {1.9}));
  EXPECT_FALSE(implausible(axis.problem, *grid[1], {2.5}));
}

TEST(TorqueSaturation, NoLimitIsLookedForWhereTheMotionNeedsWhatIsAsked) {
  test::KnownAxis axis;
  axis.log.command.assign(test::KnownAxis::kRows, 0.0);
  EXPECT_EQ(WithALimitOf(1.0, axis).size(), 1U);
}

TEST(TorqueSaturation, NoModelIsExtendedByItAndPulsesDecide) {
  EXPECT_EQ(*CauseNamed(kKind).extension, nullptr);
  const test::KnownAxis axis;
  const Program program = test::DecidingProgram(axis, kKind);
  ASSERT_TRUE(program.torque);
  EXPECT_EQ(program.torque->kind, TorqueSignalKind::kPulses);
  EXPECT_LE(program.torque->amplitude_Nm, axis.stated.rated);
}

TEST(TorqueSaturation, ASpecimenStaysWithinWhatTheEmulatedMachineHas) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  for (const double size :
       {(*s.draw)(test::MachineToDrawFor(), 1.0, test::Numbers({0.5})).size, *s.largest_size}) {
    const test::Emulated emulated =
        test::EmulatedWith((*s.effect)({.size = size}, test::MachineToDrawFor(), {}));
    EXPECT_TRUE(emulated.errors.empty());
    EXPECT_EQ(emulated.axis.effects.torque_saturation->loss_at_rated_rel, size);
    EXPECT_EQ((*s.truth)({.size = size}, {}).at("loss_at_rated_rel"), size);
  }
}

}  // namespace
}  // namespace contour::diagnosis
