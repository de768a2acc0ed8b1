#include "analysis/drive_loop/report_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace contour {
namespace {

/// A stroke there and back, whose offset and what the drive adds to it are slow beside the noise of reports.
std::vector<DriveSample> Strokes(double noise_N) {
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  std::vector<DriveSample> samples(4000);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    DriveSample& s = samples[k];
    s.good = true;
    s.velocity_m_s = k < 2000 ? 0.01 : -0.01;
    s.offset_N = k < 2000 ? 300.0 : -300.0;
    const double sent_N = k == 0 ? s.offset_N : samples[k - 1].offset_N;
    s.reported_N = sent_N + 20.0 * std::sin(1e-2 * static_cast<double>(k)) + noise_N * normal(generator);
  }
  return samples;
}

TEST(ReportNoise, IsWhatOneReportIsOffBy) {
  EXPECT_NEAR(ReportNoise_N(Strokes(40.0)), 40.0, 2.0);
  EXPECT_LT(ReportNoise_N(Strokes(0.0)), 0.2) << "neither the offset's step nor what changes slowly";
}

TEST(ReportNoise, TakesNothingFromRestAnExperimentOrLostCycles) {
  std::vector<DriveSample> samples = Strokes(2.0);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (k % 10 < 5) continue;
    samples[k].reported_N += k % 2 == 0 ? 500.0 : -500.0;
    if (k < 1000)
      samples[k].good = false;
    else if (k < 2000)
      samples[k].extra_N = 500.0;
    else
      samples[k].velocity_m_s = 0.0;
  }
  // Of the last kind the readings before and after are in no difference either.
  for (std::size_t k = 2000; k + 1 < samples.size(); ++k)
    if (samples[k].velocity_m_s == 0.0) samples[k + 1].velocity_m_s = 0.0;
  EXPECT_NEAR(ReportNoise_N(samples), 2.0, 0.2);
}

TEST(ReportNoise, OfTooLittleIsNone) {
  std::vector<DriveSample> samples = Strokes(40.0);
  samples.resize(80);
  EXPECT_EQ(ReportNoise_N(samples), 0.0);
  EXPECT_EQ(ReportNoise_N({}), 0.0);
}

}  // namespace
}  // namespace contour
