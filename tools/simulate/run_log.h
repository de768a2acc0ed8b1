#pragma once

#include <array>
#include <filesystem>

#include "daemon/telemetry/log_header.h"
#include "daemon/telemetry/log_writer.h"
#include "drivers/lcm/telemetry_encoder.h"

namespace contour {

/// The log of a run in virtual time: what `contourd --log` would have written. Two runs that are the same
/// give the same file.
class RunLog {
 public:
  /// Throws std::runtime_error when the file cannot be made.
  RunLog(const std::filesystem::path& file, const LogHeader& header);

  void Add(const CycleEntry& entry);
  void Note(const std::string& key, const std::string& text) { writer_.Note(key, text); }
  void State(const LogState& state) { writer_.State(state); }
  /// Throws std::runtime_error when something could not be written.
  void Close();

 private:
  LogWriter writer_;
  TelemetryEncoder encoder_;
  std::array<TelemetrySink*, 1> sinks_{&writer_};
};

}  // namespace contour
