#include "daemon/telemetry/telemetry_hub.h"

#include <algorithm>
#include <contour_lcm/drive_emergency.hpp>
#include <utility>

#include "drivers/cia301/emergency_table.h"
#include "drivers/lcm/cycle_messages.h"

namespace contour {

TelemetryHub::TelemetryHub(const TelemetryConfig& config, int cycle_us, std::vector<std::string> axis_names,
                           const std::optional<LogTarget>& log, std::chrono::milliseconds patience)
    : encoder_(config, cycle_us, axis_names),
      axis_names_(axis_names),
      patience_(2 * patience, std::chrono::microseconds(cycle_us)),
      health_(axis_names),
      emergencies_(axis_names.size()) {
  if (config.publish) {
    publisher_ = std::make_unique<BackgroundPublisher>(config.lcm_url, patience);
    sinks_.push_back(publisher_.get());
  }
  if (log) {
    BackgroundLog::Limits limits;
    limits.patience = patience;
    log_ = std::make_unique<BackgroundLog>(log->file, log->header, limits);
    sinks_.push_back(log_.get());
  }
}

void TelemetryHub::Consume(const CycleEntry& entry) {
  Observe(entry);
  if (flight_ != nullptr) flight_->OnCycle(entry);
  if (!sinks_.empty()) encoder_.Add(entry, sinks_);
  TellEmergencies();
}

// News are only touched by Consume's thread.
void TelemetryHub::TellEmergencies() {
  for (const ReceivedEmergency& e : emergencies_.news()) {
    const std::string& axis = axis_names_[e.axis];
    const std::string line = EmergencyLine(e, axis);
    Note(kEmergencyNote + axis, line);
    contour_lcm::drive_emergency m{};
    m.cycle = static_cast<std::int64_t>(e.cycle);
    m.grid_time_ns = e.grid_time_ns;
    m.axis = axis;
    m.error_code = e.emergency.error_code;
    m.error_register = e.emergency.error_register;
    std::copy(e.maker.begin(), e.maker.end(), m.maker);
    m.text = EmergencyText(e.emergency.error_code);
    m.reaction = Name(ReactionTo(e.emergency));
    const std::string bytes = Encode(m);
    for (TelemetrySink* sink : sinks_) sink->OnEvent({kEmergencyChannel, bytes, e.grid_time_ns, 0});
    const std::lock_guard lock(mutex_);
    emergency_lines_.push_back(line);
  }
}

std::vector<std::string> TelemetryHub::TakeEmergencyLines() {
  const std::lock_guard lock(mutex_);
  return std::exchange(emergency_lines_, {});
}

void TelemetryHub::Flush() { encoder_.Flush(sinks_); }

bool TelemetryHub::Close(std::chrono::steady_clock::time_point deadline) {
  Flush();
  bool all = log_ == nullptr || log_->Close(deadline);
  if (flight_ != nullptr) all = flight_->Finish(deadline) && all;
  if (publisher_ != nullptr) all = publisher_->Finish(deadline) && all;
  return all;
}

void TelemetryHub::Observe(const CycleEntry& entry) {
  {
    const std::lock_guard lock(mutex_);
    ++cycles_;
    record_ = entry.output.record;
    timing_ = entry.timing;
    skipped_grid_points_ += entry.timing.skipped_grid_points;
    health_.Add(entry);
    emergencies_.Add(entry);
    foreign_.Add(entry.input);
  }
  FeedClients(entry);
}

void TelemetryHub::FeedClients(const CycleEntry& entry) {
  std::vector<std::shared_ptr<RowFeed>> feeds;
  {
    const std::lock_guard lock(mutex_);
    for (const Client& client : clients_) feeds.push_back(client.feed);
  }
  for (const auto& feed : feeds) feed->Push(entry, patience_);
  patience_.EndCycle();
  const std::lock_guard lock(mutex_);
  for (Client& client : clients_) {
    const bool behind = client.feed->behind();
    if (behind && !client.behind)
      rows_message_ =
          "a client that collects rows does not keep up: rows are dropped, and counted for it, until it has";
    client.behind = behind;
  }
}

std::optional<std::string> TelemetryHub::TakeRowsMessage() {
  const std::lock_guard lock(mutex_);
  if (rows_message_.empty()) return std::nullopt;
  return std::exchange(rows_message_, {});
}

void TelemetryHub::Attach(std::shared_ptr<RowFeed> feed) {
  const std::lock_guard lock(mutex_);
  clients_.push_back({std::move(feed)});
}

void TelemetryHub::Detach(const std::shared_ptr<RowFeed>& feed) {
  feed->End();
  const std::lock_guard lock(mutex_);
  std::erase_if(clients_, [&](const Client& client) { return client.feed == feed; });
  if (const std::uint64_t lost = feed->lost(); lost != 0)
    rows_message_ = "a client that collected rows has ended; " + std::to_string(lost) + " were dropped";
}

void TelemetryHub::EndFeeds() {
  const std::lock_guard lock(mutex_);
  for (const Client& client : clients_) client.feed->End();
}

void TelemetryHub::WatchFeedback(std::vector<FeedbackSource> sources) {
  const std::lock_guard lock(mutex_);
  emergencies_.Watch(sources);
  health_.Watch(std::move(sources));
}

void TelemetryHub::WatchForeign(std::vector<BusParties> buses) {
  const std::lock_guard lock(mutex_);
  foreign_.Watch(std::move(buses));
}

void TelemetryHub::AddFlightRecorder(std::unique_ptr<FlightRecorder> recorder) {
  flight_ = std::move(recorder);
  sinks_.push_back(flight_.get());
}

void TelemetryHub::OnState(std::uint64_t cycle, std::string bytes) {
  if (flight_ != nullptr) flight_->OnState(cycle, std::move(bytes));
}

std::optional<std::string> TelemetryHub::TakeHealthMessage() {
  const std::lock_guard lock(mutex_);
  return health_.TakeMessage();
}

std::optional<std::string> TelemetryHub::TakeForeignMessage() {
  const std::lock_guard lock(mutex_);
  return foreign_.TakeMessage();
}

void TelemetryHub::Note(const std::string& key, const std::string& text) {
  if (log_ != nullptr) log_->Note(key, text);
  if (flight_ != nullptr) flight_->OnNote(key, text);
}

TelemetryHub::Snapshot TelemetryHub::snapshot() const {
  Snapshot s;
  {
    const std::lock_guard lock(mutex_);
    s.cycles = cycles_;
    s.record = record_;
    s.timing = timing_;
    s.skipped_grid_points = skipped_grid_points_;
    s.health = health_.summary();
    s.drive_errors = emergencies_.drives();
    s.foreign = foreign_.summary();
  }
  if (publisher_ != nullptr) s.publisher = publisher_->stats();
  if (log_ != nullptr) s.log = log_->stats();
  if (flight_ != nullptr) s.flight = flight_->stats();
  return s;
}

CycleRecord TelemetryHub::record() const {
  const std::lock_guard lock(mutex_);
  return record_;
}

}  // namespace contour
