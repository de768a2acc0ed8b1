#include <gtest/gtest.h>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "constant_torque";

TEST(ConstantTorque, IsAnOffsetThatAccelerates) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "");
  AxisModel expected = axis.problem.nominal;
  expected.offset += 0.012;
  EXPECT_EQ(test::With(axis, e, {0.012}), expected);
  EXPECT_EQ(test::Told(axis, e, {0.012}), (NamedValues{{"torque_Nm", 0.012}}));
  EXPECT_EQ(e->force, (std::vector<int>{1})) << "it is a torque: twice the torque constant is twice of it";
}

TEST(ConstantTorque, MoreThanFrictionIsAnotherMachine) {
  const test::KnownAxis rotary, linear({.linear = true});
  const auto largest = *CauseNamed(kKind).largest;
  EXPECT_LT(largest(rotary.problem), test::KnownAxis::kCoulomb_Nm);
  EXPECT_GT(largest(rotary.problem), 0.5 * test::KnownAxis::kCoulomb_Nm);
  // In newtons of the carriage where the log has those.
  EXPECT_NEAR(largest(linear.problem) * test::KnownAxis::kTablePerRad, largest(rotary.problem), 1e-12);
}

TEST(ConstantTorque, OfTwoLogsTheSumIsTheModels) {
  const ExtensionsConfig e = test::ExtendedBy(
      {test::CauseWith(kKind, {{"torque_Nm", 0.012}}), test::CauseWith(kKind, {{"torque_Nm", -0.004}})});
  const auto [read, errors] = test::ThroughYaml(e);
  EXPECT_TRUE(errors.empty());
  EXPECT_DOUBLE_EQ(read.constant_torque->torque_Nm, 0.008);
  const test::Emulated emulated = test::SimulatedWith(kKind, e);
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_DOUBLE_EQ(emulated.axis.effects.constant_torque->torque_Nm, 0.008);
  EXPECT_FALSE(test::SimulatedWith(kKind, {}).axis.effects.constant_torque);
}

TEST(ConstantTorque, IsDecidedFromRestWhereAnAsymmetryOfFrictionIsNot) {
  const test::KnownAxis axis;
  EXPECT_TRUE(std::holds_alternative<TorqueStepsShape>(test::DecidingProgram(axis, kKind).shape));
}

TEST(ConstantTorque, ASpecimenHasItInEitherDirection) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  for (const double sign : {-1.0, 1.0}) {
    const Drawn drawn = (*s.draw)(test::MachineToDrawFor(), sign, test::Numbers({0.5}));
    const test::Emulated emulated = test::EmulatedWith((*s.effect)(drawn, test::MachineToDrawFor(), {}));
    EXPECT_TRUE(emulated.errors.empty());
    EXPECT_NEAR(emulated.axis.effects.constant_torque->torque_Nm, sign * 0.05 * 0.05, 1e-12);
    EXPECT_EQ((*s.truth)(drawn, {}).at("torque_Nm"), drawn.size);
  }
}

}  // namespace
}  // namespace contour::diagnosis
