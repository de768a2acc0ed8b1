#include "daemon/rt/cycle_parts.h"

#include <algorithm>
#include <cmath>

#include "control/loop_bandwidth.h"

namespace contour {
namespace {

/// An emergency message waits its turn on the bus and for the drive's slow task,
constexpr std::uint32_t kOnItsWay_cycles = 20;
/// and for those before it: of a fault that was just reset, and of its end.
constexpr double kMessages = 3.0;

PerAxis<ControlledAxis> ControlledAxes(const CycleConfig& config) {
  PerAxis<ControlledAxis> axes;
  for (const CycleAxisConfig& a : config.axes) {
    const double r = a.mechanics.radius_m_rad;
    const Friction f = ToSi(a.friction, r);
    axes.push_back({a.mechanics, ToSi(a.limits, r), a.lag_s, f.sigma2_Ns_m, f.Fc_plus_N, f.Fc_minus_N,
                    0.5 * (f.Fc_plus_N + f.Fc_minus_N) / f.sigma0_N_m});
  }
  return axes;
}

}  // namespace

bool InCascade(const CycleConfig& config) noexcept {
  return !config.master.axes.empty() && config.master.axes.front().drive.mode == DriveMode::kCsp;
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
  const double loop_Hz = StiffnessBandwidth_Hz(config.control, config.controller, InCascade(config));
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
  return {cycles(3.0 * walk_ms), cycles(1000.0 * StopOnPathTime_s(config) + quick_stop_ms), cycles(5000.0),
          cycles(explain_ms) + kOnItsWay_cycles};
}

ContourController MakeController(const CycleConfig& config) {
  return {config.controller, config.control, ControlledAxes(config), config.cycle_us * 1e-6,
          InCascade(config)};
}

std::unique_ptr<ContourController> MakeFallback(const CycleConfig& config) {
  const EstimatorKind kind = EstimatorFor(config);
  if (InCascade(config) || kind == EstimatorKind::kKinematic || kind == EstimatorKind::kDisturbanceObserver)
    return nullptr;
  return std::make_unique<ContourController>(ControllerName::kMpcObserver, config.control,
                                             ControlledAxes(config), config.cycle_us * 1e-6);
}

double StopOnPathTime_s(const CycleConfig& config) {
  // The ramp's steepest slope is 1.5 / T, its sharpest bend 6 / T^2: an axis at its highest speed then just
  // keeps its limits of acceleration and jerk.
  double time_s = 0.0;
  for (const CycleAxisConfig& a : config.axes) {
    const AxisLimits& l = a.limits;
    time_s = std::max({time_s, 1.5 * l.velocity_mm_s / l.acceleration_mm_s2,
                       std::sqrt(6.0 * l.velocity_mm_s / l.jerk_mm_s3)});
  }
  return time_s;
}

}  // namespace contour
