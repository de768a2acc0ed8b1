#include "daemon/rt/cycle_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "control/loop_bandwidth.h"
#include "core/stop_on_path.h"
#include "core/two_inertia_axis.h"
#include "core/two_inertia_loop.h"

namespace contour {
namespace {

/// An emergency message waits its turn on the bus and for the drive's slow task,
constexpr std::uint32_t kOnItsWay_cycles = 20;
/// and for those before it: of a fault that was just reset, and of its end.
constexpr double kMessages = 3.0;

// In a cascade the observer only watches: fast enough to see what friction does, slow enough for the noise of
// a reported torque. No machine's own number is in it.
constexpr LoopTuning kWatching{.regulator_Hz = 20.0,
                               .windup_weight = 0.3,
                               .velocity_weight = 0.2,
                               .disturbance_Hz = 60.0,
                               .motor_force_Hz = 150.0,
                               .table_force_Hz = 100.0,
                               .notch_ratio = 1.0,
                               .notch_pole_damping = 0.5,
                               .notch_zero_damping = 0.5};

TwoInertiaAxis AxisOfLoop(const CycleConfig& config, std::size_t axis) {
  TwoInertiaAxis two = config.axes[axis].two_inertia;
  if (!InCascade(config)) return two;
  // The torque that a drive reports is what it gave over the period that has passed.
  two.lag_s = two.dead_time_s = 0.0;
  two.delay_cycles = 0;
  return two;
}

bool LoopTakesScale(const CycleConfig& config, std::size_t axis) {
  return !InCascade(config) && config.axes[axis].has_scale && config.axes[axis].scale_loop;
}

/// Of an axis whose loop takes its scale.
TwoInertiaLoop ScaleLoopOf(const CycleConfig& config, std::size_t axis, double softer) {
  LoopTuning tuning = *config.axes[axis].scale_loop;
  tuning.regulator_Hz *= softer;
  return DesignLoop(AxisOfLoop(config, axis), tuning, config.cycle_us * 1e-6, true);
}

TwoInertiaLoop LoopOf(const CycleConfig& config, std::size_t axis, double softer) {
  const double period_s = config.cycle_us * 1e-6;
  const TwoInertiaAxis two = AxisOfLoop(config, axis);
  if (InCascade(config)) return DesignLoop(two, kWatching, period_s, false);
  if (!config.axes[axis].loop)
    throw std::invalid_argument("axis " + config.axes[axis].name +
                                ": control.friction: linear in torque mode needs its loop: tuning "
                                "(contour tune --from-model writes it)");
  LoopTuning tuning = *config.axes[axis].loop;
  tuning.regulator_Hz *= softer;
  return DesignLoop(two, tuning, period_s, false);
}

StandstillBounds StandstillOf(const CycleConfig& config, std::size_t axis) {
  const CycleAxisConfig& a = config.axes[axis];
  const double r = a.mechanics.radius_m_rad;
  const Friction f = ToSi(a.friction, r);
  return BoundsOf({.mass_kg = a.mechanics.mass_kg,
                   .step_N = kTorqueStep * config.master.axes[axis].drive.rated_torque_Nm / r,
                   .friction_N = std::min(f.Fc_plus_N, f.Fc_minus_N),
                   .stiffness_N_m = LoopTakesScale(config, axis) ? 0.0 : a.two_inertia.stiffness_N_m,
                   .sigma0_N_m = f.sigma0_N_m,
                   .sigma1_Ns_m = f.sigma1_Ns_m,
                   .regulator_Hz = KnowsTwoInertias(config) ? a.loop->regulator_Hz : DesignedLoop_Hz(config)},
                  2.0 * std::numbers::pi * r / a.encoder_counts_per_rev, config.cycle_us * 1e-6);
}

PerAxis<ControlledAxis> ControlledAxes(const CycleConfig& config) {
  PerAxis<ControlledAxis> axes;
  for (std::size_t i = 0; i < config.axes.size(); ++i) {
    const CycleAxisConfig& a = config.axes[i];
    const double r = a.mechanics.radius_m_rad;
    const Friction f = ToSi(a.friction, r);
    ControlledAxis axis{a.mechanics,
                        ToSi(a.limits, r),
                        a.lag_s,
                        f.sigma2_Ns_m,
                        f.Fc_plus_N,
                        f.Fc_minus_N,
                        0.5 * (f.Fc_plus_N + f.Fc_minus_N) / f.sigma0_N_m};
    axis.acceleration_share = config.master.axes[i].drive.csp_acceleration_share;
    if (KnowsTwoInertias(config) && !InCascade(config)) {
      axis.lag_s = a.two_inertia.lag_s;
      axis.loop = LoopOf(config, i, 1.0);
      axis.softer_loop = LoopOf(config, i, config.control.supervision.softer);
      axis.regulator_Hz = a.loop->regulator_Hz;
      if (LoopTakesScale(config, i)) {
        axis.scale_loop = ScaleLoopOf(config, i, 1.0);
        axis.softer_scale_loop = ScaleLoopOf(config, i, config.control.supervision.softer);
      }
    }
    // By either law of friction; rivals are as they are sold.
    if (config.controller == ControllerName::kFull && !InCascade(config))
      axis.standstill = StandstillOf(config, i);
    axes.push_back(axis);
  }
  return axes;
}

}  // namespace

bool InCascade(const CycleConfig& config) noexcept {
  return !config.master.axes.empty() && config.master.axes.front().drive.mode == DriveMode::kCsp;
}

bool KnowsTwoInertias(const CycleConfig& config) noexcept {
  return KnowsTwoInertias(config.controller, config.control.friction);
}

double DesignedLoop_Hz(const CycleConfig& config) noexcept {
  if (!KnowsTwoInertias(config) || InCascade(config))
    return LoopBandwidth_Hz(config.control, config.controller);
  double least_Hz = std::numeric_limits<double>::infinity();
  for (const CycleAxisConfig& a : config.axes)
    if (a.loop) least_Hz = std::min(least_Hz, a.loop->regulator_Hz);
  return least_Hz;
}

double StiffnessLoop_Hz(const CycleConfig& config) noexcept {
  if (KnowsTwoInertias(config) && !InCascade(config)) return DesignedLoop_Hz(config);
  return StiffnessBandwidth_Hz(config.control, config.controller, InCascade(config));
}

AxisEstimator MakeEstimator(const CycleConfig& config, std::size_t axis) {
  const CycleAxisConfig& a = config.axes[axis];
  const double period_s = config.cycle_us * 1e-6;
  const double count_m = 2.0 * std::numbers::pi * a.mechanics.radius_m_rad / a.encoder_counts_per_rev;
  const EstimatorKind kind = EstimatorFor(config);
  if (kind != EstimatorKind::kTwoInertia)
    return {kind, a.mechanics, a.friction, a.estimator, period_s, a.lag_s, count_m, a.known};
  TwoInertiaEstimator::Setup setup;
  setup.axis = AxisOfLoop(config, axis);
  setup.filter =
      AxisEstimator::SetupOf(a.mechanics, a.friction, a.estimator, period_s, setup.axis.lag_s, count_m);
  setup.filter.reported_torque = InCascade(config);
  setup.loop = LoopOf(config, axis, 1.0);
  setup.position_min_m = 1e-3 * a.limits.position_mm[0];
  setup.position_max_m = 1e-3 * a.limits.position_mm[1];
  setup.known = a.known;
  setup.side_modes = a.side_modes;
  setup.acceleration_m_s2 = 1e-3 * a.limits.acceleration_mm_s2;
  setup.sample_jitter_s =
      kLongestFrame_bits / config.master.buses[config.master.axes[axis].bus].bitrate_bit_s;
  setup.has_scale = a.has_scale;
  const auto& scale = config.master.axes[axis].drive.linear_scale;
  if (a.has_scale && scale) setup.scale_count_m = 1e-3 / scale->counts_per_mm;
  setup.external_force_N =
      ExternalForce_N(ToSi(a.limits, a.mechanics.radius_m_rad),
                      config.master.axes[axis].drive.rated_torque_Nm / a.mechanics.radius_m_rad);
  if (LoopTakesScale(config, axis)) setup.scale_loop = ScaleLoopOf(config, axis, 1.0);
  return AxisEstimator(setup);
}

AxisEstimator MakeObserver(const CycleConfig& config, std::size_t axis) {
  const CycleAxisConfig& a = config.axes[axis];
  return {EstimatorKind::kDisturbanceObserver,
          a.mechanics,
          a.friction,
          a.estimator,
          config.cycle_us * 1e-6,
          a.lag_s,
          2.0 * std::numbers::pi * a.mechanics.radius_m_rad / a.encoder_counts_per_rev};
}

EstimatorKind EstimatorFor(const CycleConfig& config) noexcept {
  switch (config.controller) {
    case ControllerName::kPid:
    case ControllerName::kCsp:
    case ControllerName::kCnc:
    case ControllerName::kMpc:
      return EstimatorKind::kKinematic;
    case ControllerName::kMpcObserver:
      return EstimatorKind::kDisturbanceObserver;
    case ControllerName::kMpcSrukf4:
      return EstimatorKind::kSrukf4;
    case ControllerName::kMpcEkf7:
      return EstimatorKind::kEkf7;
    case ControllerName::kMpcSrukf7:
      return EstimatorKind::kSrukf7;
    case ControllerName::kFull:
      break;
  }
  if (KnowsTwoInertias(config)) return EstimatorKind::kTwoInertia;
  return InCascade(config) ? EstimatorKind::kFullInCascade : EstimatorKind::kFull;
}

PerAxis<GuardedAxis> GuardedAxes(const CycleConfig& config) {
  PerAxis<GuardedAxis> axes;
  for (const CycleAxisConfig& a : config.axes)
    axes.push_back({ToSi(a.limits, a.mechanics.radius_m_rad), a.mechanics.radius_m_rad});
  return axes;
}

PerAxis<MonitoredAxis> MonitoredAxes(const CycleConfig& config) {
  PerAxis<MonitoredAxis> axes;
  const double loop_Hz = StiffnessLoop_Hz(config);
  for (std::size_t i = 0; i < config.axes.size(); ++i) {
    const CycleAxisConfig& a = config.axes[i];
    const DriveConfig& d = config.master.axes[i].drive;
    const Friction f = ToSi(a.friction, a.mechanics.radius_m_rad);
    const MonitoredDrive drive{
        d.rated_torque_Nm, a.encoder_counts_per_rev, static_cast<std::uint32_t>(d.delay_cycles),
        config.master.buses[config.master.axes[i].bus].bitrate_bit_s, InCascade(config)};
    axes.push_back(
        ToMonitored(a.mechanics, ToMonitored(f), drive, ToSi(a.limits, a.mechanics.radius_m_rad), loop_Hz));
  }
  return axes;
}

Transitions::Config TransitionTimes(const CycleConfig& config) {
  const auto cycles = [&](double ms) { return static_cast<std::uint32_t>(ms * 1e3 / config.cycle_us) + 1; };
  double walk_ms = 0.0;
  double quick_stop_ms = 0.0;
  double explain_ms = 0.0;
  for (const AxisDriveConfig& a : config.master.axes) {
    walk_ms = std::max(walk_ms, a.drive.transition_ms);
    quick_stop_ms = std::max(quick_stop_ms, a.drive.quick_stop_ms);
    explain_ms = std::max(explain_ms, a.drive.notice_ms + kMessages * a.drive.emergency_inhibit_ms);
  }
  // From Switch On Disabled to Operation Enabled there are three transitions.
  const double stop_ms = 1e3 * (stop_on_path::kSearches + stop_on_path::kLongest) * StopOnPathTime_s(config);
  return {cycles(3.0 * walk_ms), cycles(stop_ms + quick_stop_ms), cycles(5000.0),
          cycles(explain_ms) + kOnItsWay_cycles};
}

ContourController MakeController(const CycleConfig& config) {
  return {config.controller, config.control, ControlledAxes(config), config.cycle_us * 1e-6,
          InCascade(config)};
}

std::unique_ptr<ContourController> MakeFallback(const CycleConfig& config) {
  const EstimatorKind kind = EstimatorFor(config);
  // What it would fall back to knows one inertia and is no more stable; its own softened loop is.
  if (InCascade(config) || KnowsTwoInertias(config) || kind == EstimatorKind::kKinematic ||
      kind == EstimatorKind::kDisturbanceObserver)
    return nullptr;
  return std::make_unique<ContourController>(ControllerName::kMpcObserver, config.control,
                                             ControlledAxes(config), config.cycle_us * 1e-6);
}

double StopOnPathTime_s(const CycleConfig& config) {
  double time_s = 0.0;
  for (const CycleAxisConfig& a : config.axes) {
    const AxisLimits& l = a.limits;
    time_s = std::max(time_s, stop_on_path::RampTime_s(l.velocity_mm_s, l.acceleration_mm_s2, l.jerk_mm_s3));
  }
  return time_s;
}

}  // namespace contour
