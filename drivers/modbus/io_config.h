#pragma once

#include <optional>
#include <string>

#include "core/visit.h"
#include "drivers/modbus/program_outputs_config.h"

namespace contour {

/// Temperature of the ball screws, an input register (function 4) taken as a signed 16-bit count.
struct TemperatureInputConfig {
  int address = 0;
  double degC_per_count = 0.1;
  double offset_degC = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("address", address, Range{0, 65535}, "input register of the temperature, signed");
    v.Optional("degC_per_count", degC_per_count, kAny, "temperature of one count");
    v.Optional("offset_degC", offset_degC, kAny, "temperature at count zero");
  }
};

/// Discrete inputs (function 2): 1 means the circuit is closed, motion is permitted. An input that is left
/// out is not looked at.
struct IoInputsConfig {
  std::optional<int> emergency_stop;
  std::optional<int> enable_chain;
  std::optional<TemperatureInputConfig> screw_temperature;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("emergency_stop", emergency_stop, Range{0, 65535},
               "discrete input, 1 while the emergency-stop circuit is closed");
    v.Optional("enable_chain", enable_chain, Range{0, 65535},
               "discrete input, 1 while the enable chain is closed");
    v.Optional("screw_temperature", screw_temperature, "temperature of the ball screws");
  }
};

/// The coil opens for pulse_s after so much travel (all axes added up) or so much time in motion, whichever
/// comes first; 0 switches that trigger off.
struct LubricationConfig {
  int coil = 0;
  double every_travel_m = 0.0;
  double every_moving_s = 0.0;
  double pulse_s = 1.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("coil", coil, Range{0, 65535}, "coil (function 5) of the lubrication pump");
    v.Optional("every_travel_m", every_travel_m, kNotNegative, "travel between two pulses; 0: not by travel");
    v.Optional("every_moving_s", every_moving_s, kNotNegative,
               "time in motion between two pulses; 0: not by time");
    v.Optional("pulse_s", pulse_s, kPositive, "length of a pulse");
  }
};

struct IoOutputsConfig {
  std::optional<LubricationConfig> lubrication;
  std::optional<ProgramOutputsConfig> program;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("lubrication", lubrication, "lubrication of the ball screws");
    v.Optional("program", program, "spindle, coolant and tools, as programs switch them");
  }
};

/// One Modbus TCP server. Data older than timeout_ms count as open circuits; a reply that takes longer than
/// timeout_ms is a failed poll.
struct ModbusConfig {
  std::string host;
  int port = 502;
  int unit_id = 1;
  int poll_ms = 20;
  int timeout_ms = 100;
  bool accept_blind_travel = false;
  IoInputsConfig inputs;
  IoOutputsConfig outputs;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("host", host, "name or address of the Modbus TCP server");
    v.Optional("port", port, Range{1, 65535}, "TCP port of the Modbus server");
    v.Optional("unit_id", unit_id, Range{0, 255}, "Modbus unit identifier");
    v.Optional("poll_ms", poll_ms, Range{1, 500}, "time between two polls");
    v.Optional("timeout_ms", timeout_ms, Range{2, 5000},
               "age at which inputs count as open circuits, and longest wait for a reply");
    v.Optional(
        "accept_blind_travel", accept_blind_travel,
        "true: an axis may go further than half its stroke until an emergency stop is seen and obeyed");
    v.Optional("inputs", inputs, "what is read");
    v.Optional("outputs", outputs, "what is written");
  }
};

/// `io:` of a machine file.
struct IoConfig {
  std::optional<ModbusConfig> modbus;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("modbus", modbus, "enable chain, emergency stop and auxiliary I/O over Modbus TCP");
  }
};

/// What no single range can say; empty when there is nothing wrong.
inline std::string Problem(const ModbusConfig& c) {
  if (c.timeout_ms < 2 * c.poll_ms) {
    return "io.modbus.timeout_ms must be at least twice poll_ms, or fresh data count as old";
  }
  return {};
}

}  // namespace contour
