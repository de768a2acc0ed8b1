#include "tools/identify/screw_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <unsupported/Eigen/FFT>

namespace contour::identify {
namespace {

constexpr std::size_t kSegment = 512;
/// Where the chirp may be: below, friction and mass say everything; above, little is left of the position.
constexpr double kLowest_Hz = 100.0;
constexpr double kHighest_share = 0.48;  ///< of the sampling rate
constexpr double kGoodCoherence = 0.7;

struct Spectra {
  std::vector<double> xx, ff;
  std::vector<std::complex<double>> xf;
  int segments = 0;
};

/// Only segments that are excited well above 100 Hz: a chirp, not a reversal. Second differences of the
/// position, so that windows do not smear the slow motion.
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
  for (std::size_t begin = 2; begin + kSegment < d.size(); begin += kSegment / 4) {
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
    double high = 0.0;
    for (std::size_t b = 0; b < bins; ++b)
      if (static_cast<double>(b) / (kSegment * t) >= kLowest_Hz) high += std::norm(ff[b]);
    // Two Newton rms in the band at least.
    if (high < 4.0 * kSegment * kSegment * 0.375 / 2.0) continue;
    for (std::size_t b = 0; b < bins; ++b) {
      s.xx[b] += std::norm(fx[b]);
      s.ff[b] += std::norm(ff[b]);
      s.xf[b] += fx[b] * std::conj(ff[b]);
    }
    ++s.segments;
  }
}

/// Accelerance of the motor of two masses joined by a damped spring.
double Accelerance_1_kg(double omega, double motor, double table, double k, double c) {
  const std::complex<double> link(k, omega * c);
  const double inertia = table * omega * omega;
  return std::abs((link - inertia) / (motor * (link - inertia) + table * link));
}

/// Share of the table, antiresonance and damping by a grid that closes in: the curve is smooth and cheap, and
/// its valley bent, which is no place for gradients.
void FitTwoMasses(ScrewResonance& r, double mass_kg, double dip_Hz) {
  double log_share = std::log(0.1), log_share_step = std::log(1.8);
  double f = dip_Hz, f_step = 0.02 * dip_Hz;
  double log_zeta = std::log(0.03), log_zeta_step = std::log(1.8);
  double best = 1e300;
  for (int zoom = 0; zoom < 14; ++zoom) {
    double at[3] = {log_share, f, log_zeta};
    for (int i = -3; i <= 3; ++i)
      for (int j = -3; j <= 3; ++j)
        for (int l = -3; l <= 3; ++l) {
          const double share = std::min(0.9, std::exp(log_share + i * log_share_step));
          const double fa = f + j * f_step;
          const double zeta = std::exp(log_zeta + l * log_zeta_step);
          const double table = share * mass_kg;
          const double motor = mass_kg - table;
          const double omega = 2.0 * std::numbers::pi * fa;
          const double k = table * omega * omega;
          const double c = 2.0 * zeta * std::sqrt(k * motor * table / mass_kg);
          // Near half the sampling rate the sampled response is another: leave it out. The level is free, the
          // mass is known from elsewhere, and better.
          double n = 0.0, sum = 0.0, square = 0.0;
          for (const ResponsePoint& p : r.response) {
            if (p.coherence < kGoodCoherence || p.frequency_Hz > 1.3 * dip_Hz) continue;
            const double e =
                std::log(p.accelerance_1_kg /
                         Accelerance_1_kg(2.0 * std::numbers::pi * p.frequency_Hz, motor, table, k, c));
            n += 1.0;
            sum += e;
            square += e * e;
          }
          const double rest = square - sum * sum / n;
          if (rest >= best) continue;
          best = rest;
          at[0] = std::log(share);
          at[1] = fa;
          at[2] = std::log(zeta);
          r.motor_mass_kg = motor;
          r.table_mass_kg = table;
          r.stiffness_N_m = k;
          r.damping_Ns_m = c;
          r.antiresonance_Hz = fa;
          r.resonance_Hz = fa * std::sqrt(mass_kg / motor);
        }
    log_share = at[0];
    f = at[1];
    log_zeta = at[2];
    log_share_step *= 0.6;
    f_step *= 0.6;
    log_zeta_step *= 0.6;
  }
  r.found = true;
}

}  // namespace

