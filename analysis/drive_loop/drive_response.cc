#include "analysis/drive_loop/drive_response.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace contour {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t kFewest = 4;
/// After a change of speed the loop settles for this share of a stretch.
constexpr double kSettle = 0.5;
/// Lines with less of the excitation than this share of the strongest say nothing.
constexpr double kWeakest = 0.05;
/// Speeds that differ by less are one.
constexpr double kSameSpeed = 1e-9;

bool Sliding(const DriveSample& a, const DriveSample& b) {
  return a.good && b.good && b.velocity_m_s != 0.0 &&
         std::abs(a.velocity_m_s - b.velocity_m_s) <= kSameSpeed * std::abs(b.velocity_m_s);
}

/// First rows of the stretches.
std::vector<std::size_t> Stretches(std::span<const DriveSample> samples, std::size_t length) {
  std::vector<std::size_t> found;
  const auto settle = static_cast<std::size_t>(kSettle * static_cast<double>(length));
  std::size_t since = 0;  // rows at one speed, with excitation
  for (std::size_t k = 1; k < samples.size(); ++k) {
    since = Sliding(samples[k - 1], samples[k]) ? since + 1 : 0;
    if (since < settle + length) continue;
    const std::size_t first = k + 1 - length;
    const bool excited = std::any_of(samples.begin() + static_cast<std::ptrdiff_t>(first),
                                     samples.begin() + static_cast<std::ptrdiff_t>(k + 1),
                                     [](const DriveSample& s) { return s.extra_N != 0.0; });
    if (excited) found.push_back(first);
    since = settle;
  }
  return found;
}

struct Sums {
  Complex by_extra{};  // position times the excitation's conjugate
  Complex offset{};    // offset times the same
};

/// Where the drive was told to be when a row's position was latched: a target is for two periods after its
/// row, and a drive is half a period behind its targets.
double Told_m(std::span<const DriveSample> samples, std::size_t row) {
  return 0.5 * (samples[row - 2].target_m + samples[row - 3].target_m);
}

/// Fourier coefficients at line `n` of the stretch that begins at `first`: what the axis deviates from its
/// target, which may answer to the excitation itself.
Sums AtLine(std::span<const DriveSample> samples, std::size_t first, std::size_t length, std::size_t n) {
  const double turn = 2.0 * std::numbers::pi * static_cast<double>(n) / static_cast<double>(length);
  Complex y{}, u{}, e{};
  const double base_m = samples[first].position_m - Told_m(samples, first);
  for (std::size_t k = 0; k < length; ++k) {
    const Complex w = std::polar(1.0, -turn * static_cast<double>(k));
    const DriveSample& s = samples[first + k];
    y += w * (s.position_m - Told_m(samples, first + k) - base_m);
    u += w * s.offset_N;
    e += w * s.extra_N;
  }
  return {y * std::conj(e), u * std::conj(e)};
}

}  // namespace

DriveResponse MeasureDrive(std::span<const DriveSample> samples, double period_s, std::size_t period_cycles) {
  DriveResponse out;
  const std::vector<std::size_t> stretches = Stretches(samples, period_cycles);
  out.stretches = stretches.size();
  if (stretches.size() < kFewest) return out;
  const double count = static_cast<double>(stretches.size());
  std::vector<double> strength;
  for (std::size_t n = 1; 2 * n < period_cycles; ++n) {
    Complex y{}, u{};
    std::vector<Sums> each;
    for (const std::size_t first : stretches) {
      each.push_back(AtLine(samples, first, period_cycles, n));
      y += each.back().by_extra;
      u += each.back().offset;
    }
    DriveResponse::Line line;
    line.frequency_Hz = static_cast<double>(n) / (static_cast<double>(period_cycles) * period_s);
    strength.push_back(std::abs(u));
    if (std::abs(u) > 0.0) {
      line.compliance_m_N = y / u;
      double square = 0.0;
      for (const Sums& s : each) square += std::norm(s.by_extra - line.compliance_m_N * s.offset);
      line.scatter_rel = std::sqrt(square / (count - 1.0) * count) / std::max(std::abs(y), 1e-300);
    }
    out.lines.push_back(line);
  }
  const double strongest = *std::max_element(strength.begin(), strength.end());
  std::vector<DriveResponse::Line> told;
  for (std::size_t i = 0; i < out.lines.size(); ++i)
    if (strength[i] > kWeakest * strongest) told.push_back(out.lines[i]);
  out.lines = std::move(told);
  return out;
}

}  // namespace contour
