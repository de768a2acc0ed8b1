#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/waves.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "encoder_eccentricity";

TEST(EncoderEccentricity, IsOneWaveOfTheReadingPerTurn) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "1.0");
  // 1 mrad sin(theta + 0.5).
  const std::vector<double> a = {1e-3 * std::cos(0.5), 1e-3 * std::sin(0.5)};
  const AxisModel m = test::With(axis, e, a);
  // Less what the true angle is behind the one that is read.
  for (const std::size_t row : {0u, 421u, 1500u})
    EXPECT_NEAR((*m.reading_error)[row], 1e-3 * std::sin(axis.signals().angle_rad[row] + 0.5), 0.6e-6);
  EXPECT_FALSE(m.motor_force);
  const NamedValues told = test::Told(axis, e, a);
  EXPECT_NEAR(told.at("amplitude_rad"), 1e-3, 1e-12);
  EXPECT_NEAR(told.at("phase_rad"), 0.5, 1e-9);
  EXPECT_FALSE(told.contains("order_per_rev")) << "it has no other order";
}

TEST(EncoderEccentricity, IsAWaveOfTheTrueAngleWhichTheEncoderDoesNotRead) {
  const test::KnownAxis axis;
  const double slope = 0.03;
  const std::vector<double> a = {slope * std::cos(0.5), slope * std::sin(0.5)};
  const AxisModel m = test::With(axis, test::OnGrid(axis, kKind, "1.0"), a);
  double twice = 0.0;
  for (std::size_t row = 0; row < axis.signals().angle_rad.size(); ++row) {
    const double read = axis.signals().angle_rad[row];
    double angle = read;
    for (int i = 0; i < 30; ++i) angle = read - slope * std::sin(angle + 0.5);
    ASSERT_NEAR((*m.reading_error)[row], read - angle, 1e-8);
    twice = std::max(twice, std::abs(read - angle - slope * std::sin(read + 0.5)));
  }
  EXPECT_NEAR(twice, 0.5 * slope * slope, 0.05 * slope * slope) << "a wave of twice the order";
}

TEST(EncoderEccentricity, WithoutAnAngleThatItTellsStaysAWave) {
  const test::KnownAxis axis;
  const AxisModel m = test::With(axis, test::OnGrid(axis, kKind, "1.0"), {1.5, 0.0});
  EXPECT_NEAR((*m.reading_error)[421], 1.5 * std::sin(axis.signals().angle_rad[421]), 1e-12);
}

TEST(EncoderEccentricity, IsToldInRadOfTheMotorWhereTheLogHasMetres) {
  const test::KnownAxis axis({.linear = true});
  const double metres = 1e-3 * test::KnownAxis::kTablePerRad;
  EXPECT_NEAR(test::Told(axis, test::OnGrid(axis, kKind, "1.0"), {metres, 0.0}).at("amplitude_rad"), 1e-3,
              1e-12);
  EXPECT_NEAR((*CauseNamed(kKind).largest)(axis.problem) / test::KnownAxis::kTablePerRad,
              (*CauseNamed(kKind).largest)(test::KnownAxis().problem), 1e-12);
}

TEST(EncoderEccentricity, IsNoneWhereTheDiscWouldTurnAboutItsRim) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "1.0");
  const auto implausible = *CauseNamed(kKind).implausible;
  EXPECT_FALSE(implausible(axis.problem, *e, {0.02, 0.03}));
  EXPECT_TRUE(implausible(axis.problem, *e, {0.6, 0.8}));
}

TEST(EncoderEccentricity, OtherOrdersAreTheEncodersLines) {
  const test::KnownAxis axis;
  EXPECT_EQ(WaveEffect(axis.problem, Wave::kReadingOfAngle, 1.0, 1.0)->kind, kKind);
  EXPECT_NE(WaveEffect(axis.problem, Wave::kReadingOfAngle, 2.0, 1.0)->kind, kKind);
  EXPECT_EQ(*CauseNamed(kKind).extension, nullptr);
}

TEST(EncoderEccentricity, IsDecidedByThreeSpeeds) {
  const test::KnownAxis axis;
  EXPECT_EQ(std::get<CreepShape>(test::DecidingProgram(axis, kKind).shape).velocities_mm_s,
            (std::vector<double>{3.14, 47.1, 149.0}));
}

TEST(EncoderEccentricity, ASpecimenHasThePhaseThatWasDrawn) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  Drawn drawn = (*s.draw)(test::MachineToDrawFor(), 1.0, test::Numbers({0.5}));
  drawn.phase_rad = 1.5;
  const test::Emulated emulated = test::EmulatedWith((*s.effect)(drawn, test::MachineToDrawFor(), {}));
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_EQ(emulated.axis.effects.encoder_eccentricity->phase_rad, 1.5);
  EXPECT_EQ(emulated.axis.effects.encoder_eccentricity->amplitude_rad,
            (*s.truth)(drawn, {}).at("amplitude_rad"));
}

}  // namespace
}  // namespace contour::diagnosis
