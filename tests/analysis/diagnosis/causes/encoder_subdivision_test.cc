#include <gtest/gtest.h>

#include <cmath>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/waves.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "encoder_subdivision";

TEST(EncoderSubdivision, IsAWaveOfTheReadingAtTheEncodersLines) {
  const test::KnownAxis axis;
  const SharedEffect e = WaveEffect(axis.problem, Wave::kReadingOfAngle, 128.0, 4096.0);
  EXPECT_EQ(e->kind, kKind);
  const std::vector<double> a = {2e-5 * std::cos(-1.0), 2e-5 * std::sin(-1.0)};
  const AxisModel m = test::With(axis, e, a);
  // A reading is of an instant and not of a row: no mean over the row, however fast it turns.
  for (const std::size_t row : {7u, 900u, 1999u})
    EXPECT_NEAR((*m.reading_error)[row], 2e-5 * std::sin(128.0 * axis.signals().angle_rad[row] - 1.0), 1e-14);
  const NamedValues told = test::Told(axis, e, a);
  EXPECT_NEAR(told.at("amplitude_rad"), 2e-5, 1e-15);
  EXPECT_EQ(told.at("order_per_rev"), 128.0);
  EXPECT_NEAR(told.at("phase_rad"), -1.0, 1e-9);
}

TEST(EncoderSubdivision, OnceATurnIsTheDisc) {
  const test::KnownAxis axis;
  EXPECT_NE(WaveEffect(axis.problem, Wave::kReadingOfAngle, 1.0, 1.0)->kind, kKind);
  EXPECT_EQ(*CauseNamed(kKind).grid, nullptr) << "its order is found by a scan";
  EXPECT_EQ(*CauseNamed(kKind).extension, nullptr);
}

TEST(EncoderSubdivision, IsToldInRadOfTheMotorWhereTheLogHasMetres) {
  const test::KnownAxis axis({.linear = true});
  const SharedEffect e = WaveEffect(axis.problem, Wave::kReadingOfAngle, 64.0, 1.0);
  EXPECT_NEAR(test::Told(axis, e, {2e-5 * test::KnownAxis::kTablePerRad, 0.0}).at("amplitude_rad"), 2e-5,
              1e-12);
  EXPECT_NEAR((*CauseNamed(kKind).largest)(axis.problem) / test::KnownAxis::kTablePerRad,
              (*CauseNamed(kKind).largest)(test::KnownAxis().problem), 1e-12);
}

TEST(EncoderSubdivision, IsDecidedByThreeSpeeds) {
  const test::KnownAxis axis;
  EXPECT_EQ(std::get<CreepShape>(test::DecidingProgram(axis, kKind).shape).velocities_mm_s.size(), 3u);
}

TEST(EncoderSubdivision, ASpecimenHasLinesThatEncodersHave) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  for (const double u : {0.0, 0.3, 0.999}) {
    const Drawn drawn = (*s.draw)(test::MachineToDrawFor(), 1.0, test::Numbers({u}));
    EXPECT_TRUE(IsWholeOrder(std::log2(drawn.order))) << drawn.order;
    const test::Emulated emulated = test::EmulatedWith((*s.effect)(drawn, test::MachineToDrawFor(), {}));
    EXPECT_TRUE(emulated.errors.empty());
    EXPECT_EQ(emulated.axis.effects.encoder_subdivision->order_per_rev,
              (*s.truth)(drawn, {}).at("order_per_rev"));
  }
}

}  // namespace
}  // namespace contour::diagnosis
