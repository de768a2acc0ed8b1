#include "config/stopping.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "config/extended_model.h"
#include "config/stated_push.h"
#include "core/mechanics.h"
#include "core/stop_on_path.h"

namespace contour {
namespace {

double Cycles_s(const StoppingAxis& axis, double cycles) { return cycles * axis.period_s; }

// One ramp for all axes, so that the geometry is kept: the slowest axis says how long.
double PathRamp_s(const std::vector<StoppingAxis>& axes) {
  double ramp_s = 0.0;
  for (const StoppingAxis& a : axes)
    ramp_s =
        std::max(ramp_s, stop_on_path::RampTime_s(a.speed_m_s, a.path_acceleration_m_s2, a.path_jerk_m_s3));
  return ramp_s;
}

// `delay_s` on the path, then so much time at a pace that falls to rest within `on_path_s` of the path;
// `after_s` until it counts as stopped.
std::vector<StopBound> PathStop(const std::vector<StoppingAxis>& axes, double delay_s, double stop_s,
                                double on_path_s, double after_s) {
  std::vector<StopBound> bounds;
  for (const StoppingAxis& a : axes) {
    const double until_stop_s = delay_s + Cycles_s(a, 2.0);
    bounds.push_back({until_stop_s + stop_s + after_s,
                      1e3 * a.speed_m_s * (until_stop_s + on_path_s) + a.following_error_mm});
  }
  return bounds;
}

// By the ramp at once; its mean pace is a half.
std::vector<StopBound> RampStop(const std::vector<StoppingAxis>& axes, double delay_s) {
  const double ramp_s = PathRamp_s(axes);
  return PathStop(axes, delay_s, ramp_s, 0.5 * ramp_s, kSwitchOff_s);
}

// Within every axis's limits, wherever on the path: see daemon/rt/stop_search. The search begins when a
// cycle's frames have been sent.
std::vector<StopBound> StopWithinLimits(const std::vector<StoppingAxis>& axes) {
  using stop_on_path::kFarthest, stop_on_path::kLongest, stop_on_path::kSearches;
  const double ramp_s = PathRamp_s(axes);
  return PathStop(axes, axes.front().period_s + kSearches * ramp_s, kLongest * ramp_s, kFarthest * ramp_s,
                  kSwitchOff_s);
}

template <class Bound>
std::vector<StopBound> Each(const std::vector<StoppingAxis>& axes, Bound bound) {
  std::vector<StopBound> bounds;
  for (const StoppingAxis& a : axes) bounds.push_back(bound(a));
  return bounds;
}

std::string Ms(double seconds) {
  const long tenths = std::lround(seconds * 1e4);
  return std::to_string(tenths / 10) + (tenths % 10 == 0 ? "" : "." + std::to_string(tenths % 10)) + " ms";
}

// An input that opens right after a poll is seen with the next reply; a server that says nothing counts as
// open when its last answer is timeout_ms old.
std::vector<StopWay> IoStops(const ModbusConfig& modbus, const std::vector<StoppingAxis>& axes) {
  const double seen_s = 1e-3 * (modbus.poll_ms + modbus.timeout_ms);
  const double old_s = 1e-3 * modbus.timeout_ms;
  const auto quick = [&](const StoppingAxis& a) {
    return QuickStop(a, a.speed_m_s, seen_s + Cycles_s(a, 2.0));
  };
  return {
      {"emergency-stop input", "seen within " + Ms(seen_s) + ", then as a fault", Each(axes, quick)},
      {"enable-chain input",
       "seen within " + Ms(seen_s) + ", then on the path by a fixed ramp, and the drives are switched off",
       RampStop(axes, seen_s)},
      {"Modbus server silent", "counts as open after " + Ms(old_s) + ", then as the enable-chain input",
       RampStop(axes, old_s)}};
}

}  // namespace

double StoppingAxis::Deceleration_m_s2() const { return std::max(0.0, std::min(ramp_m_s2, braking_m_s2)); }

StoppingAxis ToStoppingAxis(const MachineConfig& config, const AxisConfig& axis) {
  const Mechanics m = ToSi(axis.model.mechanics);
  const AxisLimitsSi limits = ToSi(axis.limits, m.radius_m_rad);
  StoppingAxis s;
  s.speed_m_s = limits.velocity_m_s;
  s.path_acceleration_m_s2 = limits.acceleration_m_s2;
  s.path_jerk_m_s3 = limits.jerk_m_s3;
  s.following_error_mm = axis.limits.following_error_mm;
  const double unborne_N = std::max(0.0, UnbornePushOf(axis.model).sliding_N);
  const double unborne_m_s2 = unborne_N / ToSi(Extended(axis.model).mechanics).mass_kg;
  s.torque_acceleration_m_s2 = limits.force_N / m.mass_kg + unborne_m_s2;
  s.braking_m_s2 = limits.force_N / m.mass_kg - unborne_m_s2;
  s.ramp_m_s2 = axis.drive.quick_stop_deceleration_rad_s2 * m.radius_m_rad;
  s.notice_s = axis.drive.notice_ms * 1e-3;
  s.period_s = config.machine.cycle_us * 1e-6;
  return s;
}

StopBound QuickStop(const StoppingAxis& axis, double speed_m_s, double delay_s) {
  const double ramp_s = speed_m_s / axis.Deceleration_m_s2();
  const double travel_m = speed_m_s * (delay_s + 0.5 * ramp_s + kRampFollowing_s);
  return {delay_s + ramp_s + kSwitchOff_s, 1e3 * travel_m};
}

StopBound SilentMaster(const StoppingAxis& axis, double speed_m_s) {
  const double held_s = axis.notice_s + kWatchdogStep_s;
  const double reached_m_s = speed_m_s + axis.torque_acceleration_m_s2 * held_s;
  const StopBound ramp = QuickStop(axis, reached_m_s, 0.0);
  const double held_m = speed_m_s * held_s + 0.5 * axis.torque_acceleration_m_s2 * held_s * held_s;
  return {held_s + ramp.time_s, 1e3 * held_m + ramp.travel_mm};
}

std::vector<StopWay> StopWays(const MachineConfig& config) {
  std::vector<StoppingAxis> axes;
  for (const auto& [name, axis] : config.axes) axes.push_back(ToStoppingAxis(config, axis));
  const double overspeed = config.control.guard.overspeed_factor;
  const double stale = config.control.guard.stale_cycles;
  const auto silent = [](const StoppingAxis& a) { return SilentMaster(a, a.speed_m_s); };

  std::vector<StopWay> ways;
  ways.push_back(
      {"operator stop", "on the path, within the limits of acceleration and jerk", StopWithinLimits(axes)});
  ways.push_back(
      {"SIGTERM, SIGINT", "as an operator stop, then the drives are switched off", StopWithinLimits(axes)});
  ways.push_back({"fault (quick stop)", "torque 0 and the drives' quick-stop ramp in the cycle that sees it",
                  Each(axes, [&](const StoppingAxis& a) {
                    return QuickStop(a, overspeed * a.speed_m_s, Cycles_s(a, 2.0));
                  })});
  ways.push_back({"feedback lost",
                  "fault after " + std::to_string(config.control.guard.stale_cycles) +
                      " cycles without feedback; the drive gets its quick stop",
                  Each(axes, [&](const StoppingAxis& a) {
                    return QuickStop(a, a.speed_m_s + a.torque_acceleration_m_s2 * Cycles_s(a, stale + 2.0),
                                     Cycles_s(a, stale + 2.0));
                  })});
  ways.push_back(
      {"master silent (killed, hung)", "the drive notices, then its quick-stop ramp", Each(axes, silent)});
  ways.push_back(
      {"bus lost (interface down)", "as master silent; the machine is Faulted at once", Each(axes, silent)});
  if (config.io.modbus)
    for (StopWay& way : IoStops(*config.io.modbus, axes)) ways.push_back(std::move(way));
  return ways;
}

}  // namespace contour
