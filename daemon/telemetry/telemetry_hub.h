#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/cycle_record.h"
#include "daemon/telemetry/background_log.h"
#include "daemon/telemetry/background_publisher.h"
#include "daemon/telemetry/cycle_health.h"
#include "daemon/telemetry/emergency_history.h"
#include "daemon/telemetry/flight_recorder.h"
#include "daemon/telemetry/foreign_traffic.h"
#include "daemon/telemetry/row_feed.h"
#include "drivers/lcm/telemetry_config.h"
#include "drivers/lcm/telemetry_encoder.h"

namespace contour {

/// Where every cycle goes once it has left the real-time side: LCM, the log, the clients that collect rows,
/// and what status shows. Consume() and Flush() belong to the pump thread; the rest may be called from any.
class TelemetryHub {
 public:
  struct LogTarget {
    std::filesystem::path file;
    LogHeader header;
  };

  /// Throws std::runtime_error when the log cannot be made. Whether LCM works shows later, in stats.
  /// `patience`: how long Consume() waits for a disk or a network that has fallen behind (see SlowLane), and
  /// twice that for all clients together (see Patience), so for the first as long; 0 where time does not
  /// wait.
  TelemetryHub(const TelemetryConfig& config, int cycle_us, std::vector<std::string> axis_names,
               const std::optional<LogTarget>& log,
               std::chrono::milliseconds patience = std::chrono::milliseconds(0));

  void Consume(const CycleEntry& entry);
  /// Sends what is not a full batch yet; for when no cycles come.
  void Flush();
  /// Flush, and the end of the log. Consume() may not be called afterwards. False when disk or network did
  /// not take everything by then; snapshot() has how much of the log is missing.
  bool Close(std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::now() +
                                                              std::chrono::seconds(60));

  void Attach(std::shared_ptr<RowFeed> feed);
  void Detach(const std::shared_ptr<RowFeed>& feed);
  /// At the end of the daemon: no row is waited for any more.
  void EndFeeds();

  /// Before the first cycle: whose feedback to watch, and a recorder of the last seconds.
  void WatchFeedback(std::vector<FeedbackSource> sources);
  void WatchForeign(std::vector<BusParties> buses);
  void AddFlightRecorder(std::unique_ptr<FlightRecorder> recorder);
  /// A copy of the cycle's state, for the flight recorder.
  void OnState(std::uint64_t cycle, std::string bytes);
  /// A line on late cycles and missing feedback, when there is something new to say.
  std::optional<std::string> TakeHealthMessage();
  /// A line for each emergency message of a drive since the last call.
  std::vector<std::string> TakeEmergencyLines();
  /// A line on a client that does not keep up, or has ended, with the rows that it lost.
  std::optional<std::string> TakeRowsMessage();
  /// A line on others who send on the buses.
  std::optional<std::string> TakeForeignMessage();

  /// Into the log, when there is one.
  void Note(const std::string& key, const std::string& text);

  struct Snapshot {
    std::uint64_t cycles = 0;  ///< consumed
    CycleRecord record;        ///< of the newest one
    CycleTiming timing;
    std::uint64_t skipped_grid_points = 0;
    CycleHealth::Summary health;
    std::vector<DriveErrors> drive_errors;  ///< one per axis
    PublisherStats publisher;
    LogStats log;
    FlightRecordStats flight;
    std::vector<ForeignTraffic::OnBus> foreign;
  };
  [[nodiscard]] Snapshot snapshot() const;
  [[nodiscard]] LogStats log() const { return log_ ? log_->stats() : LogStats{}; }
  [[nodiscard]] FlightRecordStats flight() const { return flight_ ? flight_->stats() : FlightRecordStats{}; }
  /// Newest record alone.
  [[nodiscard]] CycleRecord record() const;

 private:
  void Observe(const CycleEntry& entry);
  void FeedClients(const CycleEntry& entry);
  void TellEmergencies();

  TelemetryEncoder encoder_;
  const std::vector<std::string> axis_names_;
  Patience patience_;  ///< with clients
  std::unique_ptr<BackgroundPublisher> publisher_;
  std::unique_ptr<BackgroundLog> log_;
  std::unique_ptr<FlightRecorder> flight_;
  std::vector<TelemetrySink*> sinks_;

  mutable std::mutex mutex_;  // guards all below
  struct Client {
    std::shared_ptr<RowFeed> feed;
    bool behind = false;  ///< as was said
  };
  std::vector<Client> clients_;
  std::string rows_message_;
  std::uint64_t cycles_ = 0;
  std::uint64_t skipped_grid_points_ = 0;
  CycleRecord record_;
  CycleTiming timing_;
  CycleHealth health_;
  EmergencyHistory emergencies_;
  std::vector<std::string> emergency_lines_;
  ForeignTraffic foreign_;
};

}  // namespace contour
