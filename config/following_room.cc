#include "config/following_room.h"

#include <algorithm>
#include <cmath>

#include "config/extended_model.h"
#include "config/number_text.h"
#include "control/monitored_axis.h"
#include "core/mechanics.h"
#include "drivers/cia402/mode_for.h"

namespace contour {
namespace {

/// To three digits: what is printed leaves the room that it promises.
double RoundedUp(double x) {
  const double step = std::pow(10.0, std::floor(std::log10(x)) - 2.0);
  return step * std::ceil(x / step * (1.0 - 1e-12));
}

}  // namespace

FollowingRoom FollowingRoomOf(const MachineConfig& machine, const AxisConfig& axis) {
  const ExtendedModel model = Extended(axis.model);
  const Mechanics m = ToSi(model.mechanics);
  const MonitoredFriction friction = ToMonitored(ToSi(model.friction, m.radius_m_rad));
  const double pushed_N =
      ExternalForce_N(ToSi(axis.limits, m.radius_m_rad), axis.drive.rated_torque_Nm / m.radius_m_rad);
  const double table_N = m.table_mass_kg * 1e-3 * axis.limits.acceleration_mm_s2;
  FollowingRoom room;
  room.wound_mm = 1e3 * (friction.Fs_N + pushed_N + table_N) / m.stiffness_N_m;
  const double cycle_s = 1e-6 * machine.machine.cycle_us;
  room.late_mm = cycle_s * axis.limits.velocity_mm_s;
  room.feed_mm_s = std::max(axis.limits.following_error_mm - room.wound_mm, 0.0) / cycle_s;
  room.expected_mm = room.wound_mm + room.late_mm;
  return room;
}

std::vector<std::string> FollowingAdvice(const MachineConfig& machine) {
  std::vector<std::string> advice;
  for (const auto& [name, axis] : machine.axes) {
    if (ModeFor(machine.machine.controller, axis.drive) != DriveMode::kCsp) continue;
    const FollowingRoom room = FollowingRoomOf(machine, axis);
    if (room.feed_mm_s >= axis.limits.velocity_mm_s) continue;
    advice.push_back(
        "axes." + name + ".limits.following_error_mm: found " + RoundedText(axis.limits.following_error_mm) +
        ", but the motor of a sound axis may lead its table by " + RoundedText(room.wound_mm) +
        " mm of wind-up (friction, what may push and acceleration, over the screw's stiffness), and a drive "
        "that answers one cycle later than drive.delay_cycles states is behind by " +
        RoundedText(room.late_mm) + " mm at velocity_mm_s: it may be stopped above " +
        RoundedText(room.feed_mm_s) + " mm/s, " + RoundedText(RoundedUp(room.expected_mm)) +
        " mm leave room for both");
  }
  return advice;
}

}  // namespace contour
