#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "load_friction";

TEST(LoadFriction, RaisesTheLevelByTheNetForceOverTheStatedOne) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "");
  const AxisModel m = test::With(axis, e, {0.1});
  for (const std::size_t row : {250u, 800u, 1600u}) {
    // Friction in all: Fc + 0.1 |J acceleration|.
    const double net_Nm = 1e-4 * std::fabs(axis.signals().acceleration[row]);
    EXPECT_NEAR(0.05 * (*m.level)[row], 0.1 * net_Nm, 1e-12);
    EXPECT_EQ((*m.level)[row], (*m.level)[test::KnownAxis::kRows + row]) << "constant over the row";
  }
  EXPECT_EQ(test::Told(axis, e, {0.1}), (NamedValues{{"friction_per_torque_rel", 0.1}}));
}

TEST(LoadFriction, DoesNotAskForTheDirectionOfTheForce) {
  test::KnownAxis axis;
  axis.problem.signals->net_force.assign(test::KnownAxis::kRows, -0.2);
  EXPECT_NEAR((*test::With(axis, test::OnGrid(axis, kKind, ""), {0.1}).level)[5], 0.1 * 0.2 / 0.05, 1e-12);
}

TEST(LoadFriction, ALoadMayArriveLaterThanTheTorque) {
  test::KnownAxis axis;
  Signal& net = axis.problem.signals->net_force;
  net.assign(test::KnownAxis::kRows, 0.0);
  std::fill(net.begin() + 500, net.end(), -0.2);
  const AxisModel at_once = test::With(axis, test::OnGrid(axis, kKind, ""), {0.1});
  const AxisModel later = test::With(axis, test::OnGrid(axis, kKind, "within 2 rows"), {0.1});
  const double level = 0.1 * 0.2 / 0.05;
  EXPECT_NEAR((*at_once.level)[500], level, 1e-12);
  EXPECT_EQ((*later.level)[499], 0.0);
  EXPECT_NEAR((*later.level)[500], level * (1.0 - std::exp(-0.5)), 1e-12);
  EXPECT_NEAR((*later.level)[501], level * (1.0 - std::exp(-1.0)), 1e-12);
  EXPECT_NEAR((*later.level)[600], level, 1e-9);
  EXPECT_EQ((*later.level)[500], (*later.level)[test::KnownAxis::kRows + 500]) << "constant over the row";
}

TEST(LoadFriction, NoiseOfTheCommandHasNoDirectionForALoadThatArrivesLater) {
  test::KnownAxis axis;
  Signal& net = axis.problem.signals->net_force;
  for (std::size_t k = 0; k < net.size(); ++k) net[k] = k % 2 == 0 ? 0.2 : -0.2;
  const AxisModel at_once = test::With(axis, test::OnGrid(axis, kKind, ""), {0.1});
  const AxisModel later = test::With(axis, test::OnGrid(axis, kKind, "within 4 rows"), {0.1});
  EXPECT_LT((*later.level)[1000], 0.2 * (*at_once.level)[1000]);
}

TEST(LoadFriction, NoLoadMakesFrictionLess) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "");
  const auto implausible = *CauseNamed(kKind).implausible;
  ASSERT_NE(implausible, nullptr);
  EXPECT_TRUE(implausible(axis.problem, *e, {-0.013}));
  EXPECT_FALSE(implausible(axis.problem, *e, {0.013}));
}

TEST(LoadFriction, NoModelIsExtendedByItAndPulsesDecide) {
  EXPECT_EQ(*CauseNamed(kKind).extension, nullptr);
  const test::KnownAxis axis;
  const Program program = test::DecidingProgram(axis, kKind);
  ASSERT_TRUE(program.torque);
  EXPECT_EQ(program.torque->kind, TorqueSignalKind::kPulses);
  EXPECT_EQ(program.torque->amplitude_Nm, 0.128);
}

TEST(LoadFriction, ASpecimenHasTheShareThatItsTruthSays) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  const Drawn drawn = (*s.draw)(test::MachineToDrawFor(), 1.0, test::Numbers({0.5}));
  const test::Emulated emulated = test::EmulatedWith((*s.effect)(drawn, test::MachineToDrawFor(), {}));
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_EQ(emulated.axis.effects.load_friction->friction_per_torque_rel,
            (*s.truth)(drawn, {}).at("friction_per_torque_rel"));
}

}  // namespace
}  // namespace contour::diagnosis
