#include "analysis/prediction_error/whitener.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "analysis/diagnosis/tuning/prediction_tuning.h"
#include "analysis/prediction_error/fourier_transform.h"
#include "analysis/prediction_error/levinson.h"

namespace contour::diagnosis {
namespace {

constexpr std::size_t kSegment = kNoise.spectrum_rows;
constexpr std::size_t kOrder = kNoise.whitener_order;
constexpr int kSmoothBins = kNoise.smooth_bins;
constexpr std::size_t kLineBins = kNoise.line_bins;

double Median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Power per bin of Welch's segments in which nine rows of ten count.
std::vector<std::vector<double>> Spectra(std::span<const double> residual,
                                         const std::vector<std::uint8_t>& valid, std::size_t length) {
  std::vector<double> window(length), segment(length);
  double power = 0.0;
  for (std::size_t i = 0; i < length; ++i) {
    window[i] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (static_cast<double>(i) + 0.5) /
                                     static_cast<double>(length));
    power += window[i] * window[i];
  }
  std::vector<std::vector<double>> spectra;
  for (std::size_t at = 0; at + length <= residual.size(); at += length / 2) {
    std::size_t good = 0;
    for (std::size_t i = 0; i < length; ++i) good += valid[at + i] != 0 ? 1U : 0U;
    if (good * 10 <= length * 9) continue;
    for (std::size_t i = 0; i < length; ++i) segment[i] = residual[at + i] * window[i];
    std::vector<double>& density = spectra.emplace_back();
    for (const std::complex<double>& x : FourierTransform(segment)) density.push_back(std::norm(x) / power);
  }
  return spectra;
}

/// Median over time, as the mean of a chi-square of two degrees.
std::vector<double> OverTime(const std::vector<std::vector<double>>& spectra) {
  std::vector<double> density(spectra[0].size()), column(spectra.size());
  for (std::size_t i = 0; i < density.size(); ++i) {
    for (std::size_t j = 0; j < spectra.size(); ++j) column[j] = spectra[j][i];
    density[i] = Median(column) / std::numbers::ln2;
  }
  return density;
}

/// A line is no noise: a force of one frequency stays for the candidates to explain.
std::vector<double> WithoutLines(const std::vector<double>& density) {
  const std::size_t bins = density.size();
  std::vector<double> level(bins), near;
  for (std::size_t i = 0; i < bins; ++i) {
    near.clear();
    const std::size_t from = i > kLineBins ? i - kLineBins : 1, to = std::min(bins - 1, i + kLineBins);
    for (std::size_t j = from; j <= to; ++j) near.push_back(density[j]);
    level[i] = Median(near);
  }
  return level;
}

std::vector<double> Smoothed(const std::vector<double>& level) {
  const std::size_t bins = level.size();
  std::vector<double> smooth(bins);
  for (std::size_t i = 0; i < bins; ++i) {
    double sum = 0.0;
    int count = 0;
    for (int d = -kSmoothBins; d <= kSmoothBins; ++d) {
      const auto j = static_cast<std::ptrdiff_t>(i) + d;
      const auto mirrored = static_cast<std::size_t>(j < 0 ? -j : j);
      if (mirrored >= bins || mirrored == 0) continue;
      sum += level[mirrored];
      ++count;
    }
    smooth[i] = sum / std::max(1, count);
  }
  return smooth;
}

}  // namespace

Whitener::Whitener(std::span<const double> residual, const std::vector<std::uint8_t>& valid) {
  std::size_t length = kSegment;
  while (length > residual.size() / 8 && length > 256) length /= 2;
  const std::vector<std::vector<double>> spectra = Spectra(residual, valid, length);
  if (spectra.empty()) return;
  const std::vector<double> smooth = Smoothed(WithoutLines(OverTime(spectra)));
  const double largest = *std::max_element(smooth.begin(), smooth.end());
  HalfSpectrum spectrum;
  for (const double density : smooth) spectrum.emplace_back(std::max(density, 1e-9 * largest + 1e-300), 0.0);
  const std::vector<double> autocovariance = InverseFourierTransform(spectrum);
  const std::size_t order = std::min(kOrder, length / 8);
  ErrorFilter filter = MakeErrorFilter(std::span(autocovariance).first(order + 1));
  taps_ = std::move(filter.taps);
  for (double& t : taps_) t /= std::sqrt(filter.left);
}

}  // namespace contour::diagnosis
