#include "daemon/bus_health.h"

#include <utility>

namespace contour {
namespace {

/// A controller that goes to and fro between two states is told of this rarely.
constexpr std::chrono::seconds kBetweenLines{10};
constexpr const char* kLook = "Check wiring, both terminations, and that all nodes have the same bit rate";

std::string Counts(const BusState& s) {
  if (s.transmit_errors == 0 && s.receive_errors == 0) return {};
  return " (transmit " + std::to_string(s.transmit_errors) + ", receive " + std::to_string(s.receive_errors) +
         " errors counted)";
}

}  // namespace

BusHealth::BusHealth(std::vector<Named> buses) : buses_(std::move(buses)), told_(buses_.size()) {}

BusHealth::Level BusHealth::LevelOf(const BusState& state) noexcept {
  if (state.bus_off) return Level::kBusOff;
  switch (state.errors) {
    case ControllerErrors::kPassive:
      return Level::kPassive;
    case ControllerErrors::kWarning:
      return Level::kWarning;
    case ControllerErrors::kActive:
      break;
  }
  return Level::kGood;
}

std::string BusHealth::Text(const BusState& state, Level level, const Named& bus) {
  switch (level) {
    case Level::kBusOff:
      return "its CAN controller is bus-off: it takes no part any more. " + std::string(kLook) +
             ". It comes back by itself where the interface has restart-ms, else by: ip link set " +
             bus.interface + " type can restart. Then reset the machine";
    case Level::kPassive:
      return "its CAN controller is error passive" + Counts(state) +
             ": frames are lost, and bus-off is next. " + kLook;
    case Level::kWarning:
      return "its CAN controller counts many errors (error warning)" + Counts(state) + ". " + kLook;
    case Level::kGood:
      break;
  }
  return "its CAN controller is error active again, as it should be";
}

std::vector<BusHealth::Line> BusHealth::Look(std::size_t i, const BusState& state, Time now) {
  std::vector<Line> lines;
  if (i >= told_.size()) return lines;
  Told& told = told_[i];
  const std::string bus = "bus " + buses_[i].name + ": ";
  const Level level = LevelOf(state);
  const bool was_off = told.level == Level::kBusOff;
  const bool is_off = level == Level::kBusOff;
  // Over before it was looked for.
  const bool missed = !is_off && state.bus_offs != told.bus_offs;
  told.bus_offs = state.bus_offs;
  if (missed) {
    lines.push_back({false, bus + "its CAN controller was bus-off and has restarted, " +
                                std::to_string(state.bus_offs) + " times since the start. " + kLook +
                                "; reset the machine"});
    told.level = level;
    told.again = now + kBetweenLines;
    return lines;
  }
  if (level == told.level || (now < told.again && !is_off && !was_off)) return lines;
  std::string text = Text(state, level, buses_[i]);
  if (was_off) text = "bus-off is over, the controller has restarted; " + text;
  lines.push_back({level == Level::kGood, bus + text});
  told.level = level;
  told.again = now + kBetweenLines;
  return lines;
}

}  // namespace contour
