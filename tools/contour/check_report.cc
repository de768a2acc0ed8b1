#include "tools/contour/check_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "config/bus_timing.h"
#include "config/following_room.h"
#include "config/machine_checks.h"
#include "config/mode_advice.h"
#include "config/motion_bounds.h"
#include "config/number_text.h"
#include "config/push_advice.h"
#include "config/screw_advice.h"
#include "config/stated_push.h"
#include "config/stopping.h"
#include "core/mechanics.h"
#include "drivers/cia402/mode_for.h"
#include "tools/contour/text_table.h"

namespace contour {
namespace {

std::string WithUnit(const std::string& number, const char* unit) {
  return number + (unit[0] != '\0' ? " " : "") + unit;
}

std::string Number(double value, const char* unit = "") { return WithUnit(RoundedText(value), unit); }

std::string Fixed(double value, int decimals, const char* unit) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return WithUnit(text.data(), unit);
}

std::string Head(const MachineConfig& c) {
  return "Machine " + c.machine.name + ": cycle " + std::to_string(c.machine.cycle_us) + " us, controller " +
         std::string(Name(c.machine.controller)) + ", " + std::to_string(c.axes.size()) +
         (c.axes.size() == 1 ? " axis" : " axes") + "\n";
}

// One column per axis: easy to compare.
std::string Axes(const MachineConfig& c) {
  TextColumns table;
  std::vector<std::string> names{""};
  for (const std::string& name : AxisNames(c)) names.push_back(name);
  table.Add(names);
  const auto line = [&](const char* title, auto value) {
    std::vector<std::string> row{title};
    for (const auto& [name, axis] : c.axes) row.push_back(value(axis));
    table.Add(row);
  };
  line("bus, node, mode", [&c](const AxisConfig& a) {
    return a.drive.bus + ", " + std::to_string(a.drive.node_id) + ", " +
           std::string(Name(ModeFor(c.machine.controller, a.drive)));
  });
  line("position", [](const AxisConfig& a) {
    return Number(a.limits.position_mm[0]) + " .. " + Number(a.limits.position_mm[1], "mm");
  });
  line("velocity", [](const AxisConfig& a) { return Number(a.limits.velocity_mm_s, "mm/s"); });
  line("acceleration", [](const AxisConfig& a) { return Number(a.limits.acceleration_mm_s2, "mm/s^2"); });
  line("jerk", [](const AxisConfig& a) { return Number(a.limits.jerk_mm_s3, "mm/s^3"); });
  line("following error", [](const AxisConfig& a) { return Number(a.limits.following_error_mm, "mm"); });
  line("torque: limit", [](const AxisConfig& a) { return Number(a.limits.torque_Nm, "Nm"); });
  line("torque: rated, peak", [](const AxisConfig& a) {
    return Number(a.drive.rated_torque_Nm) + ", " + Number(a.drive.peak_torque_Nm, "Nm");
  });
  line("force at the limit",
       [](const AxisConfig& a) { return Fixed(a.limits.torque_Nm / Reserve(a).radius_m_rad, 0, "N"); });
  line("effective mass (Jm/R^2 + Mt)", [](const AxisConfig& a) { return Number(Reserve(a).mass_kg, "kg"); });
  line("one encoder count", [](const AxisConfig& a) {
    return Number(1e6 * a.model.mechanics.lead_mm / a.drive.encoder_counts_per_rev, "nm");
  });
  line("one per mille of torque", [](const AxisConfig& a) {
    return Fixed(1e-3 * a.drive.rated_torque_Nm / Reserve(a).radius_m_rad, 2, "N");
  });
  line("friction at full speed", [](const AxisConfig& a) { return Fixed(Reserve(a).friction_N, 0, "N"); });
  if (std::ranges::any_of(c.axes, [](const auto& axis) { return Reserve(axis.second).pushed_N > 0.0; }))
    line("weight, spring as stated", [](const AxisConfig& a) { return Fixed(Reserve(a).pushed_N, 0, "N"); });
  line("torque for the limits", [](const AxisConfig& a) { return Number(Reserve(a).needed_Nm, "Nm"); });
  line("acceleration available",
       [](const AxisConfig& a) { return Fixed(1e3 * Reserve(a).available_m_s2, 0, "mm/s^2"); });
  line("acceleration reserve", [](const AxisConfig& a) {
    return Fixed(100.0 * (1e3 * Reserve(a).available_m_s2 / a.limits.acceleration_mm_s2 - 1.0), 0, "%");
  });
  return "\nAxes\n" + table.Text();
}

std::string Stops(const MachineConfig& c) {
  TextColumns table;
  std::vector<std::string> head{"way of stopping"};
  for (const std::string& name : AxisNames(c)) {
    head.push_back(name + ": time");
    head.push_back("travel");
  }
  head.push_back("");
  table.Add(head);
  std::string notes;
  for (const StopWay& way : StopWays(c)) {
    std::vector<std::string> row{way.name};
    for (const StopBound& b : way.axes) {
      row.push_back(Fixed(1e3 * b.time_s, 1, "ms"));
      row.push_back(Fixed(b.travel_mm, 2, "mm"));
    }
    table.Add(row);
    notes += "  " + way.name + ": " + way.how + "\n";
  }
  std::string safe;
  for (const auto& [name, axis] : c.axes)
    safe += "  " + name + ": from rest at the torque limit" +
            (UnbornePushOf(axis.model).sliding_N > 0.0 ? " and what the model states to push besides" : "") +
            ", until the drive has noticed a dead master (" + Number(axis.drive.notice_ms, "ms") +
            ") and stopped: " + Fixed(SilentMaster(ToStoppingAxis(c, axis), 0.0).travel_mm, 2, "mm") +
            ", safe travel " + Number(axis.limits.safe_travel_mm, "mm") + "\n";
  return "\nStopping: bounds from the velocity limit to standstill\n" + table.Text() + notes +
         "Safe travel\n" + safe;
}

// What becomes of an axis whose drive gives no torque any more.
std::string Coasting(const AxisConfig& axis) {
  const double coast_mm = CoastTravel_mm(axis);
  const double pushed_N = StatedPushOf(axis.model).size_N();
  const std::string stated = "the " + Fixed(pushed_N, 0, "N") + " that the model states besides friction";
  if (std::isfinite(coast_mm))
    return "with the voltage off the axis then coasts: from its highest speed up to " +
           Fixed(coast_mm, 1, "mm") + " by friction alone" + (pushed_N > 0.0 ? " against " + stated : "") +
           ", less where the drive closes a brake";
  const std::string from = stated + " (constant_torque, cable_spring) are more than ";
  const std::string brake =
      ". Only a brake that the drive closes by itself, or a counterbalance, holds it after a fault, a stop "
      "of the drives and in Idle; bounds above that end with \"torque off\" are up to there";
  if (UnbornePushOf(axis.model).at_rest_N > 0.0)
    return "WITH THE VOLTAGE OFF THE AXIS FALLS, from rest as well: " + from + "friction bears" + brake;
  return "WITH THE VOLTAGE OFF THE AXIS FALLS ONCE IT MOVES: " + from +
         "Coulomb friction bears. At rest break-away friction just holds it, until something moves it" +
         brake;
}

// How far the table can be from the commanded path, and how long that takes, until the torque is off.
std::string Departures(const MachineConfig& c) {
  std::string text =
      "\nFaults of feedback and torque: departure from the commanded path until the torque is off, at a feed "
      "of\n";
  for (const auto& [name, axis] : c.axes) {
    const std::vector<double> feeds = BoundFeeds_mm_s(axis);
    TextColumns table;
    std::vector<std::string> head{"axis " + name};
    for (const double feed : feeds) head.push_back(feed == 0.0 ? "rest" : Number(feed, "mm/s"));
    table.Add(head);
    for (const MotionFault fault : kMotionFaults) {
      std::vector<std::string> departure{std::string(Name(fault))};
      std::vector<std::string> time{"  within"};
      for (const double feed : feeds) {
        const FaultBound b = BoundOf(c, axis, fault, feed);
        const bool shows = std::isfinite(b.departure_mm);
        departure.push_back(shows ? Fixed(b.departure_mm, b.departure_mm < 0.1 ? 4 : 3, "mm") : "not seen");
        time.push_back(shows ? Fixed(1e3 * b.time_s, 1, "ms") : "-");
      }
      table.Add(departure);
      if (fault != MotionFault::kSmallJump) table.Add(time);
    }
    const WorstDeparture worst = WorstDepartureOf(c, axis);
    text += table.Text() + "  worst: " + Fixed(worst.bound.departure_mm, 2, "mm") + " (" +
            std::string(Name(worst.fault)) + " at " + Number(worst.feed_mm_s, "mm/s") + "), safe travel " +
            Number(axis.limits.safe_travel_mm, "mm") + "; " + Coasting(axis) + "\n";
  }
  for (const auto& [name, axis] : c.axes)
    if (const double feed = PromisedFeed_mm_s(c, axis); feed > kSlowestFeed_mm_s)
      text += "  " + name + ": safe_travel_mm is kept from " + Number(feed, "mm/s") +
              " on; slower, an encoder of this resolution takes longer to show that it is frozen\n";
  text +=
      "  A lying encoder gets \"disable voltage\", no ramp that goes by it. At rest a frozen encoder shows "
      "with the "
      "next motion.\n";
  for (const auto& [name, axis] : c.axes)
    if (!axis.drive.linear_scale)
      text +=
          "  " + name +
          ": an encoder that slips by less than a jump that is seen, or has another scale than stated, shows "
          "only with a linear scale; this axis has none\n";
  return text;
}

std::string Response(const std::optional<double>& response_us) {
  return response_us ? Fixed(*response_us, 0, "us") : "-";
}

std::string Bus(const MachineConfig& c, const BusTiming& t) {
  const BusConfig& bus = c.buses.at(t.bus);
  TextColumns table;
  table.Add({"message", "COB-ID", "bytes", "period", "response", "with emergencies"});
  for (const BusMessage& m : t.messages) {
    std::array<char, 16> id{};
    std::snprintf(id.data(), id.size(), "0x%03X", static_cast<unsigned>(m.id));
    table.Add({m.name, id.data(), std::to_string(m.length), Number(m.period_ms, "ms"),
               Response(m.response_us), Response(m.response_with_emergencies_us)});
  }
  std::string text = "\nBus " + t.bus + ": " + bus.interface + ", " + Number(bus.bitrate_bit_s, "bit/s") +
                     "; worst-case load " + Fixed(1e2 * t.cyclic_load, 1, "% by the frames of a cycle, ") +
                     Fixed(1e2 * t.load, 1, "% in all") + "\n" + table.Text();
  text += "  all frames of a cycle are through after " + Response(t.worst_us) + " of " +
          std::to_string(c.machine.cycle_us) + " us; they may leave " +
          Fixed(c.machine.cycle_us - *t.worst_us, 0, "us") + " after the grid point at the latest\n";
  if (!t.worst_with_emergencies_us || *t.worst_with_emergencies_us > c.machine.cycle_us)
    text +=
        "  an emergency message from each drive at once can make feedback miss a grid point (a stale "
        "cycle)\n";
  return text;
}

std::string Buses(const MachineConfig& c) {
  std::string text;
  for (const BusTiming& t : BusTimings(c)) text += Bus(c, t);
  return text;
}

std::string Timing(const MachineConfig& c) {
  std::string text = "\nTiming\n";
  text += "  cycle " + std::to_string(c.machine.cycle_us) + " us; frames late after " +
          std::to_string(SendDeadline_ns(c) / 1000) + " us\n";
  for (const auto& [name, axis] : c.axes)
    text += "  " + name + ": from sample to torque " +
            std::to_string(axis.drive.delay_cycles * c.machine.cycle_us) + " us and a lag of " +
            Number(1e3 * axis.drive.lag_ms, "us") + "\n";
  return text;
}

std::string Advice(const MachineConfig& c) {
  std::string text;
  for (const std::string& advice : ScrewAdvice(c)) text += "  " + advice + "\n";
  for (const std::string& advice : ModeAdvice(c)) text += "  " + advice + "\n";
  for (const std::string& advice : PushAdvice(c)) text += "  " + advice + "\n";
  for (const std::string& advice : FollowingAdvice(c)) text += "  " + advice + "\n";
  return text.empty() ? text : "\nAdvice\n" + text;
}

}  // namespace

std::string CheckReport(const MachineConfig& c) {
  return Head(c) + Axes(c) + Stops(c) + Departures(c) + Buses(c) + Timing(c) + Advice(c);
}

}  // namespace contour
