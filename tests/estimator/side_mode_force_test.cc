#include "estimator/side_mode_force.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3, kTable_kg = 30.0;

double Acceleration(double t) { return t < 0.02 ? 0.0 : t < 0.06 ? 2.0 : t < 0.1 ? -1.5 : 0.0; }

AxisHorizon Reference(double t) {
  AxisHorizon h;
  for (int j = 0; j < 8; ++j) {
    ReferencePoint r;
    r.acceleration_m_s2 = Acceleration(t + kPeriod_s * j);
    h.push_back(r);
  }
  return h;
}

TEST(SideModeForce, IsWhatThePartsPullAtTheTableBesideTheirMass) {
  const std::vector<SideMode> modes{{90.0, 0.12, 0.02, 0.0}, {35.0, 0.05, 0.1, 0.0}};
  SideModeForce force(modes, kTable_kg, kPeriod_s);
  std::array<double, 2> way{}, rate{};
  double largest_N = 0.0;
  for (int k = 0; k < 300; ++k) {
    const double t = kPeriod_s * k;
    force.Follow(Reference(t), 8);
    double expected_N = 0.0;
    constexpr int kSteps = 2000;
    for (std::size_t i = 0; i < 2; ++i) {
      const double w = 2 * std::numbers::pi * modes[i].frequency_Hz;
      const auto second = [&](double a) {
        return -a - 2 * modes[i].damping_ratio * w * rate[i] - w * w * way[i];
      };
      expected_N += modes[i].mass_share_rel * kTable_kg * second(Acceleration(t));
      for (int n = 0; n < kSteps; ++n) {
        const double share = (n + 0.5) / kSteps;
        rate[i] +=
            second((1 - share) * Acceleration(t) + share * Acceleration(t + kPeriod_s)) * kPeriod_s / kSteps;
        way[i] += rate[i] * kPeriod_s / kSteps;
      }
    }
    largest_N = std::max(largest_N, std::abs(expected_N));
    ASSERT_NEAR(force.At_N(0), expected_N, 5e-3 * largest_N + 1e-9) << k;
  }
  EXPECT_GT(largest_N, 3.0);
}

TEST(SideModeForce, LooksAheadToWhatItWillSayThere) {
  SideModeForce force({{90.0, 0.12, 0.02, 0.0}}, kTable_kg, kPeriod_s);
  double ahead_N = 0.0;
  for (int k = 0; k < 150; ++k) {
    force.Follow(Reference(kPeriod_s * k), 8);
    if (k > 0) {
      EXPECT_NEAR(force.At_N(0), ahead_N, 1e-9) << k;
    }
    ahead_N = force.At_N(1);
  }
}

// After some periods nobody knows where a part is whose frequency is uncertain.
TEST(SideModeForce, FadesAsFastAsItsFrequencyIsUncertain) {
  SideModeForce known({{90.0, 0.12, 0.0, 0.0}}, kTable_kg, kPeriod_s);
  SideModeForce guessed({{90.0, 0.12, 0.0, 0.1}}, kTable_kg, kPeriod_s);
  double known_N = 0.0, guessed_N = 0.0;
  for (int k = 0; k < 400; ++k) {
    known.Follow(Reference(kPeriod_s * k), 8);
    guessed.Follow(Reference(kPeriod_s * k), 8);
    if (k < 300) continue;
    known_N = std::max(known_N, std::abs(known.At_N(0)));
    guessed_N = std::max(guessed_N, std::abs(guessed.At_N(0)));
  }
  EXPECT_GT(known_N, 1.0);
  EXPECT_LT(guessed_N, 1e-3 * known_N);
}

TEST(SideModeForce, WithoutModesThereIsNone) {
  SideModeForce none;
  none.Follow(Reference(0.03), 8);
  EXPECT_TRUE(none.none());
  EXPECT_EQ(none.At_N(0), 0.0);
  EXPECT_THROW(SideModeForce({{9, .1}, {9, .1}, {9, .1}}, kTable_kg, kPeriod_s), std::invalid_argument);
}

}  // namespace
}  // namespace contour
