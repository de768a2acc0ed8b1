#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>

#include "daemon/telemetry/log_header.h"
#include "daemon/telemetry/log_stats.h"
#include "drivers/lcm/telemetry_encoder.h"

namespace contour {

/// Writes the log of a run: an LCM event log that lcm-logplayer plays (docs/telemetry.md has the format).
///
/// Events are gathered and handed to the file system batch by batch. What does not fit, because the disk is
/// full for one, is cut off again, so that the file stays readable, and counted; writing goes on when there
/// is room. Events and notes may come from different threads; stats() may be called from any, and waits for
/// no write. Everything else may take as long as the file system does: the daemon has a BackgroundLog around
/// it.
class LogWriter final : public TelemetrySink {
 public:
  /// Throws EnvironmentError with file and cause when the file cannot be made or another process writes it,
  /// std::runtime_error when it does not take its header.
  LogWriter(const std::filesystem::path& file, const LogHeader& header);
  /// Closes.
  ~LogWriter() override;
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  void OnEvent(const TelemetryEvent& event) noexcept override;
  void Note(const std::string& key, const std::string& text) noexcept;
  /// Where a log begins that does not begin at the start; before its first cycle.
  void State(const LogState& state) noexcept;
  /// These cycles, or notes, will not come: they were lost on the way here.
  void Lose(std::uint64_t cycles, std::uint64_t notes, const char* why) noexcept;
  /// Writes what is pending and the footer. Nothing is written afterwards.
  void Close() noexcept;
  /// Nothing more is written, not even the end. Does not wait for a write that is stuck.
  void Abandon() noexcept { abandoned_ = true; }

  [[nodiscard]] LogStats stats() const;

 private:
  void Append(std::string_view channel, std::string_view bytes, std::int64_t unix_us);
  [[nodiscard]] std::int64_t UnixTime_us(std::int64_t grid_time_ns) noexcept;
  bool WritePending() noexcept;
  void LosePending(const char* why) noexcept;
  void SetError(const char* why) noexcept;

  std::mutex mutex_;  // guards all but stats_, and is held while writing
  int fd_ = -1;
  std::atomic<bool> abandoned_{false};
  std::string pending_;
  std::uint64_t pending_cycles_ = 0;
  std::int64_t events_ = 0;
  std::int64_t batches_ = 0;
  std::int64_t good_size_ = 0;  ///< bytes of the file that are whole events
  std::int64_t good_events_ = 0;
  std::uint32_t checksum_ = 0;  ///< of the good bytes
  std::int64_t start_unix_us_;
  std::int64_t last_unix_us_;
  std::int64_t first_grid_time_ns_ = 0;
  bool any_event_ = false;
  mutable std::mutex stats_mutex_;  // is never held for long
  LogStats stats_;                  // changed with both locks only
};

}  // namespace contour
