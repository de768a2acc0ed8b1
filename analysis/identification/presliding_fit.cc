#include "analysis/identification/presliding_fit.h"

#include <algorithm>
#include <cmath>

namespace contour::identify {
namespace {

constexpr double kSlow_m_s = 1e-3;         ///< faster reversals tell of mass and damping, not of stiffness
constexpr std::size_t kFewestSamples = 4;  ///< of a slope
constexpr double kLeastLoop_m = 1.5e-6;    ///< what shaking at rest stays below
constexpr double kShareOfLength = 0.12;    ///< of Fc / sigma0: how far a slope is looked at

double Friction_N(const Instant& i, const TableAxis& axis) {
  return i.force_N + axis.offset - axis.mass_kg() * i.acceleration_m_s2;
}
double Table_m(const Instant& i, const TableAxis& axis) {
  return i.position_m - (i.force_N - axis.motor_inertia * i.acceleration_m_s2) / axis.stiffness;
}

/// Stretches of one direction: [first, last] of the instants.
struct Stroke {
  std::size_t first = 0, last = 0;
  bool up = false;
};
std::vector<Stroke> Strokes(const std::vector<Instant>& instants) {
  std::vector<Stroke> strokes;
  for (std::size_t i = 1; i < instants.size(); ++i) {
    const bool goes_on = instants[i].since_reversal_m >= instants[i - 1].since_reversal_m &&
                         instants[i].time_s - instants[i - 1].time_s < 0.05;
    if (!goes_on || strokes.empty()) {
      strokes.push_back({i, i, instants[i].velocity_m_s > 0.0});
    } else {
      strokes.back().last = i;
      if (instants[i].since_reversal_m > 0.0) strokes.back().up = instants[i].velocity_m_s > 0.0;
    }
  }
  return strokes;
}

double Quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

}  // namespace

PreslidingFit FitPresliding(const std::vector<Instant>& instants, const TableAxis& axis) {
  PreslidingFit fit;
  std::vector<double> found;
  const diagnosis::StatedFriction& f = axis.friction;
  const double length = kShareOfLength * std::min(f.Fc_plus, f.Fc_minus) / f.s0;
  for (const Stroke& s : Strokes(instants)) {
    const double g = s.up ? f.Fs_plus : f.Fs_minus;
    const Instant& turn = instants[s.first];
    const double turn_m = Table_m(turn, axis);
    // Least squares of force on travel over the first piece; its slope is that of about its middle.
    double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    for (std::size_t i = s.first; i <= s.last; ++i) {
      if (std::fabs(instants[i].velocity_m_s) > kSlow_m_s) break;
      const double x = Table_m(instants[i], axis) - turn_m;
      const double y = Friction_N(instants[i], axis);
      if (std::fabs(x) > length) break;
      n += 1.0;
      sx += x;
      sy += y;
      sxx += x * x;
      sxy += x * y;
    }
    const double spread = sxx - sx * sx / std::max(1.0, n);
    if (n < static_cast<double>(kFewestSamples) || spread < n * 1e-2 * length * length) continue;
    const double slope = (sxy - sx * sy / n) / spread;
    const double mean_N = sy / n;
    // dF/dx = sigma0 (1 - F sign(v) / g).
    const double against = 1.0 - (s.up ? 1.0 : -1.0) * mean_N / g;
    if (slope <= 0.0 || against < 0.5) continue;
    found.push_back(slope / against);
  }
  fit.reversals = found.size();
  if (found.size() < 3) return fit;
  fit.found = true;
  fit.sigma0_N_m = Quantile(found, 0.5);
  fit.spread_N_m = 0.5 * (Quantile(found, 0.75) - Quantile(found, 0.25));
  return fit;
}

std::vector<BreakAway> BreakAways(const std::vector<Instant>& instants, const TableAxis& axis) {
  std::vector<BreakAway> levels;
  const double length = std::max(axis.friction.Fs_plus, axis.friction.Fs_minus) / axis.friction.s0;
  for (const Stroke& s : Strokes(instants)) {
    if (instants[s.last].since_reversal_m < 8.0 * length) continue;
    BreakAway b;
    const double sign = s.up ? 1.0 : -1.0;
    for (std::size_t i = s.first; i <= s.last && instants[i].since_reversal_m < 8.0 * length; ++i) {
      const double force = sign * Friction_N(instants[i], axis);
      if (force > sign * b.force_N) b = {sign * force, instants[i].velocity_m_s};
    }
    if (b.force_N != 0.0) levels.push_back(b);
  }
  return levels;
}

std::vector<LoopPoint> PreslidingLoops(const std::vector<Instant>& instants, const TableAxis& axis,
                                       double largest_m) {
  std::vector<LoopPoint> points;
  for (const Stroke& s : Strokes(instants)) {
    const bool moved = instants[s.last].since_reversal_m > kLeastLoop_m;
    if (!moved || instants[s.last].since_reversal_m > largest_m) continue;
    for (std::size_t i = s.first; i <= s.last; ++i)
      points.push_back({instants[i].time_s, Table_m(instants[i], axis), Friction_N(instants[i], axis)});
  }
  return points;
}

}  // namespace contour::identify
