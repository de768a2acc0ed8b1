#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "core/visit.h"

namespace contour {

/// A coil that a program switches.
struct ProgramCoilConfig {
  int coil = 0;
  double settle_s = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("coil", coil, Range{0, 65535}, "coil (function 5) that is on");
    v.Optional("settle_s", settle_s, kNotNegative, "the program rests so long after it has been switched on");
  }
};

/// A holding register for a speed.
struct SpeedRegisterConfig {
  int address = 0;
  double counts_per_rpm = 1.0;
  double largest_rpm = 0.0;
  double settle_s = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("address", address, Range{0, 65535}, "holding register (function 6) of the speed, not signed");
    v.Optional("counts_per_rpm", counts_per_rpm, kPositive, "counts of one revolution per minute");
    v.Required("largest_rpm", largest_rpm, kPositive, "a program that asks for more is refused");
    v.Optional("settle_s", settle_s, kNotNegative,
               "the program rests so long after another speed was written");
  }
};

/// A holding register for the number of a tool.
struct ToolRegisterConfig {
  int address = 0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("address", address, Range{0, 65535}, "holding register (function 6) of the tool's number");
  }
};

/// What M6 does besides waiting for the operator, or instead of it.
struct ToolChangeConfig {
  int coil = 0;
  bool hold = true;
  double settle_s = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("coil", coil, Range{0, 65535}, "coil (function 5) that is on while a tool is changed");
    v.Optional("hold", hold, "true: until contour resume; false: for settle_s, and the program goes on");
    v.Optional("settle_s", settle_s, kNotNegative, "the coil is on so long at least");
  }
};

/// `io.modbus.outputs.program`: what programs switch. An event that is left out switches nothing.
struct ProgramOutputsConfig {
  std::optional<ProgramCoilConfig> spindle_forward;
  std::optional<ProgramCoilConfig> spindle_backward;
  std::optional<SpeedRegisterConfig> spindle_speed;
  std::optional<ProgramCoilConfig> mist;
  std::optional<ProgramCoilConfig> flood;
  std::optional<ToolRegisterConfig> tool_number;
  std::optional<ToolChangeConfig> tool_change;
  double silence_s = 1.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("spindle_forward", spindle_forward, "on by M3, off by M4 and M5");
    v.Optional("spindle_backward", spindle_backward, "on by M4, off by M3 and M5");
    v.Optional("spindle_speed", spindle_speed, "written by S");
    v.Optional("mist", mist, "on by M7, off by M9");
    v.Optional("flood", flood, "on by M8, off by M9");
    v.Optional("tool_number", tool_number, "written by T");
    v.Optional("tool_change", tool_change, "on by M6");
    v.Optional("silence_s", silence_s, Range{0.1, 60},
               "outputs go off when no cycle has been seen for so long, and the program ends");
  }
};

/// The key of an address that two outputs have, below io.modbus.outputs; empty: there is none.
inline std::string SharedAddress(const ProgramOutputsConfig& c, std::optional<int> lubrication_coil) {
  std::set<int> coils, registers;
  std::string shared;
  const auto take = [&](std::set<int>& taken, int address, const char* key) {
    if (!taken.insert(address).second && shared.empty()) shared = key;
  };
  if (lubrication_coil) coils.insert(*lubrication_coil);
  if (c.spindle_forward) take(coils, c.spindle_forward->coil, "program.spindle_forward.coil");
  if (c.spindle_backward) take(coils, c.spindle_backward->coil, "program.spindle_backward.coil");
  if (c.mist) take(coils, c.mist->coil, "program.mist.coil");
  if (c.flood) take(coils, c.flood->coil, "program.flood.coil");
  if (c.tool_change) take(coils, c.tool_change->coil, "program.tool_change.coil");
  if (c.spindle_speed) take(registers, c.spindle_speed->address, "program.spindle_speed.address");
  if (c.tool_number) take(registers, c.tool_number->address, "program.tool_number.address");
  return shared;
}

}  // namespace contour
