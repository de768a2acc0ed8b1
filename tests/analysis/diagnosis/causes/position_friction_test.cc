#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/stroke_shapes.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "position_friction";

TEST(PositionFriction, IsTheLevelAlongTheStroke) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "");
  std::vector<double> a(e->steps.size(), 0.0);
  a[0] = -0.2;
  a[1] = 0.05;
  const AxisModel m = test::With(axis, e, a);
  for (const std::size_t row : {0u, 300u, 1100u}) {
    const double part = 0.5 * (axis.signals().table_m[row] / 0.05 + 1.0);
    EXPECT_NEAR((*m.level)[row],
                -0.2 * std::cos(std::numbers::pi * part) + 0.05 * std::cos(2.0 * std::numbers::pi * part),
                1e-12);
  }
  EXPECT_FALSE(m.load_force);
  // From -0.2 + 0.05 at one end to +0.2 + 0.05 at the other.
  EXPECT_NEAR(test::Told(axis, e, a).at("amplitude_rel"), 0.2, 1e-9);
  EXPECT_EQ(*(*CauseNamed(kKind).shape)->per_unit, 1.0);
}

TEST(PositionFriction, TheShorterHypothesisIsSmooth) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "");
  ASSERT_TRUE(e->shorter);
  EXPECT_LT(e->shorter->steps.size(), e->steps.size());
  std::vector<double> a(e->shorter->steps.size(), 0.01), longer(e->steps.size(), 0.0);
  std::copy(a.begin(), a.end(), longer.begin());
  EXPECT_EQ(*test::With(axis, e->shorter, a).level, *test::With(axis, e, longer).level);
}

TEST(PositionFriction, TablesOfTwoLogsMultiply) {
  const ExtensionsConfig e =
      test::ExtendedBy({test::CauseWith(kKind, {{"amplitude_rel", 0.1}}, {-10, 10}, {-0.1, 0.1}),
                        test::CauseWith(kKind, {{"amplitude_rel", 0.2}}, {-10, 10}, {0.2, -0.2})});
  const auto [read, errors] = test::ThroughYaml(e);
  EXPECT_TRUE(errors.empty());
  EXPECT_NEAR(read.position_friction->friction_rel[0], 0.9 * 1.2 - 1.0, 1e-9);
  EXPECT_NEAR(read.position_friction->friction_rel[1], 1.1 * 0.8 - 1.0, 1e-9);
  EXPECT_NEAR(read.position_friction->amplitude_rel, 0.1, 1e-9);
  const test::Emulated emulated = test::SimulatedWith(kKind, e);
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_EQ(emulated.axis.effects.friction_map->friction_rel, read.position_friction->friction_rel);
  // Friction that would be negative.
  EXPECT_FALSE(test::ThroughYaml(test::ExtendedBy({test::CauseWith(kKind, {}, {-10, 10}, {-1.1, 0.1})}))
                   .errors.empty());
}

TEST(PositionFriction, IsDecidedByFullStrokesAndSoIsWhatDependsOnThePosition) {
  const test::KnownAxis axis;
  EXPECT_EQ(std::get<CreepShape>(test::DecidingProgram(axis, kKind).shape).stroke_mm, 100.0);
  EXPECT_EQ(*CauseNamed(kKind).shows_more_of, Quantity::kPosition);
}

TEST(PositionFriction, ASpecimenHasNoMeanOverTheTravel) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  for (const double u : {0.2, 0.8}) {
    const Drawn drawn = (*s.draw)(test::MachineToDrawFor(), 1.0, test::Numbers({u}));
    const double over_travel = drawn.order * 100.0 / 200.0;
    EXPECT_EQ(over_travel, std::round(over_travel));
    const test::Emulated emulated = test::EmulatedWith((*s.effect)(drawn, test::MachineToDrawFor(), {}));
    EXPECT_TRUE(emulated.errors.empty());
    EXPECT_EQ(emulated.axis.effects.position_friction->periods_per_stroke, drawn.order);
    EXPECT_EQ(emulated.axis.effects.position_friction->amplitude_rel,
              (*s.truth)(drawn, {}).at("amplitude_rel"));
  }
}

}  // namespace
}  // namespace contour::diagnosis
