#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>

#include "daemon/lanes/slow_lane.h"
#include "daemon/telemetry/log_header.h"
#include "daemon/telemetry/log_stats.h"
#include "daemon/telemetry/log_writer.h"
#include "drivers/lcm/telemetry_encoder.h"

namespace contour {

/// A log whose file may stall: it is written by a thread of its own, and what finds no room on the way there
/// is lost and counted. Nobody who hands something over or looks at the counts waits for the file.
class BackgroundLog final : public TelemetrySink {
 public:
  struct Limits {
    std::size_t max_bytes = 32u << 20;       ///< waiting for the file: half a minute of two axes at 1 kHz
    std::size_t max_note_bytes = 32u << 20;  ///< beyond that, for notes alone: without them a replay is lost
    std::chrono::milliseconds patience{0};   ///< as SlowLane has it
    std::chrono::milliseconds opening{10'000};  ///< a file that takes longer cannot be used
  };

  /// Throws std::runtime_error with file and cause when the file cannot be made, or not in time.
  BackgroundLog(const std::filesystem::path& file, const LogHeader& header, const Limits& limits);

  void OnEvent(const TelemetryEvent& event) noexcept override;
  void Note(const std::string& key, const std::string& text) noexcept;
  /// The end of the log. False when the file did not take everything by then: what waits is lost.
  bool Close(std::chrono::steady_clock::time_point deadline) noexcept;

  [[nodiscard]] LogStats stats() const;

 private:
  /// What was lost on the way and the writer has not been told yet.
  struct Lost {
    std::mutex mutex;
    std::uint64_t cycles = 0;
    std::uint64_t notes = 0;
  };
  static void Report(LogWriter& writer, Lost& lost) noexcept;

  const Limits limits_;
  const std::string file_;
  std::shared_ptr<LogWriter> writer_;
  std::shared_ptr<Lost> lost_ = std::make_shared<Lost>();
  mutable std::mutex mutex_;       // guards those below
  std::uint64_t handed_over_ = 0;  ///< cycles, also those that were lost on the way
  bool closed_ = false;
  SlowLane lane_;
};

}  // namespace contour
