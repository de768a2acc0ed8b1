#include "analysis/identification/screw_response.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <unsupported/Eigen/FFT>

namespace contour::identify {
namespace {

constexpr std::size_t kSegment = 512;
/// Of the sampling rate; above, little is left of the position.
constexpr double kHighest_share = 0.48;
constexpr int kFewestSegments = 4;
/// Largest over smallest accelerance of a shaken axis that counts as rigid.
constexpr double kLeastDip = 2.5;
constexpr double kSeen = 0.6;  ///< coherence

struct Spectra {
  std::vector<double> xx, ff;
  std::vector<std::complex<double>> xf;
  int segments = 0;
};

/// Second differences of the position, so that windows do not smear the slow motion.
void Add(const Measured& d, Spectra& s) {
  const double t = d.period_s;
  Eigen::FFT<double> fft;
  std::vector<double> window(kSegment);
  for (std::size_t i = 0; i < kSegment; ++i)
    window[i] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (static_cast<double>(i) + 0.5) / kSegment);
  const auto bins = kSegment / 2 + 1;
  s.xx.resize(bins);
  s.ff.resize(bins);
  s.xf.resize(bins);
  for (std::size_t begin = d.run_up + 2; begin + kSegment < d.size(); begin += kSegment / 4) {
    std::vector<double> x(kSegment), f(kSegment);
    bool whole = true;
    for (std::size_t i = 0; i < kSegment && whole; ++i) {
      const std::size_t k = begin + i;
      whole = d.present[k - 1] && d.present[k] && d.present[k + 1];
      x[i] = (d.position_m[k + 1] - 2.0 * d.position_m[k] + d.position_m[k - 1]) / (t * t);
      f[i] = 0.5 * (d.force_N[k - 1] + d.force_N[k - 2]);
    }
    if (!whole) continue;
    const double mean_f = std::accumulate(f.begin(), f.end(), 0.0) / kSegment;
    for (std::size_t i = 0; i < kSegment; ++i) {
      x[i] *= window[i];
      f[i] = (f[i] - mean_f) * window[i];
    }
    std::vector<std::complex<double>> fx, ff;
    fft.fwd(fx, x);
    fft.fwd(ff, f);
    for (std::size_t b = 0; b < bins; ++b) {
      s.xx[b] += std::norm(fx[b]);
      s.ff[b] += std::norm(ff[b]);
      s.xf[b] += fx[b] * std::conj(ff[b]);
    }
    ++s.segments;
  }
}

}  // namespace

std::vector<ResponsePoint> MotorResponse(const std::vector<Measured>& records) {
  std::vector<ResponsePoint> response;
  Spectra s;
  for (const Measured& d : records) Add(d, s);
  if (s.segments < kFewestSegments) return response;
  const double t = records.front().period_s;
  for (std::size_t b = 1; b < s.xx.size(); ++b) {
    const double frequency = static_cast<double>(b) / (kSegment * t);
    if (frequency < kLowestShown_share / t || frequency > kHighest_share / t) continue;
    const double coherence = std::norm(s.xf[b]) / std::max(1e-300, s.xx[b] * s.ff[b]);
    response.push_back({frequency, std::abs(s.xf[b]) / s.ff[b], coherence, std::arg(s.xf[b])});
  }
  return response;
}

std::optional<ResponsePoint> VisibleAntiresonance(const std::vector<ResponsePoint>& response) {
  std::optional<ResponsePoint> low;
  double high = 0.0;
  for (std::size_t i = 1; i + 1 < response.size(); ++i) {
    ResponsePoint p = response[i];
    double coherence = 1.0;
    p.accelerance_1_kg = 0.0;
    for (std::size_t j = i - 1; j <= i + 1; ++j) {
      p.accelerance_1_kg += response[j].accelerance_1_kg / 3.0;
      coherence = std::min(coherence, response[j].coherence);
    }
    if (coherence < kSeen) continue;
    if (!low || p.accelerance_1_kg < low->accelerance_1_kg) low = p;
    high = std::max(high, p.accelerance_1_kg);
  }
  if (!low || high < kLeastDip * low->accelerance_1_kg) return std::nullopt;
  return low;
}

}  // namespace contour::identify
