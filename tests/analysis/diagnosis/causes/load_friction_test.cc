#include <gtest/gtest.h>

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
