#include "tools/simulate/run_log.h"

#include <stdexcept>

namespace contour {

RunLog::RunLog(const std::filesystem::path& file, const LogHeader& header)
    : writer_(file, header), encoder_(TelemetryConfig{}, header.cycle_us, header.axis_names) {}

void RunLog::Add(const CycleEntry& entry) { encoder_.Add(entry, sinks_); }

void RunLog::Close() {
  encoder_.Flush(sinks_);
  writer_.Close();
  const LogStats stats = writer_.stats();
  if (stats.lost_cycles != 0)
    throw std::runtime_error("cannot write " + stats.file + ": " + stats.last_error);
}

}  // namespace contour
