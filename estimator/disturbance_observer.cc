#include "estimator/disturbance_observer.h"

#include <cmath>
#include <numbers>

namespace contour {

DisturbanceObserver::DisturbanceObserver(const FilterSetup& setup) noexcept
    : setup_(setup),
      lag_(setup.period_s, setup.lag_s),
      gate_({setup.config.innovation_gate_sigma, setup.config.innovation_gate_um * 1e-6}, setup.Sudden_m()) {
  const double mass_kg = setup.mechanics.mass_kg;
  const double rate = setup.friction.sigma2_Ns_m / mass_kg;
  velocity_decay_ = Exp(-rate * setup.period_s);
  velocity_gain_ = rate > 0.0 ? -Expm1(-rate * setup.period_s) / (rate * mass_kg) : setup.period_s / mass_kg;
  const double w = 2.0 * std::numbers::pi * setup.config.disturbance_observer_bandwidth_Hz;
  noise_ = {0.0, 0.0, mass_kg * w * w * w * setup.measurement_std_m * setup.period_s};
  Reset(0.0);
}

void DisturbanceObserver::Reset(double position_m) noexcept {
  core_.x = {position_m, 0.0, 0.0};
  core_.s = {};
  core_.s[0][0] = setup_.measurement_std_m;
  core_.s[1][1] = 1e-3;
  core_.s[2][2] = 30.0;
  lag_.Reset();
  gated_in_a_row_ = 0;
  gate_.Reset();
}

void DisturbanceObserver::Propagate(X& x, double force_N) const noexcept {
  const double next = velocity_decay_ * x[1] + velocity_gain_ * (force_N - x[2]);
  x[0] += 0.5 * setup_.period_s * (x[1] + next);
  x[1] = next;
}

AxisEstimate DisturbanceObserver::Update(const AxisEstimatorInput& in) noexcept {
  AxisEstimate out;
  if (!in.enabled) {
    if (in.fresh) Reset(in.position_m);
  } else {
    const double force_N = lag_.Step(in.force_N[1])[0];
    core_.Predict(
        [&](X& x, SquareMatrix<3>& t) noexcept {
          Propagate(x, force_N);
          for (std::size_t k = 0; k < 3; ++k) {
            const double next = velocity_decay_ * t[1][k] - velocity_gain_ * t[2][k];
            t[0][k] += 0.5 * setup_.period_s * (t[1][k] + next);
            t[1][k] = next;
          }
        },
        noise_);
    if (in.fresh) {
      Innovation innovation;
      const UpdateResult result = core_.UpdateState0(in.position_m, setup_.measurement_std_m, gate_.gate(),
                                                     AllStates<3>(), innovation);
      gate_.After(innovation.value, innovation.std);
      if (result == UpdateResult::kGated) {
        out.limit = Reason::kInnovationGated;
        if (StartsAgain(++gated_in_a_row_, setup_.period_s)) Reset(in.position_m);
      } else {
        gated_in_a_row_ = 0;
      }
      out.innovation_m = innovation.value;
      out.innovation_std_m = innovation.std;
    }
  }
  const double sigma2 = setup_.friction.sigma2_Ns_m;
  X predicted = core_.x;
  Propagate(predicted, lag_.Look(in.force_N[0])[0]);
  X after = predicted;
  Propagate(after, in.force_N[0]);
  friction_ahead_N_ = core_.x[2] + sigma2 * 0.5 * (predicted[1] + after[1]);

  out.position_m = core_.x[0];
  out.velocity_m_s = core_.x[1];
  out.predicted_position_m = predicted[0];
  out.predicted_velocity_m_s = predicted[1];
  out.friction_N = core_.x[2] + sigma2 * core_.x[1];
  out.friction_std_N = core_.Std({0.0, sigma2, 1.0});
  out.disturbance_N = core_.x[2];
  out.disturbance_std_N = core_.Std({0.0, 0.0, 1.0});
  out.diverged = !square_root::Sound(core_.x, core_.s, {1.0, 100.0, 1e6});
  return out;
}

}  // namespace contour
