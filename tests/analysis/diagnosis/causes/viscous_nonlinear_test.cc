#include <gtest/gtest.h>

#include <cmath>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "viscous_nonlinear";
constexpr double kTop_rad_s = test::KnownAxis::kTopSpeed_rad_s;

double SpeedAt(const test::KnownAxis& axis, std::size_t row) { return axis.signals().velocity[row]; }

TEST(ViscousNonlinear, APowerOfTheSpeedBrakesByItsTorqueAtTheHighestSpeed) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "power 2");
  const double power = 2.0 * std::exp(0.2);
  const AxisModel m = test::With(axis, e, {0.03, 0.2});
  for (const std::size_t row : {0u, 400u, 1000u, 1400u}) {
    const double y = SpeedAt(axis, row) / kTop_rad_s;
    EXPECT_NEAR((*m.motor_force)[row], (y > 0.0 ? -0.03 : 0.03) * std::pow(std::fabs(y), power), 1e-12);
  }
  const NamedValues told = test::Told(axis, e, {0.03, 0.2});
  EXPECT_EQ(told.at("torque_at_max_speed_Nm"), 0.03);
  EXPECT_NEAR(told.at("max_speed_rad_s"), kTop_rad_s, 1e-9);
  EXPECT_NEAR(told.at("exponent"), power, 1e-12);
  EXPECT_FALSE(told.contains("knee_rad_s"));
}

TEST(ViscousNonlinear, WithAKneeTheDragYieldsBeyondIt) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "knee 0.1");
  const AxisModel m = test::With(axis, e, {0.03, 0.0});
  EXPECT_NEAR((*m.motor_force)[0], -0.03, 1e-9) << "at the highest speed";
  for (const std::size_t row : {250u, 700u, 1250u}) {
    const double y = SpeedAt(axis, row) / kTop_rad_s;
    EXPECT_NEAR((*m.motor_force)[row], -0.03 * 1.1 * y / (std::fabs(y) + 0.1), 1e-12);
  }
  const NamedValues told = test::Told(axis, e, {0.03, 0.0});
  EXPECT_NEAR(told.at("knee_rad_s"), 0.1 * kTop_rad_s, 1e-9);
  EXPECT_FALSE(told.contains("exponent"));
  EXPECT_EQ(e->low[0], 0.0) << "a knee yields";
  EXPECT_LT(test::OnGrid(axis, kKind, "power 2")->low[0], 0.0) << "a power may be less friction";
}

TEST(ViscousNonlinear, ActsWhereFrictionDoes) {
  const test::KnownAxis on_load({.two_inertia = true, .friction_on_load = true}),
      on_motor({.two_inertia = true});
  EXPECT_TRUE(test::With(on_load, test::OnGrid(on_load, kKind, "power 2"), {0.03, 0.0}).load_force);
  EXPECT_TRUE(test::With(on_motor, test::OnGrid(on_motor, kKind, "power 2"), {0.03, 0.0}).motor_force);
}

TEST(ViscousNonlinear, AKneeIsAnotherFamilyAndAPowerBeyondAnyDragIsImplausible) {
  const test::KnownAxis axis;
  const auto family = *CauseNamed(kKind).family;
  EXPECT_NE(family(*test::OnGrid(axis, kKind, "knee 0.1")), family(*test::OnGrid(axis, kKind, "power 2")));
  EXPECT_EQ(family(*test::OnGrid(axis, kKind, "knee 0.1")), family(*test::OnGrid(axis, kKind, "knee 0.3")));
  const auto implausible = *CauseNamed(kKind).implausible;
  EXPECT_TRUE(implausible(axis.problem, *test::OnGrid(axis, kKind, "power 3"), {0.03, 0.4}));
  EXPECT_FALSE(implausible(axis.problem, *test::OnGrid(axis, kKind, "power 2"), {0.03, 0.0}));
}

TEST(ViscousNonlinear, CurvesOfAModelStandBesideOneAnother) {
  const ExtensionsConfig e = test::ExtendedBy(
      {test::CauseWith(kKind,
                       {{"torque_at_max_speed_Nm", 0.03}, {"max_speed_rad_s", 300.0}, {"exponent", 2.2}}),
       test::CauseWith(
           kKind, {{"torque_at_max_speed_Nm", 0.01}, {"max_speed_rad_s", 200.0}, {"knee_rad_s", 20.0}})});
  const auto [read, errors] = test::ThroughYaml(e);
  EXPECT_TRUE(errors.empty());
  EXPECT_EQ(read.viscous_nonlinear->exponent, 2.2);
  EXPECT_EQ(read.viscous_nonlinear->knee_rad_s, 0.0);
  ASSERT_EQ(read.viscous_nonlinear->further.size(), 1u);
  EXPECT_EQ(read.viscous_nonlinear->further[0].knee_rad_s, 20.0);
  const test::Emulated emulated = test::SimulatedWith(kKind, e);
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_EQ(emulated.axis.effects.viscous_nonlinear->exponent, 2.2);
  EXPECT_EQ(emulated.axis.effects.viscous_nonlinear->further.at(0).knee_rad_s, 20.0);
  EXPECT_EQ(emulated.axis.effects.viscous_nonlinear->further.at(0).max_speed_rad_s, 200.0);
}

TEST(ViscousNonlinear, AnExponentBelowOneIsTakenAsLinearByTheEmulatedMachine) {
  const ExtensionsConfig e = test::ExtendedBy({test::CauseWith(
      kKind, {{"torque_at_max_speed_Nm", 0.03}, {"max_speed_rad_s", 300.0}, {"exponent", 0.5}})});
  const test::Emulated emulated = test::SimulatedWith(kKind, e);
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_EQ(emulated.axis.effects.viscous_nonlinear->exponent, 1.0);
}

TEST(ViscousNonlinear, IsDecidedByStrokesAtSpeedsOfTheWholeRange) {
  const test::KnownAxis axis;
  const auto creep = std::get<CreepShape>(test::DecidingProgram(axis, kKind).shape);
  EXPECT_LT(creep.velocities_mm_s.front(), 0.1 * creep.velocities_mm_s.back());
  EXPECT_EQ(*CauseNamed(kKind).shows_more_of, Quantity::kSpeed);
}

TEST(ViscousNonlinear, TheTruthOfASpecimenIsAtTheSpeedOfTheLog) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  const LogSpan span = {.largest_speed_rad_s = 150.0, .speed_limit_rad_s = 300.0};
  EXPECT_NEAR((*s.truth)({.size = 0.04, .order = 2.0}, span).at("torque_at_max_speed_Nm"), 0.01, 1e-12);
  const test::Emulated emulated =
      test::EmulatedWith((*s.effect)({.size = 0.04, .order = 2.0}, test::MachineToDrawFor(), {}));
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_EQ(emulated.axis.effects.viscous_nonlinear->max_speed_rad_s, 300.0);
  EXPECT_EQ(emulated.axis.effects.viscous_nonlinear->exponent, 2.0);
}

}  // namespace
}  // namespace contour::diagnosis
