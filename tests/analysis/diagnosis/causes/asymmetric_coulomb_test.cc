#include <gtest/gtest.h>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "asymmetric_coulomb";

TEST(AsymmetricCoulomb, RaisesOneDirectionByHalfOfItAndLowersTheOtherByTheSame) {
  const test::KnownAxis axis;
  ASSERT_EQ(test::GridOf(axis, kKind).size(), 1u);
  const SharedEffect e = test::OnGrid(axis, kKind, "");
  const AxisModel m = test::With(axis, e, {0.2});
  EXPECT_NEAR(m.friction.Fc_plus, 0.06 * 1.1, 1e-12);
  EXPECT_NEAR(m.friction.Fc_minus, 0.04 * 0.9, 1e-12);
  EXPECT_NEAR(m.friction.Fs_plus, 0.09 * 1.1, 1e-12);
  EXPECT_NEAR(m.friction.Fs_minus, 0.06 * 0.9, 1e-12);
  EXPECT_FALSE(m.viscous);  // what differs with the speed is another cause's
  EXPECT_EQ(test::Told(axis, e, {0.2}), (NamedValues{{"difference_rel", 0.2}}));
  // Beyond these one of the two levels would be next to nothing.
  EXPECT_GT(e->low[0], -2.0);
  EXPECT_LT(e->high[0], 2.0);
}

TEST(AsymmetricCoulomb, TwoDifferencesMultiplyTheLevels) {
  const ExtensionsConfig e = test::ExtendedBy(
      {test::CauseWith(kKind, {{"difference_rel", 0.2}}), test::CauseWith(kKind, {{"difference_rel", 0.4}})});
  // 1.1 x 1.2 = 1.32 over 0.9 x 0.8 = 0.72: a difference of 0.6 of a mean of 1.02.
  EXPECT_NEAR(e.asymmetric_coulomb->difference_rel, 0.6 / 1.02, 1e-12);
  const auto [read, errors] = test::ThroughYaml(e);
  EXPECT_TRUE(errors.empty());
  EXPECT_DOUBLE_EQ(read.asymmetric_coulomb->difference_rel, e.asymmetric_coulomb->difference_rel);
  const test::Emulated emulated = test::SimulatedWith(kKind, e);
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_DOUBLE_EQ(emulated.axis.effects.asymmetric_coulomb->difference_rel, 0.6 / 1.02);
  ExtensionsConfig too_large;
  too_large.asymmetric_coulomb.emplace().difference_rel = 2.1;
  EXPECT_FALSE(test::ThroughYaml(too_large).errors.empty());
}

TEST(AsymmetricCoulomb, IsDecidedByPushingFromRestBothWays) {
  const test::KnownAxis axis;
  const auto shape = std::get<TorqueStepsShape>(test::DecidingProgram(axis, kKind).shape);
  // A fifth of the rated 0.64 Nm, which is more than the friction of 0.05 Nm.
  EXPECT_EQ(shape.torques_Nm, (std::vector<double>{0.128, -0.128}));
  const Specimen& s = **CauseNamed(kKind).specimen;
  const Drawn drawn = (*s.draw)(test::MachineToDrawFor(), -1.0, test::Numbers({0.5}));
  const test::Emulated emulated = test::EmulatedWith((*s.effect)(drawn, test::MachineToDrawFor(), {}));
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_LT(drawn.size, 0.0);
  EXPECT_EQ(emulated.axis.effects.asymmetric_coulomb->difference_rel, drawn.size);
}

}  // namespace
}  // namespace contour::diagnosis
