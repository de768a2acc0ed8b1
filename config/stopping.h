#pragma once

#include <string>
#include <vector>

#include "config/machine_config.h"

// How long an axis needs to stand still, and how far it goes, for every way in which the machine stops.
// Bounds from the machine file alone: contour check prints them, and refuses a machine whose drives would
// notice a dead master too late.
namespace contour {

struct StopBound {
  double time_s = 0.0;     ///< from the event to standstill; where the drives go off, to no torque
  double travel_mm = 0.0;  ///< on the way
};

/// What the arithmetic needs of an axis, table side.
struct StoppingAxis {
  double speed_m_s = 0.0;  ///< highest speed at which an axis can be when something happens
  double path_acceleration_m_s2 = 0.0;
  double path_jerk_m_s3 = 0.0;
  double following_error_mm = 0.0;  ///< by which the axis may be away from the path
  /// Torque limit over effective mass, with what the model says pushes besides friction, as far as friction
  /// does not bear it: along with the torque, and against it. Friction that helps is left out.
  double torque_acceleration_m_s2 = 0.0;
  double braking_m_s2 = 0.0;
  double ramp_m_s2 = 0.0;  ///< the drive's quick-stop ramp
  double notice_s = 0.0;   ///< until the drive notices that the master is silent
  double period_s = 0.0;

  /// By which it stops: the ramp, or what the torque limit can do of it; 0 where nothing stops it.
  [[nodiscard]] double Deceleration_m_s2() const;
};
StoppingAxis ToStoppingAxis(const MachineConfig& config, const AxisConfig& axis);

/// A drive's velocity loop follows its ramp some time behind it.
inline constexpr double kRampFollowing_s = 0.003;

/// From a ramp's end to no torque: the last oscillation of the screw fades, the drive sees standstill and
/// leaves its state.
inline constexpr double kSwitchOff_s = 0.040;

/// The axis keeps `speed` for `delay_s`, then the drive's quick-stop ramp, or what the torque limit can do of
/// it, brings it to rest: x = v t + v^2 / (2 d) + v t_following; torque is off after t + v / d + t_off.
StopBound QuickStop(const StoppingAxis& axis, double speed_m_s, double delay_s);

/// Drives count their watchdogs in steps of a millisecond.
inline constexpr double kWatchdogStep_s = 0.001;

/// The master falls silent: a drive in torque mode holds its last torque, at worst the limit, until its
/// watchdog runs out, `notice` and a step of it after the last frame; then its quick-stop ramp: v1 = v + a t,
/// x = v t + a t^2 / 2 + v1^2 / (2 d) + v1 t_following, with a = T_limit / (R m).
StopBound SilentMaster(const StoppingAxis& axis, double speed_m_s);

/// One way of stopping, all axes (in the order of their numbers).
struct StopWay {
  std::string name;
  std::string how;  ///< what happens, in a few words
  std::vector<StopBound> axes;
};
std::vector<StopWay> StopWays(const MachineConfig& config);

}  // namespace contour
