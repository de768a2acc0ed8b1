#include "design/commission_plan.h"

#include <algorithm>
#include <cmath>

#include "analysis/text/format_text.h"
#include "config/config_error.h"
#include "config/machine_checks.h"
#include "design/commission_motions.h"

namespace contour {
namespace {

constexpr double kShareOfStroke = 0.1;
constexpr double kTravel_mm = 20.0;
constexpr double kShareOfSpeed = 0.4;
constexpr double kSpeed_mm_s = 100.0;
constexpr double kShareOfTorque = 0.6;
/// Two turns of the motor to average over, one at the least.
constexpr double kFewestTurns = 1.0;
/// The least top speed of the strokes; of a lead of 10 mm both are the same.
constexpr double kSlowestTop_mm_s = 20.0, kSlowestTop_turns_s = 2.0;
/// What the model may be wrong by.
constexpr double kDoubt = 1.5;

void Require(bool good, const std::string& message) {
  if (!good) throw ConfigError({message});
}

/// A fine lead, or a slow axis, has no more.
double SlowestTop_mm_s(const AxisConfig& axis) {
  return std::min(
      {kSlowestTop_mm_s, kSlowestTop_turns_s * axis.model.mechanics.lead_mm, axis.limits.velocity_mm_s});
}

void CheckLimits(const std::string& name, const AxisConfig& axis, const CommissionLimits& limits) {
  const AxisLimits& l = axis.limits;
  const double lead_mm = axis.model.mechanics.lead_mm;
  const double travel = limits.travel_mm;
  Require(
      travel > 0.0 && travel <= l.position_mm[1] - l.position_mm[0],
      FormatText(
          "--travel_mm: found %g, expected more than 0 and at most the %g mm of axes.%s.limits.position_mm",
          travel, l.position_mm[1] - l.position_mm[0], name.c_str()));
  Require(travel >= kFewestTurns * lead_mm,
          FormatText("--travel_mm: found %g, expected a whole turn of the motor "
                     "at least (%g mm): friction varies with it",
                     travel, lead_mm));
  const double slowest_mm_s = SlowestTop_mm_s(axis);
  Require(limits.max_speed_mm_s >= slowest_mm_s && limits.max_speed_mm_s <= l.velocity_mm_s,
          FormatText("--max_speed_mm_s: found %g, expected %g to %g (axes.%s.limits.velocity_mm_s)",
                     limits.max_speed_mm_s, slowest_mm_s, l.velocity_mm_s, name.c_str()));
  Require(
      limits.max_torque_Nm > 0.0 && limits.max_torque_Nm <= l.torque_Nm,
      FormatText("--max_torque_Nm: found %g, expected more than 0 and at most %g (axes.%s.limits.torque_Nm)",
                 limits.max_torque_Nm, l.torque_Nm, name.c_str()));
}

/// Of the ramps and the chirp, should the model be wrong by kDoubt.
double LargestTorque_Nm(const AxisConfig& axis, const CommissionLimits& limits) {
  const Mechanics m = ToSi(axis.model.mechanics);
  const Friction f = ToSi(axis.model.friction, m.radius_m_rad);
  const double friction_N = std::max({f.Fs_plus_N, f.Fs_minus_N, f.Fc_plus_N, f.Fc_minus_N});
  const double moving_N = std::max(
      friction_N, std::max(f.Fc_plus_N, f.Fc_minus_N) + f.sigma2_Ns_m * limits.max_speed_mm_s * 1e-3);
  const double ramp_N = m.mass_kg * axis.limits.acceleration_mm_s2 * 1e-3;
  return m.radius_m_rad * kDoubt * std::max(ramp_N + moving_N, CommissionShaking_N(axis) + friction_N);
}

}  // namespace

CommissionLimits DefaultCommissionLimits(const AxisConfig& axis) {
  const AxisLimits& l = axis.limits;
  const double stroke_mm = l.position_mm[1] - l.position_mm[0];
  // A steep screw needs more than the usual way for the turn that is asked of it.
  const double travel_mm =
      std::max(std::min(kTravel_mm, kShareOfStroke * stroke_mm), kFewestTurns * axis.model.mechanics.lead_mm);
  // A slow axis needs what it has: near the Stribeck velocity levels and slopes are hardly told apart.
  const double speed_mm_s = std::max(std::min(kSpeed_mm_s, kShareOfSpeed * l.velocity_mm_s),
                                     std::min(kSlowestTop_mm_s, l.velocity_mm_s));
  CommissionLimits limits{std::min(travel_mm, stroke_mm), speed_mm_s, kShareOfTorque * l.torque_Nm};
  // An axis with little to spare beyond its own ramps needs more of it for them.
  limits.max_torque_Nm =
      std::max(limits.max_torque_Nm, std::min(l.torque_Nm, LargestTorque_Nm(axis, limits)));
  return limits;
}

std::string MoreOfTheScrew(const AxisConfig& axis, double travel_mm) {
  const double stroke_mm = axis.limits.position_mm[1] - axis.limits.position_mm[0];
  const double longer_mm = std::min(stroke_mm, kTravel_mm);
  if (travel_mm < longer_mm)
    return FormatText(
        "commission again on a longer way, --travel_mm %g (it was %g): its strokes are quicker and bear a "
        "stronger chirp",
        longer_mm, travel_mm);
  return FormatText(
      "a larger rated torque, less friction or a way longer than %g mm would show more; without, state in "
      "the model what is known of the screw (uncertainty) and let contour tune --from-model find a loop for "
      "that",
      travel_mm);
}

CommissionPlan PlanCommissioning(const MachineConfig& machine, const std::string& name, double position_mm,
                                 const CommissionLimits& limits) {
  Require(machine.axes.contains(name), "--axis: there is no axis \"" + name + "\" in this machine");
  const AxisConfig& axis = machine.axes.at(name);
  CheckLimits(name, axis, limits);
  const AxisLimits& l = axis.limits;
  CommissionPlan plan;
  plan.axis = name;
  plan.limits = limits;
  // The small motions about the place go both ways: not nearer than this to an end.
  Require(
      position_mm - l.position_mm[0] >= kLeastCommissionStroke_mm &&
          l.position_mm[1] - position_mm >= kLeastCommissionStroke_mm,
      FormatText(
          "axis %s stands at %.3f mm: commissioning needs %g mm to either side; move it away from its end "
          "first",
          name.c_str(), position_mm, kLeastCommissionStroke_mm));
  const double travel = limits.travel_mm;
  plan.low_mm = std::clamp(position_mm - 0.5 * travel, l.position_mm[0], l.position_mm[1] - travel);
  plan.high_mm = plan.low_mm + travel;
  plan.largest_torque_Nm = LargestTorque_Nm(axis, limits);
  Require(plan.largest_torque_Nm <= limits.max_torque_Nm,
          FormatText("--max_torque_Nm: found %g, but the ramps of %g mm/s^2 may take %.3g Nm (should the "
                     "model be wrong by half): allow more%s, or lower axes.%s.limits.acceleration_mm_s2",
                     limits.max_torque_Nm, l.acceleration_mm_s2, plan.largest_torque_Nm,
                     plan.largest_torque_Nm > l.torque_Nm
                         ? FormatText(" (axes.%s.limits.torque_Nm, too)", name.c_str()).c_str()
                         : "",
                     name.c_str()));
  plan.motions = CommissionMotions(plan, axis, position_mm, machine.machine.cycle_us);
  return plan;
}

std::string Describe(const CommissionPlan& plan) {
  std::string text =
      FormatText("axis %s: between %.2f and %.2f mm, at most %g mm/s and %g Nm (expected: %.3f Nm)\n",
                 plan.axis.c_str(), plan.low_mm, plan.high_mm, plan.limits.max_speed_mm_s,
                 plan.limits.max_torque_Nm, plan.largest_torque_Nm);
  for (const CommissionMotion& m : plan.motions) text += "  " + m.what + "\n";
  return text;
}

}  // namespace contour
