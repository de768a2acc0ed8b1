#include "analysis/drive_loop/drive_response.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;
constexpr std::size_t kLength = 200;
constexpr double kCompliance_m_N = 2e-9;

double Force_N(std::size_t k) {
  double sum = 0.0;
  for (const double n : {3.0, 10.0, 40.0})
    sum += std::cos(2.0 * std::numbers::pi * n * static_cast<double>(k) / kLength + n);
  return sum;
}

/// A sliding axis that answers three samples late, with a target that follows the excitation besides.
std::vector<DriveSample> Sliding(std::size_t stretches, double noise_m) {
  std::vector<DriveSample> out;
  std::uint32_t random = 1;
  for (std::size_t k = 0; k < stretches * kLength; ++k) {
    random = random * 1664525u + 1013904223u;
    DriveSample s;
    s.good = true;
    s.velocity_m_s = 0.01;
    const double way_m = s.velocity_m_s * kPeriod_s * static_cast<double>(k);
    s.target_m = way_m + 1e-7 * Force_N(k);
    const double told_m = k < 3 ? way_m : 0.5 * (out[k - 2].target_m + out[k - 3].target_m);
    s.position_m = told_m + kCompliance_m_N * (k < 3 ? 0.0 : Force_N(k - 3)) +
                   noise_m * (static_cast<double>(random) / 2147483648.0 - 1.0);
    s.extra_N = Force_N(k);
    s.offset_N = s.extra_N + 20.0;
    out.push_back(s);
  }
  return out;
}

TEST(MeasureDrive, FindsTravelPerForceAtTheLinesOfTheExcitation) {
  const DriveResponse r = MeasureDrive(Sliding(8, 0.0), kPeriod_s, kLength);
  ASSERT_EQ(r.lines.size(), 3u);
  EXPECT_GE(r.stretches, 6u);
  const double frequency_Hz[] = {15.0, 50.0, 200.0};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(r.lines[i].frequency_Hz, frequency_Hz[i], 1e-9);
    EXPECT_NEAR(std::abs(r.lines[i].compliance_m_N), kCompliance_m_N, 1e-6 * kCompliance_m_N);
    const double late = -2.0 * std::numbers::pi * frequency_Hz[i] * 3.0 * kPeriod_s;
    EXPECT_NEAR(std::remainder(std::arg(r.lines[i].compliance_m_N) - late, 2.0 * std::numbers::pi), 0.0,
                1e-5);
    EXPECT_LT(r.lines[i].scatter_rel, 1e-6);
  }
}

TEST(MeasureDrive, ScatterIsThatOfTheNoise) {
  const DriveResponse quiet = MeasureDrive(Sliding(20, 1e-10), kPeriod_s, kLength);
  const DriveResponse loud = MeasureDrive(Sliding(20, 1e-8), kPeriod_s, kLength);
  ASSERT_EQ(loud.lines.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(loud.lines[i].scatter_rel / quiet.lines[i].scatter_rel, 100.0, 20.0);
    const double off = std::abs(std::abs(loud.lines[i].compliance_m_N) / kCompliance_m_N - 1.0);
    EXPECT_LT(off, 4.0 * loud.lines[i].scatter_rel);
  }
}

TEST(MeasureDrive, TakesNoStretchInWhichTheSpeedChangesOrReadingsAreMissing) {
  std::vector<DriveSample> samples = Sliding(8, 0.0);
  for (std::size_t k = 0; k < samples.size(); k += kLength / 2) samples[k].good = false;
  EXPECT_EQ(MeasureDrive(samples, kPeriod_s, kLength).stretches, 0u);
  samples = Sliding(8, 0.0);
  for (std::size_t k = 0; k < samples.size(); ++k) samples[k].velocity_m_s += 1e-6 * static_cast<double>(k);
  EXPECT_EQ(MeasureDrive(samples, kPeriod_s, kLength).stretches, 0u);
}

}  // namespace
}  // namespace contour
