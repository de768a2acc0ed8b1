#include <gtest/gtest.h>

#include <cmath>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/stroke_shapes.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "cable_spring";

TEST(CableSpring, TheLinearOneIsAForceInProportionToThePosition) {
  const test::KnownAxis axis;
  const SharedEffect linear = test::OnGrid(axis, kKind, "")->shorter;
  ASSERT_TRUE(linear);
  ASSERT_EQ(linear->steps.size(), 1u);
  const AxisModel m = test::With(axis, linear, {-0.01});  // pulls back with 10 mN m at 50 mm
  for (const std::size_t row : {100u, 500u, 1400u})
    EXPECT_NEAR((*m.load_force)[row], -0.01 * axis.signals().table_m[row] / 0.05, 1e-12);
  // The stroke is stated as twice of what was travelled.
  EXPECT_NEAR(test::Told(axis, linear, {-0.01}).at("torque_at_stroke_end_Nm"), 0.02, 1e-12);
}

TEST(CableSpring, HasLegendrePolynomialsUpToTheFourthDegree) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "");
  ASSERT_EQ(e->steps.size(), 4u);
  const AxisModel m = test::With(axis, e, {0.001, 0.002, 0.003, 0.004});
  for (const std::size_t row : {0u, 250u, 1700u}) {
    const double u = axis.signals().table_m[row] / 0.05;
    const double sum = 0.001 * u + 0.002 * (3 * u * u - 1) / 2 + 0.003 * (5 * u * u * u - 3 * u) / 2 +
                       0.004 * (35 * std::pow(u, 4) - 30 * u * u + 3) / 8;
    EXPECT_NEAR((*m.load_force)[row], sum, 1e-12);
  }
  // What is even over the stroke pulls at neither end.
  EXPECT_NEAR(test::Told(axis, e, {0.0, 0.002, 0.0, 0.004}).at("torque_at_stroke_end_Nm"), 0.0, 1e-12);
  EXPECT_EQ(*(*CauseNamed(kKind).shape)->per_unit, 1.0) << "told in the unit of the effect";
}

TEST(CableSpring, TablesOfTwoLogsAddUp) {
  const Cause once =
      test::CauseWith(kKind, {{"torque_at_stroke_end_Nm", 0.02}}, {-50, 0, 50}, {0.02, 0, -0.02});
  const Cause again = test::CauseWith(kKind, {{"torque_at_stroke_end_Nm", 0.01}}, {-25, 25}, {0.01, -0.01});
  const ExtensionsConfig e = test::ExtendedBy({once, again});
  const auto [read, errors] = test::ThroughYaml(e);
  EXPECT_TRUE(errors.empty());
  EXPECT_EQ(read.cable_spring->position_mm, (std::vector<double>{-50, -25, 0, 25, 50}));
  // A table goes on as it ends; at 25 mm the first one has half of its end.
  const std::vector<double> sum = {0.03, 0.02, 0.0, -0.02, -0.03};
  for (std::size_t i = 0; i < sum.size(); ++i) EXPECT_NEAR(read.cable_spring->torque_Nm[i], sum[i], 1e-9);
  EXPECT_NEAR(read.cable_spring->torque_at_stroke_end_Nm, 0.03, 1e-12);
  EXPECT_EQ(*(*CauseNamed(kKind).extension)->simulation, nullptr);
}

TEST(CableSpring, WithoutATableNothingIsAdded) {
  EXPECT_FALSE(test::ExtendedBy({test::CauseWith(kKind, {{"torque_at_stroke_end_Nm", 0.02}})}).cable_spring);
}

TEST(CableSpring, IsDecidedByFullStrokes) {
  const test::KnownAxis axis;
  const auto creep = std::get<CreepShape>(test::DecidingProgram(axis, kKind).shape);
  EXPECT_EQ(creep.stroke_mm, 100.0);
  EXPECT_EQ(creep.repeats, 2);
}

TEST(CableSpring, ASpecimenPullsWithAShareOfTheFriction) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  const Drawn drawn = (*s.draw)(test::MachineToDrawFor(), 1.0, test::Numbers({0.5}));
  EXPECT_NEAR(drawn.size / 0.05, 0.1, 1e-12);
  const test::Emulated emulated = test::EmulatedWith((*s.effect)(drawn, test::MachineToDrawFor(), {}));
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_EQ(emulated.axis.effects.cable_spring->torque_at_stroke_end_Nm, drawn.size);
}

}  // namespace
}  // namespace contour::diagnosis
