#include "analysis/drive_loop/report_noise.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace contour {
namespace {

/// Fewer differences than that know their spread to no better than a tenth.
constexpr std::size_t kLeast = 100;
/// Of a normal distribution, the median of the absolute value over the standard deviation.
constexpr double kMedianOverStd = 0.6745;

}  // namespace

// By the median: where the axis starts, stops and turns round, the drive's torque changes at once.
double ReportNoise_N(std::span<const DriveSample> samples) {
  std::vector<double> changes_N;
  for (std::size_t k = 2; k < samples.size(); ++k) {
    const DriveSample &now = samples[k], &before = samples[k - 1], &older = samples[k - 2];
    if (!now.good || !before.good || !older.good || now.velocity_m_s == 0.0) continue;
    if (now.extra_N != 0.0 || before.extra_N != 0.0 || older.extra_N != 0.0) continue;
    // The offset of a row acts one period later.
    const double change_N = (now.reported_N - before.offset_N) - (before.reported_N - older.offset_N);
    changes_N.push_back(std::abs(change_N));
  }
  if (changes_N.size() < kLeast) return 0.0;
  const auto middle = changes_N.begin() + static_cast<std::ptrdiff_t>(changes_N.size() / 2);
  std::nth_element(changes_N.begin(), middle, changes_N.end());
  return *middle / (kMedianOverStd * std::sqrt(2.0));
}

}  // namespace contour
