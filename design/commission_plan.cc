#include "design/commission_plan.h"

#include <algorithm>
#include <cmath>

#include "analysis/text/format_text.h"
#include "config/config_error.h"
#include "config/machine_checks.h"
#include "drivers/cia402/mode_for.h"

namespace contour {
namespace {

constexpr double kShareOfStroke = 0.1;
constexpr double kTravel_mm = 20.0;
constexpr double kShareOfSpeed = 0.4;
constexpr double kSpeed_mm_s = 100.0;
constexpr double kShareOfTorque = 0.6;
/// Two turns of the motor to average over, one at the least.
constexpr double kFewestTurns = 1.0;
/// Strokes and speeds stay this far inside what is allowed: a controller with a wrong model overshoots.
constexpr double kMargin_mm = 0.15;
constexpr double kShareOfTop = 0.95;
/// Less room than this on one side is none.
constexpr double kLeastStroke_mm = 1.0;
constexpr double kSlowestTop_mm_s = 20.0;
/// Force of the chirp at the table, and of each line of the multisine.
constexpr double kChirp_N = 60.0;
constexpr double kLine_N = 2.0;
constexpr int kLines = 12;
/// What the model may be wrong by.
constexpr double kDoubt = 1.5;

void Require(bool good, const std::string& message) {
  if (!good) throw ConfigError({message});
}

/// Torques in steps up to beyond break-away, both ways: shares of the stated level.
std::string TorqueSteps(double level_Nm, double most_Nm) {
  std::string list;
  for (const double share : {0.3, 0.6, 0.9, 1.3, 1.8})
    for (const double sign : {1.0, -1.0})
      list += (list.empty() ? "" : ", ") + FormatText("%.5f", sign * std::min(share * level_Nm, most_Nm));
  return list;
}

}  // namespace

CommissionLimits DefaultCommissionLimits(const AxisConfig& axis) {
  const AxisLimits& l = axis.limits;
  return {std::min(kTravel_mm, kShareOfStroke * (l.position_mm[1] - l.position_mm[0])),
          std::min(kSpeed_mm_s, kShareOfSpeed * l.velocity_mm_s), kShareOfTorque * l.torque_Nm};
}

CommissionPlan PlanCommissioning(const MachineConfig& machine, const std::string& name, double position_mm,
                                 const CommissionLimits& limits) {
  Require(machine.axes.contains(name), "--axis: there is no axis \"" + name + "\" in this machine");
  const AxisConfig& axis = machine.axes.at(name);
  Require(ModeFor(machine.machine.controller, axis.drive) == DriveMode::kCst,
          "axis " + name + ": commissioning takes a drive in torque mode (drive.mode: cst)");
  const AxisLimits& l = axis.limits;
  const Mechanics m = ToSi(axis.model.mechanics);
  const Friction f = ToSi(axis.model.friction, m.radius_m_rad);
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
  Require(limits.max_speed_mm_s >= kSlowestTop_mm_s && limits.max_speed_mm_s <= l.velocity_mm_s,
          FormatText("--max_speed_mm_s: found %g, expected %g to %g (axes.%s.limits.velocity_mm_s)",
                     limits.max_speed_mm_s, kSlowestTop_mm_s, l.velocity_mm_s, name.c_str()));
  Require(
      limits.max_torque_Nm > 0.0 && limits.max_torque_Nm <= l.torque_Nm,
      FormatText("--max_torque_Nm: found %g, expected more than 0 and at most %g (axes.%s.limits.torque_Nm)",
                 limits.max_torque_Nm, l.torque_Nm, name.c_str()));

  CommissionPlan plan;
  plan.axis = name;
  plan.limits = limits;
  // The small motions about the place go both ways: not nearer than this to an end.
  Require(
      position_mm - l.position_mm[0] >= kLeastStroke_mm && l.position_mm[1] - position_mm >= kLeastStroke_mm,
      FormatText(
          "axis %s stands at %.3f mm: commissioning needs %g mm to either side; move it away from its end "
          "first",
          name.c_str(), position_mm, kLeastStroke_mm));
  plan.low_mm = std::clamp(position_mm - 0.5 * travel, l.position_mm[0], l.position_mm[1] - travel);
  plan.high_mm = plan.low_mm + travel;
  const double friction_N = std::max({f.Fs_plus_N, f.Fs_minus_N, f.Fc_plus_N, f.Fc_minus_N});
  const double moving_N = std::max(
      friction_N, std::max(f.Fc_plus_N, f.Fc_minus_N) + f.sigma2_Ns_m * limits.max_speed_mm_s * 1e-3);
  const double ramp_N = m.mass_kg * l.acceleration_mm_s2 * 1e-3;
  plan.largest_torque_Nm = m.radius_m_rad * kDoubt * std::max(ramp_N + moving_N, kChirp_N + friction_N);
  Require(plan.largest_torque_Nm <= limits.max_torque_Nm,
          FormatText(
              "--max_torque_Nm: found %g, but the ramps of %g mm/s^2 may take %.3g Nm (should the model be "
              "wrong by "
              "half): allow more, or lower axes.%s.limits.acceleration_mm_s2",
              limits.max_torque_Nm, l.acceleration_mm_s2, plan.largest_torque_Nm, name.c_str()));

  const char* axis_name = name.c_str();
  const auto add = [&](std::string what, std::string yaml) {
    plan.motions.push_back({std::move(what), std::move(yaml)});
  };
  const auto creep = [&](double stroke_mm, const std::vector<double>& speeds, double dwell_s) {
    std::string list;
    for (const double v : speeds) list += (list.empty() ? "" : ", ") + FormatText("%g", v);
    return FormatText("shape: creep\naxis: %s\nstroke_mm: %.6f\nvelocities_mm_s: [%s]\ndwell_s: %g\n",
                      axis_name, stroke_mm, list.c_str(), dwell_s);
  };
  // Every program ends where it began, so the axis goes up from its place and down from it.
  const double up = plan.high_mm - kMargin_mm - position_mm;
  const double down = plan.low_mm + kMargin_mm - position_mm;
  const double turn = std::min(lead_mm, travel);
  // The shorter strokes go where there is room.
  const double way = up >= -down ? 1.0 : -1.0;
  const double room = std::max(up, -down);
  const double one_turn = way * std::min(turn, room);
  std::vector<double> fast;
  const double top = kShareOfTop * limits.max_speed_mm_s;
  for (const double v : {10.0, 20.0, 50.0, 100.0})
    if (v < 0.8 * top) fast.push_back(v);
  fast.push_back(top);
  const auto whole_way = [&](const std::string& what, const std::vector<double>& speeds,
                             const std::string& torque) {
    if (up > kLeastStroke_mm) add(what + ", upwards", creep(up, speeds, 0.1) + torque);
    if (-down > kLeastStroke_mm) add(what + ", downwards", creep(down, speeds, 0.1) + torque);
  };
  add("slow strokes over a turn", creep(one_turn, {2, 5}, 0.1));
  whole_way("strokes over the whole way", fast, "");
  add("slower than the Stribeck velocity", creep(one_turn, {1}, 0.1));
  add("creeping", creep(0.5 * one_turn, {0.5}, 0.1));
  add("creeping", creep(0.2 * one_turn, {0.2}, 0.1));
  add("creeping", creep(0.06 * one_turn, {0.1}, 0.1));
  add("reversals, from sticking to sliding",
      FormatText("shape: reversals\naxis: %s\namplitudes_mm: [0.002, 0.005, "
                 "0.015, 0.05, 0.2, %g]\nfrequency_hz: 1\ncycles: 2\n",
                 axis_name, std::clamp(std::min(up, -down), 0.05, 1.0)));
  const double level_Nm = m.radius_m_rad * 0.5 * (f.Fs_plus_N + f.Fs_minus_N);
  const double travel_mm = std::min(0.3, 0.6 * l.following_error_mm);
  add("steps of torque at rest",
      FormatText("shape: torque_steps\naxis: %s\ntravel_mm: %g\ntorques_Nm: [%s]\nhold_s: 0.1\nrest_s: 0.1\n",
                 axis_name, travel_mm, TorqueSteps(level_Nm, limits.max_torque_Nm).c_str()));
  add("shaking at rest, 8 to 120 Hz",
      FormatText("shape: hold\nseconds: 4\ntorque: {axis: %s, kind: multisine, "
                 "amplitude_Nm: %.6f, frequency_min_hz: 8, "
                 "frequency_max_hz: 120, lines: %d}\n",
                 axis_name, kLine_N * m.radius_m_rad, kLines));
  const double top_Hz = std::min(480.0, 0.48e6 / machine.machine.cycle_us);
  // Fast enough that a controller which swings, its mass being wrong, does not turn the axis back.
  std::vector<double> slides;
  for (const double speed : {std::max(3.0, travel / 4.0), 0.75 * travel, travel})
    slides.push_back(std::min(speed, 0.8 * top));
  whole_way(FormatText("chirp while sliding, 100 to %.0f Hz", top_Hz), slides,
            FormatText("torque: {axis: %s, kind: chirp, amplitude_Nm: %.6f, frequency_min_hz: 100, "
                       "frequency_max_hz: %.0f, "
                       "period_s: 0.5}\n",
                       axis_name, kChirp_N * m.radius_m_rad, top_Hz));
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
