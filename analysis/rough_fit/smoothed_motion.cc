#include "analysis/rough_fit/smoothed_motion.h"

#include <algorithm>
#include <cmath>

namespace contour::diagnosis {
namespace {

/// [s, rows] Deviation of the Gaussian behind each derivative, whichever is longer.
constexpr double kSmoothing_s = 3e-3, kSmoothingRows = 2.0;
/// [share of the largest speed] Below it the axis does not slide for certain.
constexpr double kSlides = 0.03;
/// [deviations of the smoothing] From one independent row to the next.
constexpr double kPerIndependentRow = 5.0;

/// The command in the middle of each row as it acts there.
Signal Acting(const AxisLog& log, const StatedAxis& stated) {
  const double rows = (stated.delay_s + stated.lag_s) / log.period_s + 0.5;
  Signal out(log.size());
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double at = std::max(0.0, static_cast<double>(k) - rows);
    const auto i = static_cast<std::size_t>(at);
    const std::size_t next = std::min(i + 1, log.size() - 1);
    out[k] = log.command[i] + (at - static_cast<double>(i)) * (log.command[next] - log.command[i]);
  }
  return out;
}

double SigmaRows(double period_s) { return std::max(kSmoothingRows, kSmoothing_s / period_s); }

void AddStretches(const AxisLog& log, const Signals& s, const StatedAxis& stated, double sigma,
                  SmoothedMotion& m) {
  const Signal acting = Acting(log, stated);
  const auto reach = static_cast<std::size_t>(8.0 * sigma) + 1;
  for (std::size_t b = 0; b < s.begins.size(); ++b) {
    const auto from = static_cast<std::ptrdiff_t>(s.begins[b]);
    const auto to = static_cast<std::ptrdiff_t>(b + 1 < s.begins.size() ? s.begins[b + 1] : log.size());
    const Signal q(s.position.begin() + from, s.position.begin() + to);
    const Signal w = Derivative(q, sigma, log.period_s);
    const Signal a = Derivative(w, sigma, log.period_s), v = Smooth(w, sigma);
    const Signal u = Smooth(Smooth(Signal(acting.begin() + from, acting.begin() + to), sigma), sigma);
    m.velocity.insert(m.velocity.end(), v.begin(), v.end());
    m.acceleration.insert(m.acceleration.end(), a.begin(), a.end());
    m.command.insert(m.command.end(), u.begin(), u.end());
    for (std::size_t k = 0; k < q.size(); ++k) m.counts.push_back(k >= reach && k + reach < q.size() ? 1 : 0);
  }
  for (std::size_t k = 0; k < log.size(); ++k) {
    if (log.present[k] != 0) continue;
    for (std::size_t i = k > reach ? k - reach : 0; i < std::min(log.size(), k + reach); ++i) m.counts[i] = 0;
  }
}

}  // namespace

double BeyondCoulomb(const StatedFriction& f, double vs, double velocity) {
  if (!(vs > 0.0)) return 0.0;
  const double part = velocity > 0.0 ? f.Fs_plus - f.Fc_plus : f.Fc_minus - f.Fs_minus;
  return part * std::exp(-std::pow(std::fabs(velocity) / vs, f.exponent));
}

bool SmoothedMotion::Slides(std::size_t k) const {
  return counts[k] != 0 && std::fabs(velocity[k]) >= kSlides * max_speed;
}

SmoothedMotion SmoothMotion(const AxisLog& log, const StatedAxis& stated, const StatedFriction* falling) {
  SmoothedMotion m;
  const Signals s = MakeSignals(log, stated);
  const double sigma = SigmaRows(log.period_s);
  AddStretches(log, s, stated, sigma, m);
  if (falling != nullptr)
    for (std::size_t k = 0; k < m.size(); ++k)
      m.command[k] -= BeyondCoulomb(*falling, falling->vs, m.velocity[k]);
  for (std::size_t k = 0; k < m.counts.size(); ++k)
    if (m.counts[k] != 0) m.max_speed = std::max(m.max_speed, std::fabs(m.velocity[k]));
  m.position = s.position;
  m.independent_rows = kPerIndependentRow * sigma;
  return m;
}

Signal SmoothAsMotion(const Signal& force, double period_s) {
  const double sigma = SigmaRows(period_s);
  return Smooth(Smooth(force, sigma), sigma);
}

}  // namespace contour::diagnosis
