#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "control/contour_controller.h"
#include "tests/estimator/two_inertia_axes.h"

namespace contour::test {

constexpr double kPeriod_s = 1e-3;

/// A linear scale, and the loop that goes by it.
struct ScaledLoop {
  LoopTuning tuning;
  double step_m = 5e-9;
};

/// Estimator and law of one axis around two inertias with friction of their own, in the timing of the cycle.
class Machine {
 public:
  /// `dead_s`: of the drive; the model knows it.
  Machine(const FamilyAxis& member, const ModelError& error, double dead_s = 0.0,
          const std::optional<ScaledLoop>& scale = {})
      : axis(Truth(member)),
        setup_(SetupOf(member, error, dead_s, scale)),
        scale_step_m_(scale ? scale->step_m : 0.0),
        estimator_(setup_),
        controller_(Controller(member, setup_)),
        step_N_(1e-3 * member.rated_N),
        dead_s_(dead_s) {
    input_.estimate.resize(1);
    input_.reference.resize(1);
    input_.friction.resize(1);
    input_.previous_force_N.push_back(0.0);
    estimator_.Reset(0.0);
    controller_.Reset();
  }

  /// Returns by how much the table is off at the end of the period, m.
  template <class Reference>
  double Step(Reference&& reference) {
    const double t = kPeriod_s * static_cast<double>(cycle_);
    AxisHorizon h;
    for (std::size_t j = 0; j < controller_.horizon_points(); ++j)
      h.push_back(reference(t + kPeriod_s * (static_cast<double>(j) - 1.0)));
    AxisEstimatorInput in;
    in.position_m = measured_m_;
    in.fresh = true;
    if (scale_step_m_ > 0.0) {
      in.scale_m = scale_m_;
      in.scale_fresh = !tamper || tamper(in.scale_m);
    }
    in.force_N = past_N_;
    in.at_rest = h[0].velocity_m_s == 0.0;
    in.enabled = cycle_ > 0;
    input_.estimate[0] = estimator_.Update(in);
    input_.reference[0] = h;
    input_.previous_force_N[0] = past_N_[0];
    estimator_.PreviewFriction(h, controller_.friction_points(), input_.friction[0]);
    controller_.Step(input_, output_);
    estimate = input_.estimate[0];
    measured_m_ = encoder_.Read(axis.s.motor_m);
    if (scale_step_m_ > 0.0)
      scale_m_ = kScaleZero_m + std::round(axis.s.table_m / scale_step_m_) * scale_step_m_;
    const double force_N = std::round(output_.force_N[0] / step_N_) * step_N_;
    if (dead_s_ > 0.0) axis.Step(past_N_[0], dead_s_);
    axis.Step(force_N, kPeriod_s - dead_s_);
    past_N_ = {force_N, past_N_[0], past_N_[1]};
    ++cycle_;
    return axis.s.table_m - reference(t + kPeriod_s).position_m;
  }

  /// The law alone, without scale.
  static std::unique_ptr<ContourController> ControllerFor(const FamilyAxis& member) {
    return std::make_unique<ContourController>(Controller(member, SetupOf(member, {}, 0.0, {})));
  }

  ScrewAxis axis;
  AxisEstimate estimate;
  /// What becomes of the scale's reading; false: it does not come.
  std::function<bool(double&)> tamper;

 private:
  static constexpr double kScaleZero_m = 0.4;
  static TwoInertiaEstimator::Setup SetupOf(const FamilyAxis& member, const ModelError& error, double dead_s,
                                            const std::optional<ScaledLoop>& scale) {
    TwoInertiaEstimator::Setup s = EstimatorOf(member, kPeriod_s, error);
    s.axis.dead_time_s = dead_s;
    s.loop = DesignLoop(s.axis, kSteadyTuning, kPeriod_s, false);
    s.has_scale = scale.has_value();
    if (scale) s.scale_loop = DesignLoop(s.axis, scale->tuning, kPeriod_s, true);
    return s;
  }
  static ContourController Controller(const FamilyAxis& member, const TwoInertiaEstimator::Setup& setup) {
    ControllerConfig config;
    config.friction = FrictionKind::kLinear;
    config.planner.enabled = false;
    ControlledAxis a;
    a.mechanics = setup.filter.mechanics;
    a.lag_s = setup.filter.lag_s;
    a.limits.force_N = 2.0 * member.rated_N;
    a.viscous_Ns_m = setup.filter.friction.sigma2_Ns_m;
    a.loop = a.softer_loop = setup.loop;
    a.scale_loop = a.softer_scale_loop = setup.scale_loop;
    a.regulator_Hz = kSteadyTuning.regulator_Hz;
    a.standstill = {1e-3 * member.rated_N, 1e-3 * member.rated_N / setup.filter.friction.sigma0_N_m, 0.0,
                    kPeriod_s};
    PerAxis<ControlledAxis> axes;
    axes.push_back(a);
    return {ControllerName::kFull, config, axes, kPeriod_s};
  }

  TwoInertiaEstimator::Setup setup_;
  double scale_step_m_;
  AxisEstimator estimator_;
  ContourController controller_;
  Encoder encoder_;
  ControlInput input_;
  ControlOutput output_;
  double step_N_;
  double dead_s_;
  double measured_m_ = 0.0;
  double scale_m_ = kScaleZero_m;
  std::array<double, 3> past_N_{};
  long cycle_ = 0;
};

struct Result {
  double peak_m = 0.0;   ///< after the first turn, a constant delay taken out
  double swing_m = 0.0;  ///< peak to peak over the last 3 of 6 s of rest
};

inline Result Draw(const FamilyAxis& member, const ModelError& error, double amplitude_m, double frequency_Hz,
                   double dead_s = 0.0, const std::optional<ScaledLoop>& scale = {}) {
  Machine machine(member, error, dead_s, scale);
  const double turns_end_s = 0.45 + 3.0 / frequency_Hz;
  const SmoothSine sine{amplitude_m, frequency_Hz, 0.2, turns_end_s};
  const auto cycles = [](double s) { return static_cast<long>(s / kPeriod_s); };
  std::vector<double> error_m, velocity_m_s;
  for (long k = 0; k < cycles(turns_end_s) - 2; ++k) {
    const double e = machine.Step(sine);
    if (k < cycles(0.7 + 1.0 / frequency_Hz)) continue;
    error_m.push_back(e);
    velocity_m_s.push_back(sine(kPeriod_s * static_cast<double>(k + 1)).velocity_m_s);
  }
  double ev = 0.0, vv = 0.0;
  for (std::size_t i = 0; i < error_m.size(); ++i) {
    ev += error_m[i] * velocity_m_s[i];
    vv += velocity_m_s[i] * velocity_m_s[i];
  }
  Result r;
  for (std::size_t i = 0; i < error_m.size(); ++i)
    r.peak_m = std::max(r.peak_m, std::abs(error_m[i] - ev / vv * velocity_m_s[i]));
  double low = 1.0, high = -1.0;
  for (long k = 0; k < cycles(6.0); ++k) {
    const double e = machine.Step(sine);
    if (k < cycles(3.0)) continue;
    low = std::min(low, e);
    high = std::max(high, e);
  }
  r.swing_m = high - low;
  return r;
}

}  // namespace contour::test
