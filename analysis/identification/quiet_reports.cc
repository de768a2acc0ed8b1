#include "analysis/identification/quiet_reports.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <vector>

namespace contour::identify {
namespace {

/// Rows of a stretch: a chirp of some 1000 Hz a second stays within one of its frequencies for that long.
constexpr std::size_t kLength = 64;
constexpr std::size_t kHop = kLength / 2;
constexpr std::size_t kBins = kLength / 2 + 1;
/// What motion is made of is slower than this share of the sampling rate; noise is told from what is quicker.
constexpr std::size_t kQuickFrom = kLength / 4;
/// Mean over a bin and its neighbours in frequency and time, of the noise's: nine of half-overlapping
/// stretches hold some five that are independent, and so much is above it once in a few hundred.
constexpr double kStandsOut = 3.0;
/// Mean over median of a square that two normal numbers make.
constexpr double kMeanOverMedian = 1.0 / std::numbers::ln2;

using Spectrum = std::vector<std::complex<double>>;

/// Of each half-overlapping stretch, under Hann's window: they add up to one, and little of what is slow
/// leaks.
class Stretches {
 public:
  explicit Stretches(const std::vector<double>& x);
  /// The mean square of the quick bins, by its median: a chirp is in few of them at a time.
  [[nodiscard]] double NoiseLevel() const;
  void KeepWhatStandsOut(double level);
  [[nodiscard]] std::vector<double> Put(std::size_t rows);

 private:
  std::vector<double> window_;
  std::vector<Spectrum> spectra_;
  Eigen::FFT<double> fft_;
};

Stretches::Stretches(const std::vector<double>& x) : window_(kLength) {
  for (std::size_t i = 0; i < kLength; ++i)
    window_[i] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (static_cast<double>(i) + 0.5) / kLength);
  std::vector<double> part(kLength);
  for (std::size_t begin = 0; begin < x.size() + kHop; begin += kHop) {
    for (std::size_t i = 0; i < kLength; ++i) {
      // The first stretch begins half its length before the record.
      const std::size_t k = begin + i;
      part[i] = k >= kHop && k - kHop < x.size() ? window_[i] * x[k - kHop] : 0.0;
    }
    spectra_.emplace_back();
    fft_.fwd(spectra_.back(), part);
  }
}

double Stretches::NoiseLevel() const {
  std::vector<double> quick;
  for (const Spectrum& s : spectra_)
    for (std::size_t b = kQuickFrom; b < kBins - 1; ++b) quick.push_back(std::norm(s[b]));
  const auto middle = quick.begin() + static_cast<std::ptrdiff_t>(quick.size() / 2);
  std::nth_element(quick.begin(), middle, quick.end());
  return kMeanOverMedian * *middle;
}

void Stretches::KeepWhatStandsOut(double level) {
  std::vector<std::vector<double>> power;
  for (const Spectrum& s : spectra_) {
    power.emplace_back(kBins);
    for (std::size_t b = 0; b < kBins; ++b) power.back()[b] = std::norm(s[b]);
  }
  for (std::size_t i = 0; i < spectra_.size(); ++i) {
    for (std::size_t b = 0; b < kBins; ++b) {
      double sum = 0.0, count = 0.0;
      for (std::size_t j = i > 0 ? i - 1 : 0; j <= std::min(i + 1, spectra_.size() - 1); ++j)
        for (std::size_t c = b > 0 ? b - 1 : 0; c <= std::min(b + 1, kBins - 1); ++c, count += 1.0)
          sum += power[j][c];
      if (sum >= kStandsOut * level * count) continue;
      spectra_[i][b] = 0.0;
      if (b > 0 && b < kBins - 1) spectra_[i][kLength - b] = 0.0;
    }
  }
}

std::vector<double> Stretches::Put(std::size_t rows) {
  std::vector<double> x(rows, 0.0), part;
  for (std::size_t s = 0; s < spectra_.size(); ++s) {
    fft_.inv(part, spectra_[s]);
    for (std::size_t i = 0; i < kLength; ++i) {
      const std::size_t k = s * kHop + i;
      if (k >= kHop && k - kHop < rows) x[k - kHop] += part[i];
    }
  }
  return x;
}

}  // namespace

void QuietReports(double delay_s, Measured& data) {
  const std::size_t n = data.size();
  if (!data.led_by_drive() || n < 4 * kLength) return;
  // The offset that has acted for a period is settled in the report.
  const auto delay = static_cast<std::size_t>(std::max(0.0, delay_s) / data.period_s + 0.5);
  std::vector<double> own_N(data.reported_N);
  for (std::size_t k = delay + 1; k < n; ++k) own_N[k] -= data.offset_N[k - 1 - delay];
  Stretches stretches(own_N);
  stretches.KeepWhatStandsOut(stretches.NoiseLevel());
  const std::vector<double> quiet_N = stretches.Put(n);
  std::vector<double> change_N(n + delay + 1, 0.0);
  for (std::size_t k = 0; k < n; ++k) change_N[k] = quiet_N[k] - own_N[k];
  for (std::size_t k = 0; k < n; ++k) {
    data.reported_N[k] += change_N[k];
    // As a command: the mean of both ends of the period in which it acts.
    data.force_N[k] += 0.5 * (change_N[k + delay] + change_N[k + delay + 1]);
  }
}

}  // namespace contour::identify
