#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/cycle_record.h"
#include "daemon/lanes/slow_lane.h"
#include "daemon/telemetry/log_header.h"
#include "drivers/lcm/telemetry_encoder.h"

namespace contour {

/// What became of the last flight record.
struct FlightRecordStats {
  bool enabled = false;
  std::string directory;
  std::string file;  ///< newest record; empty: none yet
  std::uint64_t first_cycle = 0;
  std::uint64_t last_cycle = 0;
  std::string reason;         ///< of the fault
  std::uint64_t written = 0;  ///< records since the start
  std::string last_error;     ///< empty while nothing has failed
};

/// Keeps the last seconds of cycles in memory, as the log would have them, and writes them to a file of their
/// own when a fault stops the machine. The file begins with a copy of the cycle's state, so that it can be
/// replayed as a whole log can. Belongs to the pump thread; stats() may be called from any. The file is
/// written by a thread of the recorder's own: a disk that takes nothing holds nobody up, and costs a record.
class FlightRecorder final : public TelemetrySink {
 public:
  struct Config {
    std::filesystem::path directory;
    std::uint64_t window_cycles = 10'000;  ///< at least so many before the fault
    std::uint64_t after_cycles = 100;      ///< and so many behind it
    std::size_t keep_files = 8;            ///< the oldest of more than these are removed
  };
  FlightRecorder(Config config, LogHeader header);

  /// A message that is on its way to LCM and log.
  void OnEvent(const TelemetryEvent& event) noexcept override;
  /// A copy of the cycle's state.
  void OnState(std::uint64_t cycle, std::string bytes);
  /// What the log is told besides the cycles; changes of tuning belong to the record.
  void OnNote(const std::string& key, const std::string& text);
  /// Every cycle, after its event if it completed one. Has the record written when it is time.
  void OnCycle(const CycleEntry& entry);
  /// Writes what a fault has asked for and what is waiting for the cycles behind it. False when the disk did
  /// not take it in time.
  bool Finish(std::chrono::steady_clock::time_point deadline);

  [[nodiscard]] FlightRecordStats stats() const;

 private:
  struct Batch {
    std::uint64_t first = 0, last = 0;
    std::int64_t grid_time_ns = 0;
    int cycles = 0;
    std::shared_ptr<const std::string> bytes;  ///< a record on its way to the disk has them, too
  };
  /// A record as it goes to the disk, and what became of those before.
  struct Job;
  struct Written {
    mutable std::mutex mutex;  // guards stats
    FlightRecordStats stats;
  };

  /// Changed gains, each KEY=VALUE a line, from a cycle on; 0: not taken yet.
  struct Tuning {
    std::string key, text;
    std::uint64_t cycle = 0;
  };

  void Forget();
  void HandOver();
  static void Write(const Job& job, Written& written);
  [[nodiscard]] std::filesystem::path FileName() const;
  static void RemoveOldest(const Config& config);

  Config config_;
  LogHeader header_;
  std::deque<Batch> batches_;
  std::deque<LogState> states_;  ///< none: the record goes back to the start
  bool from_start_ = true;
  std::vector<Tuning> tunings_;
  std::uint64_t newest_cycle_ = 0;
  std::uint64_t fault_cycle_ = 0;  ///< 0: nothing to write
  Reason fault_reason_ = Reason::kNone;
  MachineState last_state_ = MachineState::kOff;
  std::mutex mutex_;  // guards tunings_
  std::shared_ptr<Written> written_ = std::make_shared<Written>();
  SlowLane lane_;
};

/// Where flight records go unless the machine file says: the service's log or state directory, else the
/// user's state directory; empty when there is none of them.
std::filesystem::path DefaultFlightDirectory();

}  // namespace contour
