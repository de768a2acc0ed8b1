#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/stroke_shapes.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "pitch_error";

TEST(PitchError, IsWhatTheScaleReadsOverTheStrokeInMetres) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "");
  std::vector<double> a(e->steps.size(), 0.0);
  a[0] = 2e-6;  // half a period over the stroke
  a[2] = 1e-6;  // three halves
  const AxisModel m = test::With(axis, e, a);
  for (const std::size_t row : {0u, 300u, 1100u}) {
    const double part = 0.5 * (axis.signals().table_m[row] / 0.05 + 1.0);
    EXPECT_NEAR((*m.scale_error_m)[row],
                2e-6 * std::cos(std::numbers::pi * part) + 1e-6 * std::cos(3.0 * std::numbers::pi * part),
                1e-15);
  }
  EXPECT_FALSE(m.level || m.load_force || m.reading_error);
  // Highest and lowest are the ends: +3 um and -3 um.
  EXPECT_NEAR(test::Told(axis, e, a).at("amplitude_um"), 3.0, 1e-9);
  EXPECT_EQ(*(*CauseNamed(kKind).shape)->per_unit, 1e6);
}

TEST(PitchError, IsOnceAndTwicePerTurnOfTheScrewToo) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "per turn");
  const std::vector<double> a = {3e-6, 0.0, 0.0, 1e-6};
  const AxisModel m = test::With(axis, e, a);
  for (const std::size_t row : {0u, 300u, 1100u}) {
    const double angle = axis.signals().angle_rad[row];
    EXPECT_NEAR((*m.scale_error_m)[row], 3e-6 * std::sin(angle) + 1e-6 * std::cos(2.0 * angle), 1e-15);
  }
  const NamedValues told = test::Told(axis, e, a);
  EXPECT_NEAR(told.at("amplitude_once_per_turn_um"), 3.0, 1e-9);
  EXPECT_NEAR(told.at("amplitude_twice_per_turn_um"), 1.0, 1e-9);
  // Highest at one of sin(x) = 1 / 1.5: 3 sin + 1 - 2 sin^2; lowest at sin = -1: -3 - 1.
  EXPECT_NEAR(told.at("amplitude_um"), 0.5 * (2.0 + 1.0 - 8.0 / 9.0 * 1.0 + 4.0), 0.2);
}

TEST(PitchError, WithoutAScaleIsNotLookedFor) {
  EXPECT_TRUE(test::GridOf(test::KnownAxis({.scale = false}), kKind).empty());
  EXPECT_TRUE(*CauseNamed(kKind).judged_at_scale);
}

TEST(PitchError, TablesOfTwoLogsAddUp) {
  const ExtensionsConfig e =
      test::ExtendedBy({test::CauseWith(kKind, {{"amplitude_um", 9.0}}, {-10, 0, 10}, {-1, 0, 1}),
                        test::CauseWith(kKind, {{"amplitude_um", 9.0}}, {-10, 0, 10}, {0, 1.5, 2})});
  const auto [read, errors] = test::ThroughYaml(e);
  EXPECT_TRUE(errors.empty());
  EXPECT_EQ(read.pitch_error->error_um, (std::vector<double>{-1, 1.5, 3}));
  EXPECT_DOUBLE_EQ(read.pitch_error->amplitude_um, 2.0) << "of the sum, not the sum of both";
  const test::Emulated emulated = test::SimulatedWith(kKind, e);
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_EQ(emulated.axis.effects.pitch_map->error_um, (std::vector<double>{-1, 1.5, 3}));
  EXPECT_EQ(emulated.axis.effects.pitch_map->position_mm, (std::vector<double>{-10, 0, 10}));
}

TEST(PitchError, WithoutATableNothingIsAdded) {
  EXPECT_FALSE(test::ExtendedBy({test::CauseWith(kKind, {{"amplitude_um", 9.0}})}).pitch_error);
}

TEST(PitchError, IsDecidedByFullStrokes) {
  const test::KnownAxis axis;
  EXPECT_EQ(std::get<CreepShape>(test::DecidingProgram(axis, kKind).shape).stroke_mm, 100.0);
}

TEST(PitchError, ASpecimenThatNoScaleCanTellIsUndecidable) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  EXPECT_TRUE((*s.needs).scale);
  EXPECT_TRUE((*s.undecidable)({.size = 1e-3}, false));
  EXPECT_FALSE((*s.undecidable)({.size = -5.0}, true));
  const Drawn drawn = (*s.draw)(test::MachineToDrawFor(), 1.0, test::Numbers({0.2}));
  EXPECT_EQ(drawn.order, 2.0) << "one period over 100 of 200 mm";
  const test::Emulated emulated = test::EmulatedWith((*s.effect)(drawn, test::MachineToDrawFor(), {}));
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_EQ(emulated.axis.effects.pitch_error->periods_per_stroke, 2.0);
  EXPECT_EQ((*s.truth)({.size = -3.0}, {}).at("amplitude_um"), 3.0);
}

}  // namespace
}  // namespace contour::diagnosis
