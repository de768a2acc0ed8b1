#include "analysis/prediction_error/extras.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "analysis/prediction_error/wave_signals.h"

namespace contour::diagnosis {
namespace {

/// Along the log; empty without a table.
Signal Along(const StatedTable& table, const Signals& s) {
  Signal out;
  if (table.position_m.empty()) return out;
  for (const double x : s.table_m) out.push_back(ValueAt(table.position_m, table.value, x + s.middle_m));
  return out;
}

/// Sum of the waves, two elements per row; empty without waves.
Signal Along(const std::vector<StatedWave>& waves, const Signals& s) {
  Signal sum;
  std::vector<double> phase(s.angle_rad.size());
  for (const StatedWave& w : waves) {
    for (std::size_t k = 0; k < phase.size(); ++k) phase[k] = w.order_per_rev * s.angle_rad[k] + w.phase_rad;
    const SharedSignal sine = WaveSignals(phase, {})[0];
    sum.resize(sine->size(), 0.0);
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += w.amplitude * (*sine)[k];
  }
  return sum;
}

/// Sum of the waves at the rows themselves: what a scale reads, not what acts over a row.
Signal AtRows(const std::vector<StatedWave>& waves, const Signals& s) {
  Signal sum;
  if (waves.empty()) return sum;
  for (const double angle_rad : s.angle_rad) {
    double at = 0.0;
    for (const StatedWave& w : waves) at += w.amplitude * std::sin(w.order_per_rev * angle_rad + w.phase_rad);
    sum.push_back(at);
  }
  return sum;
}

SharedSignal Share(Signal s) {
  return s.empty() ? SharedSignal() : std::make_shared<const Signal>(std::move(s));
}

/// Either may be empty, or have two elements per row where the other has one.
template <class F>
Signal Joined(const Signal& a, const Signal& b, F&& f) {
  if (a.empty() || b.empty()) return a.empty() ? b : a;
  Signal out = a.size() < b.size() ? Doubled(a) : a;
  const Signal other = b.size() < out.size() ? Doubled(b) : b;
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = f(out[k], other[k]);
  return out;
}

/// Sum of the curves, which resist; empty without any.
Signal Along(const std::vector<StatedDrag>& curves, const Signals& s) {
  Signal out;
  for (const StatedDrag& d : curves) {
    out.resize(s.velocity.size(), 0.0);
    for (std::size_t k = 0; k < out.size(); ++k) {
      const double y = std::fabs(s.velocity[k]) / d.max_speed;
      const double curve = d.knee > 0.0 ? y * (1.0 + d.knee) / (y + d.knee) : std::pow(y, d.exponent);
      out[k] -= std::copysign(d.at_max_speed * curve, s.velocity[k]);
    }
  }
  return out;
}

/// What the viscous coefficient has more, as a share.
Signal WithTemperature(const StatedExtras& x, const Signals& s) {
  Signal out;
  if (x.viscous_rate_1_K == 0.0) return out;
  for (const double T : s.temperature_K)
    out.push_back(x.viscous_rate_1_K * (T + s.mean_degC - x.reference_degC));
  return out;
}

Signal WithDirection(const StatedExtras& x, const Signals& s) {
  Signal out;
  if (x.viscous_difference_rel == 0.0) return out;
  for (const double w : s.velocity)
    out.push_back(w == 0.0 ? 0.0 : std::copysign(0.5 * x.viscous_difference_rel, w));
  return out;
}

}  // namespace

void AddExtras(const StatedExtras& x, const Signals& s, AxisModel& m) {
  const auto sum = [](double a, double b) { return a + b; };
  const auto both = [](double a, double b) { return (1.0 + a) * (1.0 + b) - 1.0; };
  Signal on_motor = Along(x.cogging, s), on_load = Along(x.spring, s);
  Signal& carries = m.two_inertia && m.friction_on_load ? on_load : on_motor;
  carries = Joined(carries, Along(x.drag, s), sum);
  m.motor_force = Share(std::move(on_motor));
  m.load_force = Share(std::move(on_load));
  m.level = Share(Joined(Joined(Along(x.friction_rel, s), Along(x.friction_ripple, s), both),
                         Along(x.ball_ripple, s), both));
  m.scale_error_m = Share(Joined(Along(x.pitch_error_m, s), AtRows(x.wobble_m, s), sum));
  m.viscous = Share(Joined(WithTemperature(x, s), WithDirection(x, s), sum));
}

}  // namespace contour::diagnosis
