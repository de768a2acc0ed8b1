#include <gtest/gtest.h>

#include <cmath>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "torque_constant";

TEST(TorqueConstant, IsAFactorOnTheDeliveredTorque) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "");
  AxisModel expected = axis.problem.nominal;
  expected.torque_gain = 1.2;
  EXPECT_EQ(test::With(axis, e, {0.2}), expected);
  EXPECT_EQ(test::Told(axis, e, {0.2}), (NamedValues{{"ratio", 1.2}}));
  EXPECT_TRUE(e->common_factor && *CauseNamed(kKind).common_factor);
  EXPECT_GT(1.0 + e->low[0], 0.0) << "a motor that pushes back is none";
}

// Before: 0.3, the least that is looked for, of a torque that was another axis's.
TEST(TorqueConstant, ARatioAtItsBoundIsNoMeasurement) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "");
  const CauseDefinition& c = CauseNamed(kKind);
  EXPECT_TRUE((*c.implausible)(axis.problem, *e, {e->low[0]}));
  EXPECT_TRUE((*c.implausible)(axis.problem, *e, {e->high[0]}));
  EXPECT_FALSE((*c.implausible)(axis.problem, *e, {0.3}));
}

TEST(TorqueConstant, RatiosOfTwoLogsMultiply) {
  const ExtensionsConfig e =
      test::ExtendedBy({test::CauseWith(kKind, {{"ratio", 1.2}}), test::CauseWith(kKind, {{"ratio", 0.9}})});
  const auto [read, errors] = test::ThroughYaml(e);
  EXPECT_TRUE(errors.empty());
  EXPECT_NEAR(read.torque_constant->ratio, 1.08, 1e-12);
  const test::Emulated emulated = test::SimulatedWith(kKind, e);
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_NEAR(emulated.axis.effects.torque_constant->ratio, 1.08, 1e-12);
  EXPECT_FALSE(
      test::ThroughYaml(test::ExtendedBy({test::CauseWith(kKind, {{"ratio", 0.01}})})).errors.empty());
}

TEST(TorqueConstant, ACauseWithoutARatioChangesNothing) {
  EXPECT_EQ(test::ExtendedBy({test::CauseWith(kKind, {})}).torque_constant->ratio, 1.0);
}

TEST(TorqueConstant, IsDecidedByPulses) {
  const test::KnownAxis axis;
  const Program program = test::DecidingProgram(axis, kKind);
  ASSERT_TRUE(program.torque);
  EXPECT_EQ(program.torque->kind, TorqueSignalKind::kPulses);
}

TEST(TorqueConstant, ASpecimensSizeIsHowFarTheRatioLiesFromOne) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  const test::Emulated emulated =
      test::EmulatedWith((*s.effect)({.size = -0.15}, test::MachineToDrawFor(), {}));
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_DOUBLE_EQ(emulated.axis.effects.torque_constant->ratio, 0.85);
  EXPECT_DOUBLE_EQ((*s.truth)({.size = -0.15}, {}).at("ratio"), 0.85);
  // Stated as the ratio, or as its distance from one.
  EXPECT_NEAR((*s.size_at)(2.0, 0.85), 0.3, 1e-12);
  EXPECT_NEAR((*s.size_at)(2.0, 0.15), 0.3, 1e-12);
  // The residual does not know it: its sizes are fixed, the clear one first, and none is as good as barely.
  const auto sizes = **s.sizes;
  EXPECT_GT(sizes[0], sizes[1]);
  EXPECT_GT(sizes[1], sizes[2]);
  EXPECT_TRUE((*s.undecidable)({.size = sizes[2]}, true));
  EXPECT_FALSE((*s.undecidable)({.size = sizes[0]}, false));
}

}  // namespace
}  // namespace contour::diagnosis
