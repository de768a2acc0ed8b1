#include "config/push_advice.h"

#include "config/number_text.h"
#include "config/stated_push.h"
#include "config/stopping.h"
#include "control/monitored_axis.h"
#include "core/mechanics.h"

namespace contour {
namespace {

std::string Say(double number) { return RoundedText(number); }

// The monitor of motion against torque takes a weight for a force from outside.
std::string ForceFromOutside(const AxisConfig& axis, double pushed_N, double radius_m_rad) {
  const double allowed_N =
      ExternalForce_N(ToSi(axis.limits, radius_m_rad), axis.drive.rated_torque_Nm / radius_m_rad);
  if (pushed_N <= allowed_N) return {};
  return ".limits.external_force_N: " +
         (axis.limits.external_force_N > 0.0
              ? "found " + Say(allowed_N)
              : "missing, which is a quarter of rated force, " + Say(allowed_N)) +
         ", less than the " + Say(pushed_N) +
         " N; expected more, with what cuts besides: an axis that is pushed by more looks as if its encoder "
         "or its torque lied, and is switched off";
}

std::string Ramp(const MachineConfig& machine, const AxisConfig& axis, double radius_m_rad) {
  const StoppingAxis s = ToStoppingAxis(machine, axis);
  if (s.ramp_m_s2 <= s.braking_m_s2) return {};
  return ".drive.quick_stop_deceleration_rad_s2: found " + Say(axis.drive.quick_stop_deceleration_rad_s2) +
         ", but with them the torque limit of " + Say(axis.limits.torque_Nm) + " Nm gives " +
         Say(s.braking_m_s2 / radius_m_rad) +
         ": where they push along, the drive cannot follow its ramp, and stops later; the bounds count that";
}

// Friction that holds at rest takes its share.
std::string Holding(const AxisConfig& axis, double radius_m_rad) {
  const double held_Nm = radius_m_rad * UnbornePushOf(axis.model).at_rest_N;
  if (held_Nm <= axis.drive.rated_torque_Nm) return {};
  return ".drive.rated_torque_Nm: found " + Say(axis.drive.rated_torque_Nm) + ", but to hold them takes " +
         Say(held_Nm) + " Nm at rest, beyond friction: no drive gives that for long";
}

}  // namespace

std::vector<std::string> PushAdvice(const MachineConfig& machine) {
  std::vector<std::string> advice;
  for (const auto& [name, axis] : machine.axes) {
    const double pushed_N = StatedPushOf(axis.model).size_N();
    if (pushed_N <= 0.0) continue;
    const double radius_m_rad = ToSi(axis.model.mechanics).radius_m_rad;
    for (const std::string& text : {ForceFromOutside(axis, pushed_N, radius_m_rad),
                                    Ramp(machine, axis, radius_m_rad), Holding(axis, radius_m_rad)})
      if (!text.empty())
        advice.push_back("model.extensions (constant_torque, cable_spring) of axis " + name + " states " +
                         Say(pushed_N) + " N that push the table besides friction. axes." + name + text);
  }
  return advice;
}

}  // namespace contour
