#pragma once

#include <contour_lcm/cycle_batch.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/cycle_record.h"
#include "daemon/telemetry/event_file.h"
#include "daemon/telemetry/log_header.h"

namespace contour {

/// A log that cannot be read, or is damaged. what() is one line that begins with the file.
class LogError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  LogError(const std::string& what, std::uint64_t cycle) : std::runtime_error(what), damaged_cycle_(cycle) {}

  /// The cycle at which the file is damaged, where it is.
  [[nodiscard]] std::optional<std::uint64_t> damaged_cycle() const noexcept { return damaged_cycle_; }

 private:
  std::optional<std::uint64_t> damaged_cycle_;
};

/// Reads a log back, cycle by cycle, bit for bit what was written.
class LogReader {
 public:
  /// Throws LogError when there is no readable log of a known format.
  explicit LogReader(const std::filesystem::path& file);

  [[nodiscard]] const LogHeader& header() const noexcept { return header_; }

  /// The next cycle; false at the end. Throws LogError where the log is damaged.
  bool Next(CycleEntry& entry);

  /// What the log begins with when it does not begin at the start; known after the first Next().
  [[nodiscard]] const std::optional<LogState>& state() const noexcept { return state_; }
  /// Notes met so far.
  [[nodiscard]] const std::vector<LogNote>& notes() const noexcept { return notes_; }
  /// Cycles that ran and are not in the log, up to here: dropped on the way or lost to a full disk.
  [[nodiscard]] std::uint64_t missing_cycles() const noexcept { return missing_cycles_; }
  /// After the end: whether the log was closed properly. A log cut short by a crash or a kill is whole up to
  /// there.
  [[nodiscard]] bool complete() const noexcept { return complete_; }

 private:
  bool ReadBatch();
  void ReadHeader();
  void OnBatch(std::string_view bytes);
  void OnNote(std::string_view bytes);
  void OnState(std::string_view bytes);
  void OnFooter(std::string_view bytes, std::int64_t unix_us);
  [[noreturn]] void Fail(const std::string& what) const;
  [[noreturn]] void FailAt(std::uint64_t cycle, const std::string& what) const;

  std::string file_;
  std::optional<EventFile> events_;
  LogHeader header_;
  std::optional<LogState> state_;
  std::vector<LogNote> notes_;
  contour_lcm::cycle_batch batch_;
  std::size_t next_in_batch_ = 0;
  std::int64_t batches_ = 0;
  std::uint64_t cycles_ = 0;
  std::uint64_t last_cycle_ = 0;
  std::uint64_t missing_cycles_ = 0;
  bool complete_ = false;
};

}  // namespace contour
