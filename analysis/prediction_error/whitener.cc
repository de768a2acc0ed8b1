#include "analysis/prediction_error/whitener.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "analysis/diagnosis/tuning/prediction_tuning.h"
#include "analysis/prediction_error/levinson.h"

namespace contour::diagnosis {
namespace {

constexpr std::size_t kSegment = kNoise.spectrum_rows;
constexpr std::size_t kOrder = kNoise.whitener_order;
constexpr int kSmoothBins = kNoise.smooth_bins;
constexpr std::size_t kLineBins = kNoise.line_bins;

}  // namespace

void FourierTransform(std::vector<double>& re, std::vector<double>& im, bool inverse) {
  const std::size_t n = re.size();
  for (std::size_t i = 1, j = 0; i < n; ++i) {
    std::size_t bit = n >> 1;
    for (; (j & bit) != 0; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) {
      std::swap(re[i], re[j]);
      std::swap(im[i], im[j]);
    }
  }
  std::vector<double> c(n / 2), s(n / 2);
  const double turn = (inverse ? 2.0 : -2.0) * std::numbers::pi / static_cast<double>(n);
  for (std::size_t i = 0; i < n / 2; ++i) {
    c[i] = std::cos(turn * static_cast<double>(i));
    s[i] = std::sin(turn * static_cast<double>(i));
  }
  for (std::size_t size = 2; size <= n; size <<= 1) {
    const std::size_t half = size / 2, stride = n / size;
    for (std::size_t i = 0; i < n; i += size)
      for (std::size_t j = 0; j < half; ++j) {
        const std::size_t a = i + j, b = a + half, t = j * stride;
        const double x = re[b] * c[t] - im[b] * s[t], y = re[b] * s[t] + im[b] * c[t];
        re[b] = re[a] - x;
        im[b] = im[a] - y;
        re[a] += x;
        im[a] += y;
      }
  }
}

namespace {

using Spectra = std::vector<std::vector<double>>;

/// Starts of half overlapping segments in which nearly every row is valid.
std::vector<std::size_t> ValidSegments(const std::vector<std::uint8_t>& valid, std::size_t n,
                                       std::size_t length) {
  std::vector<std::size_t> starts;
  for (std::size_t at = 0; at + length <= n; at += length / 2) {
    std::size_t good = 0;
    for (std::size_t i = 0; i < length; ++i) good += valid[at + i] != 0 ? 1U : 0U;
    if (good * 10 > length * 9) starts.push_back(at);
  }
  return starts;
}

/// Power of each segment under a Hann window, two segments per transform.
Spectra SpectraOf(std::span<const double> residual, const std::vector<std::size_t>& starts,
                  std::size_t length) {
  std::vector<double> window(length), re(length), im(length);
  double power = 0.0;
  for (std::size_t i = 0; i < length; ++i) {
    window[i] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (static_cast<double>(i) + 0.5) /
                                     static_cast<double>(length));
    power += window[i] * window[i];
  }
  const std::size_t bins = length / 2 + 1;
  Spectra spectra;
  for (std::size_t p = 0; p < starts.size(); p += 2) {
    const bool both = p + 1 < starts.size();
    for (std::size_t i = 0; i < length; ++i) {
      re[i] = residual[starts[p] + i] * window[i];
      im[i] = both ? residual[starts[p + 1] + i] * window[i] : 0.0;
    }
    FourierTransform(re, im, false);
    std::vector<double> first(bins), second(bins);
    for (std::size_t i = 0; i < bins; ++i) {
      const std::size_t j = (length - i) % length;
      const double ar = 0.5 * (re[i] + re[j]), ai = 0.5 * (im[i] - im[j]);
      const double br = 0.5 * (im[i] + im[j]), bi = -0.5 * (re[i] - re[j]);
      first[i] = (ar * ar + ai * ai) / power;
      second[i] = (br * br + bi * bi) / power;
    }
    spectra.push_back(std::move(first));
    if (both) spectra.push_back(std::move(second));
  }
  return spectra;
}

double Median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The mean power by its median over the segments: exponentially distributed.
std::vector<double> DensityOf(const Spectra& spectra) {
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

std::vector<double> SmoothOverBins(const std::vector<double>& level) {
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
  const std::size_t n = residual.size();
  std::size_t length = kSegment;
  while (length > n / 8 && length > 256) length /= 2;
  const Spectra spectra = SpectraOf(residual, ValidSegments(valid, n, length), length);
  if (spectra.empty()) return;
  const std::vector<double> smooth = SmoothOverBins(WithoutLines(DensityOf(spectra)));
  double largest = 0.0;
  for (const double power : smooth) largest = std::max(largest, power);
  // Its autocorrelation.
  std::vector<double> re(length, 0.0), im(length, 0.0);
  for (std::size_t i = 0; i < smooth.size(); ++i) {
    re[i] = std::max(smooth[i], 1e-9 * largest + 1e-300);
    re[(length - i) % length] = re[i];
  }
  FourierTransform(re, im, true);
  const std::size_t order = std::min(kOrder, length / 8);
  ErrorFilter filter = MakeErrorFilter(std::span(re).first(order + 1));
  const double error = filter.left / static_cast<double>(length);
  taps_ = std::move(filter.taps);
  for (double& t : taps_) t /= std::sqrt(error);
}

}  // namespace contour::diagnosis
