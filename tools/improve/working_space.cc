#include "tools/improve/working_space.h"

#include <algorithm>
#include <cmath>

#include "analysis/text/format_text.h"
#include "config/config_error.h"
#include "daemon/program/program.h"

namespace contour::improve {
namespace {

/// Of the way at most, that programs stay inside.
constexpr double kMarginOfWay = 0.0075;
/// A program is looked at this often for how far it goes.
constexpr double kLook_s = 2e-3;
/// Nearer than this, an axis is where it is wanted.
constexpr double kThere_m = 1e-6;
constexpr double kShareOfSpeed = 0.5;
/// Rounding of speeds in programs.
constexpr double kRounding = 1.001;

struct Extent {
  double low_m = 0.0, high_m = 0.0, speed_m_s = 0.0;
};

/// How far and how fast a program goes from zero.
PerAxis<Extent> ExtentOf(const MotionPlan& plan) {
  PerAxis<Extent> out(plan.axis_count());
  PerAxis<ReferencePoint> at(plan.axis_count());
  const double end_s = plan.duration_s();
  for (double t = 0.0; t < end_s + kLook_s; t += kLook_s) {
    plan.At(std::min(t, end_s), at);
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i].low_m = std::min(out[i].low_m, at[i].position_m);
      out[i].high_m = std::max(out[i].high_m, at[i].position_m);
      out[i].speed_m_s = std::max(out[i].speed_m_s, std::abs(at[i].velocity_m_s));
    }
  }
  return out;
}

/// The same machine, with room without end: it says how large a program is.
PerAxis<PlanLimits> WithoutEnds(PerAxis<PlanLimits> limits) {
  constexpr double kFar_m = 1e3;
  for (PlanLimits& l : limits) {
    l.position_min_m = -kFar_m;
    l.position_max_m = kFar_m;
  }
  return limits;
}

}  // namespace

WorkingSpace SpaceFor(const MachineConfig& machine, const std::string& axis, const CommissionLimits& limits,
                      const PerAxis<double>& position_m) {
  if (!machine.axes.contains(axis))
    throw ConfigError({"--axis: the daemon's machine has no axis \"" + axis + "\""});
  const AxisLimits& own = machine.axes.at(axis).limits;
  const double torque_share = limits.max_torque_Nm / own.torque_Nm;
  WorkingSpace space;
  for (const auto& [name, config] : machine.axes) {
    const AxisLimits& l = config.limits;
    const double low_m = 1e-3 * l.position_mm[0], high_m = 1e-3 * l.position_mm[1];
    const double way_m = std::min(1e-3 * limits.travel_mm, high_m - low_m);
    const std::size_t i = space.names.size();
    AxisSpace s;
    s.low_m = std::clamp(position_m[i] - 0.5 * way_m, low_m, high_m - way_m);
    s.high_m = s.low_m + way_m;
    s.margin_m = std::min(1e-3 * l.following_error_mm, kMarginOfWay * way_m);
    s.max_speed_m_s = 1e-3 * std::min(limits.max_speed_mm_s, l.velocity_mm_s);
    s.max_torque_Nm = torque_share * l.torque_Nm;
    if (name == axis) space.axis = i;
    space.names.push_back(name);
    space.axes.push_back(s);
  }
  return space;
}

Placed Place(const ProgramText& program, const WorkingSpace& space, const PerAxis<PlanLimits>& limits,
             const PerAxis<double>& preferred_m) {
  const Program parsed = ParseProgram(program.text, program.name, program.format);
  const PerAxis<double> zero(limits.size());
  const auto plan = PlanMotion(parsed, zero, WithoutEnds(limits));
  const PerAxis<Extent> extents = ExtentOf(*plan);
  Placed out{program, preferred_m, plan->duration_s(), {}};
  for (std::size_t i = 0; i < extents.size(); ++i) {
    const Extent& e = extents[i];
    const AxisSpace& s = space.axes[i];
    out.moves.push_back(plan->Moves(i));
    if (e.high_m == e.low_m) continue;
    const double room_m = s.high_m - s.low_m - 2.0 * s.margin_m;
    if (e.high_m - e.low_m > room_m)
      throw ConfigError({FormatText(
          "%s: goes over %.3f mm of axis %s, expected at most %.3f mm (--travel_mm "
          "less a margin)",
          program.name.c_str(), 1e3 * (e.high_m - e.low_m), space.names[i].c_str(), 1e3 * room_m)});
    if (e.speed_m_s > kRounding * s.max_speed_m_s)
      throw ConfigError({FormatText(
          "%s: axis %s goes at %.3g mm/s, expected at most %.3g mm/s "
          "(--max_speed_mm_s)",
          program.name.c_str(), space.names[i].c_str(), 1e3 * e.speed_m_s, 1e3 * s.max_speed_m_s)});
    out.start_m[i] =
        std::clamp(preferred_m[i], s.low_m + s.margin_m - e.low_m, s.high_m - s.margin_m - e.high_m);
  }
  PlanMotion(parsed, out.start_m, limits);  // torque, spring and all the rest
  return out;
}

std::vector<ProgramText> WayTo(const PerAxis<double>& from_m, const PerAxis<double>& to_m,
                               const WorkingSpace& space) {
  std::vector<ProgramText> out;
  for (std::size_t i = 0; i < from_m.size(); ++i) {
    const double way_m = to_m[i] - from_m[i];
    if (std::abs(way_m) < kThere_m) continue;
    // The shape wants two axes where there are two.
    const std::string axes =
        from_m.size() < 2 ? "" : "axes: [" + space.names[i] + ", " + space.names[i == 0 ? 1 : 0] + "]\n";
    out.push_back({"to the start",
                   FormatText("shape: line\n%sdx_mm: %.6f\nfeed_mm_min: %.3f\n", axes.c_str(), 1e3 * way_m,
                              6e4 * kShareOfSpeed * space.axes[i].max_speed_m_s),
                   ProgramFormat::kYaml});
  }
  return out;
}

std::string Describe(const WorkingSpace& space) {
  std::string text;
  for (std::size_t i = 0; i < space.names.size(); ++i) {
    const AxisSpace& s = space.axes[i];
    text +=
        FormatText("axis %s: between %.2f and %.2f mm, at most %g mm/s and %.3g Nm\n", space.names[i].c_str(),
                   1e3 * s.low_m, 1e3 * s.high_m, 1e3 * s.max_speed_m_s, s.max_torque_Nm);
  }
  return text;
}

}  // namespace contour::improve
