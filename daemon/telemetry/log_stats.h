#pragma once

#include <cstdint>
#include <string>

namespace contour {

/// How writing the log went so far.
struct LogStats {
  std::string file;                  ///< empty: no log is written
  std::uint64_t cycles = 0;          ///< cycles safely handed to the file system
  std::uint64_t lost_cycles = 0;     ///< cycles that could not be written (disk full, for one)
  std::uint64_t lost_notes = 0;      ///< and texts of programs and changes of gains
  std::uint64_t waiting_cycles = 0;  ///< handed over, and not yet in the file
  std::uint64_t bytes = 0;
  std::string last_error;  ///< empty while nothing has failed
};

}  // namespace contour