ScrewResonance FindResonance(const std::vector<Measured>& records, double mass_kg) {
  ScrewResonance r;
  Spectra s;
  for (const Measured& d : records) Add(d, s);
  if (s.segments < 4) {
    r.why_not = "no torque above 100 Hz in the record: the screw needs a chirp or a multisine";
    return r;
  }
  const double t = records.front().period_s;
  for (std::size_t b = 1; b < s.xx.size(); ++b) {
    const double frequency = static_cast<double>(b) / (kSegment * t);
    if (frequency < kLowest_Hz || frequency > kHighest_share / t) continue;
    const double coherence = std::norm(s.xf[b]) / std::max(1e-300, s.xx[b] * s.ff[b]);
    r.response.push_back({frequency, std::abs(s.xf[b]) / s.ff[b], coherence});
  }
  const auto gain = [&](std::size_t i) { return r.response[i].accelerance_1_kg; };
  // The antiresonance is the smallest gain; it counts when the gain rises well on both sides of it.
  std::size_t dip = 0;
  for (std::size_t i = 0; i < r.response.size(); ++i)
    if (r.response[i].coherence > kGoodCoherence &&
        r.response[i].accelerance_1_kg < r.response[dip].accelerance_1_kg)
      dip = i;
  std::size_t top = dip;
  while (top + 1 < r.response.size() &&
         (gain(top + 1) >= gain(top) || (top + 2 < r.response.size() && gain(top + 2) > gain(top))))
    ++top;
  if (dip < 4 || top + 4 >= r.response.size() || gain(top) < 1.3 * gain(dip) || gain(0) < 1.2 * gain(dip)) {
    r.why_not = "antiresonance and resonance of the screw are not inside the excited band";
    return r;
  }
  FitTwoMasses(r, mass_kg, r.response[dip].frequency_Hz);
  return r;
}

ScrewWindUp FitWindUp(const std::vector<Measured>& records, const AxisModel& axis) {
  // motor - table = S / K + constant, S the force through the screw; blocks of a second have a constant each,
  // so that the lead's error does not matter.
  ScrewWindUp fit;
  double ss = 0.0, sd = 0.0;
  struct Block {
    double ss, sd;
  };
  std::vector<Block> blocks;
  for (const Measured& d : records) {
    if (d.table_m.empty()) continue;
    const auto instants = Kinematics(d, axis.delay_s, axis.lag_s, 4, 4);
    for (std::size_t i = 0; i < instants.size();) {
      const double begin = instants[i].time_s;
      double n = 0.0, s1 = 0.0, d1 = 0.0, s2 = 0.0, sd2 = 0.0;
      for (; i < instants.size() && instants[i].time_s < begin + 1.0; ++i) {
        const double table = d.table_m[instants[i].row];
        if (!std::isfinite(table)) continue;
        const double force = instants[i].force_N - axis.motor_mass_kg * instants[i].acceleration_m_s2;
        const double wind_up = instants[i].position_m - table;
        n += 1.0;
        s1 += force;
        d1 += wind_up;
        s2 += force * force;
        sd2 += force * wind_up;
      }
      if (n < 20.0) continue;
      blocks.push_back({s2 - s1 * s1 / n, sd2 - s1 * d1 / n});
      ss += blocks.back().ss;
      sd += blocks.back().sd;
    }
  }
  if (blocks.size() < 4 || sd <= 0.0 || ss < 100.0 * static_cast<double>(blocks.size())) return fit;
  const double compliance = sd / ss;
  double scatter = 0.0;
  for (const Block& b : blocks) scatter += std::pow(b.sd - compliance * b.ss, 2);
  fit.found = true;
  fit.stiffness_N_m = 1.0 / compliance;
  fit.sigma_rel = std::sqrt(scatter) / sd;
  return fit;
}

}  // namespace contour::identify
