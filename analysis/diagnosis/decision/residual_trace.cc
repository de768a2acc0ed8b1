#include "analysis/diagnosis/decision/residual_trace.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/waves.h"
#include "analysis/diagnosis/tuning/decision_tuning.h"

namespace contour::diagnosis {
Signal TorqueResidualFrom(const Problem& problem, const Point& point, const std::vector<double>& raw) {
  const AxisModel m = problem.Build(point);
  const ObserverGain& gain = m.two_inertia ? problem.setup.gain_two : problem.setup.gain;
  const double inertia = m.motor_inertia + (m.two_inertia ? m.load_inertia : 0.0);
  const double T = problem.log.period_s;
  const std::size_t n = problem.rows();
  Signal r(n, 0.0);
  for (std::size_t k = 0; k + 1 < n; ++k)
    if (problem.counted[k] != 0 && problem.counted[k + 1] != 0)
      r[k] = -inertia * (gain[1] * raw[k] / T + gain[0] * (raw[k + 1] - raw[k]) / (T * T));
  return Smooth(r, ResidualSmoothing(T));
}

Signal TorqueResidual(const Problem& problem, const Point& point) {
  return TorqueResidualFrom(problem, point, problem.Raw(std::span(&point, 1))[0]);
}

Traces MakeTraces(const Problem& problem, const Fit& before, const Fit& after) {
  Traces t;
  const std::size_t n = problem.rows();
  const Signals& s = *problem.signals;
  t.residual_before = TorqueResidualFrom(problem, before.point, before.raw);
  t.residual_after = TorqueResidualFrom(problem, after.point, after.raw);
  const AxisModel m = problem.Build(after.point);
  const Delivered delivered =
      DeliveredMeans(problem.log, m.delay_s - m.lag_for_delay_s, m.lag_s + m.lag_for_delay_s, 1);
  t.measured = Smooth(delivered.mean, ResidualSmoothing(problem.log.period_s));
  t.position = s.position;
  t.velocity = s.velocity;
  t.acceleration = s.acceleration;
  t.temperature_degC = problem.log.temperature_degC;
  t.time_s.resize(n);
  t.simulated_before.resize(n);
  t.simulated_after.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    t.time_s[k] = static_cast<double>(k) * problem.log.period_s;
    t.simulated_before[k] = t.measured[k] - t.residual_before[k];
    t.simulated_after[k] = t.measured[k] - t.residual_after[k];
  }
  if (problem.has_scale()) {
    t.scale_before.assign(before.raw.begin() + static_cast<std::ptrdiff_t>(n), before.raw.end());
    t.scale_after.assign(after.raw.begin() + static_cast<std::ptrdiff_t>(n), after.raw.end());
  }
  return t;
}

bool FasterThanTheTorque(const Problem& problem, const Effect& effect) {
  const CauseDefinition& cause = CauseNamed(effect.kind);
  if (!effect.wave || *cause.wave == nullptr) return false;
  double radians_per_s = effect.order;
  if ((*cause.wave)->wave == Wave::kForceOfTime) {
    radians_per_s *= 2.0 * std::numbers::pi;
  } else {
    const Signals& s = *problem.signals;
    double squares = 0.0, rows = 0.0;
    for (std::size_t k = 0; k < problem.rows(); ++k) {
      if (problem.counted[k] == 0) continue;
      squares += std::pow(s.angle_per_q * s.velocity[k], 2);
      rows += 1.0;
    }
    radians_per_s *= std::sqrt(squares / std::max(1.0, rows));
  }
  return radians_per_s * ResidualSmoothing(problem.log.period_s) * problem.log.period_s > 1.0;
}

}  // namespace contour::diagnosis
