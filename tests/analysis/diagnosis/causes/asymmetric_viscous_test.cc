#include <gtest/gtest.h>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "asymmetric_viscous";

TEST(AsymmetricViscous, RaisesTheCoefficientByHalfOfItOneWayAndLowersItTheOther) {
  const test::KnownAxis axis;
  ASSERT_EQ(test::GridOf(axis, kKind).size(), 1u);
  const SharedEffect e = test::OnGrid(axis, kKind, "");
  const AxisModel m = test::With(axis, e, {0.3});
  ASSERT_TRUE(m.viscous);
  EXPECT_NEAR(test::MeanOverRow(m.viscous, 100), 0.15, 1e-12);    // the table moves up until 0.5 s
  EXPECT_NEAR(test::MeanOverRow(m.viscous, 1000), -0.15, 1e-12);  // and down until 1.5 s
  EXPECT_NEAR(test::MeanOverRow(m.viscous, 1900), 0.15, 1e-12);
  EXPECT_EQ(m.friction.Fc_plus, axis.problem.nominal.friction.Fc_plus);
  EXPECT_EQ(test::Told(axis, e, {0.3}), (NamedValues{{"difference_rel", 0.3}}));
}

TEST(AsymmetricViscous, IsNoHypothesisWhereThereIsNoViscousFriction) {
  test::KnownAxis axis;
  axis.problem.nominal.friction.s2 = 0.0;
  EXPECT_TRUE(test::GridOf(axis, kKind).empty());
}

TEST(AsymmetricViscous, IsDecidedByTheSameStrokesAtThreeSpeeds) {
  const test::KnownAxis axis;
  EXPECT_EQ(std::get<CreepShape>(test::DecidingProgram(axis, kKind).shape).velocities_mm_s.size(), 3u);
}

TEST(AsymmetricViscous, ExtensionsAddUp) {
  Cause cause;
  cause.kind = kKind;
  cause.parameters["difference_rel"] = {0.2, 0.1, 0.3};
  ExtensionsConfig e;
  for (int i = 0; i < 2; ++i) (*CauseNamed(kKind).extension->add)(cause, 20.0, e);
  EXPECT_DOUBLE_EQ(e.asymmetric_viscous->difference_rel, 0.4);
}

TEST(AsymmetricViscous, ItsSpecimenIsOneThatTheEmulatedMachineTakes) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  const Drawn drawn = (*s.draw)(test::MachineToDrawFor(), -1.0, test::Numbers({0.5}));
  EXPECT_LT(drawn.size, 0.0);
  const test::Emulated emulated = test::EmulatedWith((*s.effect)(drawn, test::MachineToDrawFor(), {}));
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_EQ(emulated.axis.effects.asymmetric_viscous->difference_rel, drawn.size);
}

}  // namespace
}  // namespace contour::diagnosis
