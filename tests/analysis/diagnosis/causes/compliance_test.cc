#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "compliance";
constexpr double kTwoPi = 2.0 * std::numbers::pi;

TEST(Compliance, OfAScrewIsAFactorOnItsStiffnessAndItsDamping) {
  const test::KnownAxis axis({.two_inertia = true});
  const AxisModel& stated = axis.problem.nominal;
  for (const SharedEffect& e : test::GridOf(axis, kKind)) {
    const AxisModel m = test::With(axis, e, {std::log(0.25), std::log(2.0)});
    EXPECT_NEAR(m.stiffness, 0.25 * stated.stiffness, 1e-9);
    EXPECT_NEAR(m.damping, 2.0 * stated.damping, 1e-12);
    const NamedValues told = test::Told(axis, e, {std::log(0.25), std::log(2.0)});
    // Stated is 100 Hz; a quarter of the stiffness halves it.
    EXPECT_NEAR(told.at("antiresonance_Hz"), 50.0, 1e-6);
    const double reduced = 6e-5 * 4e-5 / 1e-4;
    EXPECT_NEAR(told.at("damping_ratio"), 0.5 * m.damping / std::sqrt(m.stiffness * reduced), 1e-9);
  }
}

TEST(Compliance, AScrewIsTriedFromSofterAndFromStiffer) {
  const test::KnownAxis axis({.two_inertia = true});
  EXPECT_LT(test::OnGrid(axis, kKind, "softer")->start[0], 0.0);
  EXPECT_GT(test::OnGrid(axis, kKind, "stiffer")->start[0], 0.0);
}

TEST(Compliance, OfARigidAxisPutsAShareOfItBehindAScrew) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "65.0");
  EXPECT_EQ(e->order, 65.0);
  const AxisModel m = test::With(axis, e, {0.3, std::log(1.1), 0.0});
  ASSERT_TRUE(m.two_inertia);
  EXPECT_NEAR(m.load_inertia, 0.3e-4, 1e-15);
  EXPECT_NEAR(m.motor_inertia, 0.7e-4, 1e-15);
  EXPECT_NEAR(std::sqrt(m.stiffness / m.load_inertia) / kTwoPi, 65.0 * 1.1, 1e-6);
  EXPECT_NEAR(test::Told(axis, e, {0.3, std::log(1.1), 0.0}).at("antiresonance_Hz"), 71.5, 1e-6);
  EXPECT_EQ(test::With(axis, e, {0.0, 0.0, 0.0}), axis.problem.nominal) << "nothing behind it is rigid";
}

TEST(Compliance, TheGridOfARigidAxisLeavesNoFrequencyOut) {
  const test::KnownAxis axis;
  double last = 0.0;
  for (const SharedEffect& e : test::GridOf(axis, kKind)) {
    ASSERT_EQ(e->low.size(), 3u);
    if (last > 0.0) {
      EXPECT_LE(e->order * std::exp(e->low[1]), last * std::exp(e->high[1])) << "a gap below " << e->label;
    }
    last = e->order;
  }
  EXPECT_GE(last, 700.0);
}

TEST(Compliance, DampedAsNoCouplingIsOrWithNothingBehindItIsNone) {
  const test::KnownAxis rigid, screw({.two_inertia = true});
  const auto implausible = *CauseNamed(kKind).implausible;
  const Effect& e = *test::OnGrid(rigid, kKind, "65.0");
  EXPECT_TRUE(implausible(rigid.problem, e, {0.001, 0.0, 0.0}));
  EXPECT_TRUE(implausible(rigid.problem, e, {0.05, 0.0, 1.9}));
  EXPECT_FALSE(implausible(rigid.problem, e, {0.3, 0.0, 1.9})) << "a third of it damped well is a belt";
  EXPECT_FALSE(implausible(rigid.problem, e, {0.3, 0.0, 0.0}));
  EXPECT_FALSE(implausible(screw.problem, *test::OnGrid(screw, kKind, "softer"), {0.001, 0.0}));
}

TEST(Compliance, BecomesTheScrewOfTheModelAndOfTheEmulatedMachine) {
  const ExtensionsConfig e = test::ExtendedBy({test::CauseWith(
      kKind, {{"antiresonance_Hz", 50.0}, {"stiffness_Nm_rad", 4.0}, {"damping_ratio", 0.05}})});
  const auto [read, errors] = test::ThroughYaml(e);
  EXPECT_TRUE(errors.empty());
  EXPECT_EQ(read.compliance->stiffness_Nm_rad, 4.0);
  ModelConfig stated;
  stated.mechanics.motor_inertia_kgm2 = 5e-5;
  stated.mechanics.table_mass_kg = 20.0;
  stated.mechanics.lead_mm = 10.0;
  const test::Emulated emulated = test::SimulatedWith(kKind, e, stated);
  EXPECT_TRUE(emulated.errors.empty());
  // K / R^2, and 2 zeta sqrt(K m) of the reduced mass at the table.
  const double R = 0.01 / kTwoPi, K_N_m = 4.0 / (R * R), motor_kg = 5e-5 / (R * R);
  EXPECT_NEAR(emulated.axis.screw_stiffness_N_um, 1e-6 * K_N_m, 1e-9);
  EXPECT_NEAR(emulated.axis.screw_damping_Ns_m,
              2.0 * 0.05 * std::sqrt(K_N_m * motor_kg * 20.0 / (motor_kg + 20.0)), 1e-6);
}

TEST(Compliance, AStiffnessThatIsNoneIsNotAdded) {
  EXPECT_FALSE(test::ExtendedBy({test::CauseWith(kKind, {{"antiresonance_Hz", 50.0}})}).compliance);
  const ExtensionsConfig damped =
      test::ExtendedBy({test::CauseWith(kKind, {{"stiffness_Nm_rad", 4.0}, {"damping_ratio", 3.0}})});
  EXPECT_TRUE(test::ThroughYaml(damped).errors.empty()) << "the reader's limits hold";
}

TEST(Compliance, IsDecidedByAChirpWhileCreeping) {
  const test::KnownAxis axis;
  const Program program = test::DecidingProgram(axis, kKind);
  ASSERT_TRUE(program.torque);
  EXPECT_EQ(program.torque->kind, TorqueSignalKind::kChirp);
  EXPECT_EQ(program.torque->amplitude_Nm, 0.128);
  EXPECT_EQ(std::get<CreepShape>(program.shape).velocities_mm_s, (std::vector<double>{3.14}));
}

TEST(Compliance, ASpecimenIsSofterTheLargerItIs) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  EXPECT_TRUE((*s.needs).rigid);
  const Drawn drawn = (*s.draw)(test::MachineToDrawFor(), 1.0, test::Numbers({0.5}));
  const test::Emulated emulated = test::EmulatedWith((*s.effect)(drawn, test::MachineToDrawFor(), {}));
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_NEAR(emulated.axis.effects.compliance->antiresonance_Hz, 1.0 / drawn.size, 1e-9);
  EXPECT_GT((*s.size_at)(1.0, 50.0), (*s.size_at)(1.0, 100.0));
  EXPECT_GE(1.0 / *s.largest_size, 5.0) << "the emulated machine takes it";
}

}  // namespace
}  // namespace contour::diagnosis
