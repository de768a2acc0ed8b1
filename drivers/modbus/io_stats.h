#pragma once

#include <cstdint>
#include <string>

namespace contour {

/// How talking to the Modbus server went so far.
struct IoStats {
  bool configured = false;
  bool connected = false;
  std::uint64_t polls = 0;        ///< complete polls
  std::uint64_t failures = 0;     ///< failed connections, reads and writes
  std::uint64_t connections = 0;  ///< times a connection was made
  std::string last_error;         ///< empty while nothing has failed
  std::uint64_t lubrication_pulses = 0;
};

}  // namespace contour
