#include "analysis/identification/quiet_reports.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace contour::test {
namespace {

using identify::Measured;

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr std::size_t kRows = 20000;
constexpr std::size_t kDelay = 1;

/// What the loop adds: friction at slow strokes, and in each fifth second the answer to a chirp.
double Own_N(std::size_t k) {
  const double t = 1e-3 * static_cast<double>(k);
  const double in = std::fmod(t, 5.0);
  const double chirp = in < 0.5 ? 120.0 * std::sin(kTwoPi * (40.0 * in + 440.0 * in * in)) : 0.0;
  return 300.0 * std::sin(kTwoPi * 0.4 * t) + chirp;
}
double Offset_N(std::size_t k) { return k % 700 < 350 ? 50.0 : -30.0; }

Measured Reported(double noise_N) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  Measured data;
  data.period_s = 1e-3;
  for (std::size_t k = 0; k < kRows; ++k) {
    data.offset_N.push_back(Offset_N(k));
    data.reported_N.push_back(Own_N(k) + (k > kDelay ? Offset_N(k - 1 - kDelay) : 0.0) +
                              noise_N * normal(random));
    data.force_N.push_back(0.0);
  }
  for (std::size_t k = 0; k + kDelay + 1 < kRows; ++k) {
    const auto own = [&](std::size_t at) { return data.reported_N[at] - Offset_N(at - 1 - kDelay); };
    data.force_N[k] = Offset_N(k) + 0.5 * (own(k + kDelay + 1) + (k > 0 ? own(k + kDelay) : 0.0));
  }
  return data;
}

/// Rms of reports less offset against what the loop added, where its chirp is and where it is not.
double Apart_N(const Measured& data, bool chirp) {
  double sum = 0.0, n = 0.0;
  for (std::size_t k = 100; k + 100 < kRows; ++k) {
    if ((k % 5000 < 500) != chirp) continue;
    sum += std::pow(data.reported_N[k] - Offset_N(k - 1 - kDelay) - Own_N(k), 2);
    n += 1.0;
  }
  return std::sqrt(sum / n);
}

TEST(QuietReports, TakesTheNoiseOffAndLeavesMotionAndChirp) {
  Measured data = Reported(30.0);
  ASSERT_NEAR(Apart_N(data, false), 30.0, 1.0);
  const std::vector<double> force_N = data.force_N, reported_N = data.reported_N;
  identify::QuietReports(1e-3 * kDelay, data);
  EXPECT_LT(Apart_N(data, false), 12.0);
  EXPECT_LT(Apart_N(data, true), 20.0);
  // The same as a command, which is the mean of two ends.
  for (std::size_t k = 1000; k < 2000; ++k) {
    const auto change = [&](std::size_t at) { return data.reported_N[at] - reported_N[at]; };
    EXPECT_NEAR(data.force_N[k] - force_N[k], 0.5 * (change(k + kDelay) + change(k + kDelay + 1)), 1e-9);
  }
}

TEST(QuietReports, LeavesReportsWithoutNoiseAsTheyAre) {
  Measured data = Reported(0.1);
  identify::QuietReports(1e-3 * kDelay, data);
  EXPECT_LT(Apart_N(data, false), 0.5);
  EXPECT_LT(Apart_N(data, true), 0.5);
}

TEST(QuietReports, LeavesAnAxisThatIsCommandedAlone) {
  Measured data = Reported(30.0);
  data.offset_N.clear();
  data.reported_N.clear();
  const std::vector<double> force_N = data.force_N;
  identify::QuietReports(1e-3 * kDelay, data);
  EXPECT_EQ(data.force_N, force_N);
}

}  // namespace
}  // namespace contour::test
