#include "daemon/pump.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <cmath>
#include <utility>

#include "daemon/reason_text.h"
#include "drivers/cia301/bring_up_text.h"

namespace contour {
namespace {

constexpr std::chrono::nanoseconds kPeriod = std::chrono::milliseconds(2);
/// A cycle of real time is not older than this when it comes out of the queue.
constexpr std::chrono::nanoseconds kFresh = std::chrono::milliseconds(100);

bool Given(MachineState s) {
  return s == MachineState::kFaulted || s == MachineState::kIdle || s == MachineState::kStopping;
}

}  // namespace

Pump::Pump(TelemetryQueue& queue, CommandMailbox& mailbox, TelemetryHub& hub, double period_s,
           std::vector<std::string> axis_names, std::vector<std::string> bus_names)
    : queue_(queue),
      mailbox_(mailbox),
      hub_(hub),
      axis_names_(std::move(axis_names)),
      bus_names_(std::move(bus_names)),
      feeder_(mailbox),
      period_s_(period_s) {}

Pump::~Pump() { Finish(); }

void Pump::Start() {
  thread_ = std::thread(&Pump::Work, this);
  planner_.Start();
}

void Pump::Finish() {
  finish_ = true;
  planner_.Finish();
  if (thread_.joinable()) thread_.join();
}

void Pump::Supply(std::unique_ptr<PathGenerator> generator, const PacedPath::Options& options,
                  std::vector<ProgramHalt> halts) {
  const std::scoped_lock lock(mutex_);
  next_ = std::move(generator);
  next_options_ = options;
  next_options_.halts = !halts.empty();
  next_halts_ = std::move(halts);
  pace_.reset();
  abandon_ = false;
  feeder_.Announce();
}

void Pump::SetPace(double rate, bool resume) {
  const std::scoped_lock lock(mutex_);
  pace_ = {rate, resume || (pace_ && pace_->resume)};
}

void Pump::Abandon() {
  const std::scoped_lock lock(mutex_);
  next_.reset();
  abandon_ = true;
}

bool Pump::AwaitShown(std::uint64_t cycle, std::chrono::milliseconds time,
                      const std::stop_token& unwanted) const {
  const auto deadline = std::chrono::steady_clock::now() + time;
  while (shown_cycle_.load(std::memory_order_acquire) < cycle) {
    if (unwanted.stop_requested() || std::chrono::steady_clock::now() >= deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

void Pump::Work() {
  while (!finish_) {
    Drain();
    Feed();
    std::this_thread::sleep_until(NextRound());
  }
  Drain();
  hub_.Flush();
}

// In the middle between two grid points. Packets that are on their way through the kernel when the cycle
// wakes up hold its own frames back: on PREEMPT_RT one lock per processor guards the network's soft
// interrupts.
std::chrono::steady_clock::time_point Pump::NextRound() const {
  const auto now = std::chrono::steady_clock::now();
  const std::chrono::nanoseconds age = now.time_since_epoch() - last_grid_time_;
  // In lock-step the grid is not one of the clock.
  if (age < std::chrono::nanoseconds::zero() || age > kFresh) return now + kPeriod;
  const auto period = std::chrono::nanoseconds(std::llround(period_s_ * 1e9));
  const auto grid_points = (age + kPeriod) / period;
  return std::chrono::steady_clock::time_point(last_grid_time_ + grid_points * period + period / 2);
}

void Pump::Drain() {
  while (CycleEntry* entry = queue_.Front()) {
    // First, so that who learns from a program knows of its end when operators do.
    if (show_cycle_) show_cycle_(entry->output.record);
    shown_cycle_.store(entry->output.record.cycle, std::memory_order_release);
    hub_.Consume(*entry);
    last_grid_time_ = std::chrono::nanoseconds(entry->output.record.grid_time_ns);
    Report(entry->output.record);
    ReportReferences(entry->output.record);
    MeasureMotion(entry->output.record);
    tally_.Consume(entry->output.record);
    halts_.Consume(entry->output.record, feeder_.halt());
    queue_.Release();
  }
  if (snapshots_ != nullptr) {
    while (const StateSnapshots::Snapshot* snapshot = snapshots_->Front()) {
      hub_.OnState(snapshot->cycle,
                   {reinterpret_cast<const char*>(snapshot->bytes.data()), snapshot->bytes.size()});
      snapshots_->Release();
    }
  }
  for (const std::string& line : hub_.TakeEmergencyLines()) spdlog::warn("drive of {}", line);
  if (const auto message = hub_.TakeHealthMessage()) spdlog::warn("{}", *message);
  if (const auto message = hub_.TakeForeignMessage()) spdlog::warn("{}", *message);
  if (const auto message = hub_.TakeRowsMessage()) spdlog::warn("{}", *message);
  ReportFlight();
  ReportLog();
  if (report_motion_) report_motion_(travel_m_, static_cast<double>(moving_cycles_) * period_s_);
  if (also_drain_) also_drain_();
  if (const std::uint64_t dropped = queue_.dropped(); dropped != reported_drops_) {
    spdlog::warn(
        "{} cycles did not fit into the telemetry queue and are missing in log and telemetry ({} in all)",
        dropped - reported_drops_, dropped);
    reported_drops_ = dropped;
  }
}

void Pump::ReportFlight() {
  const FlightRecordStats flight = hub_.flight();
  if (flight.file != reported_flight_) {
    reported_flight_ = flight.file;
    spdlog::warn("cycles {} to {} are in {}: `contour replay` computes them again", flight.first_cycle,
                 flight.last_cycle, flight.file);
  }
  if (flight.last_error != reported_flight_error_) {
    reported_flight_error_ = flight.last_error;
    if (!flight.last_error.empty()) spdlog::warn("no flight record: {}", flight.last_error);
  }
}

void Pump::ReportLog() {
  const LogStats log = hub_.log();
  if (log.lost_cycles == reported_log_losses_) return;
  if (reported_log_losses_ == 0)
    spdlog::warn("the log {} loses cycles: {}. The machine runs on; status counts them", log.file,
                 log.last_error);
  reported_log_losses_ = log.lost_cycles;
}

void Pump::ReportReferences(const CycleRecord& record) {
  if (references_.size() != record.axes.size()) references_.resize(record.axes.size());
  for (std::size_t i = 0; i < record.axes.size(); ++i) {
    const ReferenceState now = record.axes[i].reference_state;
    if (references_[i] == now) continue;
    references_[i] = now;
    const std::string axis = i < axis_names_.size() ? axis_names_[i] : "?";
    if (now == ReferenceState::kLost)
      spdlog::warn(
          "axis {} does not know any more where it is: programs are refused until it is told (contour "
          "reference {}=MM)",
          axis, axis);
    else if (now == ReferenceState::kNeverTold)
      spdlog::info(
          "axis {} was not told yet where it is: programs begin where it stands and keep within "
          "limits.unreferenced_travel_mm",
          axis);
    else
      spdlog::info("axis {} knows where it is", axis);
  }
}

void Pump::MeasureMotion(const CycleRecord& record) {
  const bool moving = record.state == MachineState::kRunning || record.state == MachineState::kStopping;
  if (moving && last_position_m_.size() == record.axes.size()) {
    ++moving_cycles_;
    for (std::size_t i = 0; i < record.axes.size(); ++i)
      travel_m_ += std::abs(record.axes[i].position_m - last_position_m_[i]);
  }
  last_position_m_.clear();
  for (const AxisRecord& a : record.axes) last_position_m_.push_back(a.position_m);
}

void Pump::Feed() {
  {
    const std::scoped_lock lock(mutex_);
    if (abandon_) {
      feeder_.Abandon();
      abandon_ = false;
    }
    if (next_) {
      halts_.Begin(next_->program_id(), std::move(next_halts_));
      feeder_.Begin(std::move(next_), next_options_);
      failed_ = false;
    }
    if (pace_) {
      // Where the program waits for the operator, that is what goes on, and the path with it when all is
      // done.
      const bool ends_wait = pace_->resume && halts_.holding();
      feeder_.SetPace(pace_->rate, pace_->resume && !halts_.waiting());
      if (ends_wait) halts_.Resume();
    }
    pace_.reset();
  }
  halts_.Work();
  if (halts_.TakeRelease()) feeder_.Release();
  if (halts_.TakeLoss()) {
    spdlog::error("outputs of the program went off: no cycle was seen for too long; the program is stopped");
    mailbox_.PostStop();
  }
  feeder_.Feed();
  StopWhatFailed();
  ReportPlanning();
}

void Pump::StopWhatFailed() {
  const std::string failure = feeder_.failure();
  if (!failure.empty() && !failed_) {
    spdlog::error("{}; the program is stopped on its path", failure);
    mailbox_.PostStop();
  }
  failed_ = !failure.empty();
}

void Pump::ReportPlanning() {
  const bool waits = feeder_.waits_for_plan();
  if (waits == waited_for_plan_) return;
  waited_for_plan_ = waits;
  if (waits)
    spdlog::warn("planning does not keep up: the program slows down, to rest on its path if need be");
  else
    spdlog::info("planning keeps up again");
}

void Pump::Report(const CycleRecord& record) {
  if (record.state == last_state_ && record.reason == last_reason_) return;
  // A program that was broken off needs no more points.
  if (Given(record.state) && last_state_ == MachineState::kRunning) feeder_.Abandon();
  const std::string text = record.reason == Reason::kBringUpFailed
                               ? BringUpText(record.bring_up, axis_names_)
                               : ReasonText(record, axis_names_, bus_names_);
  const auto level = IsFault(record.reason) && record.state == MachineState::kFaulted ? spdlog::level::err
                                                                                      : spdlog::level::info;
  const std::string why =
      text.empty() ? std::string() : ", " + std::string(Name(record.reason)) + ": " + text;
  spdlog::log(level, "{} -> {}{} (cycle {})", Name(last_state_), Name(record.state), why, record.cycle);
  last_state_ = record.state;
  last_reason_ = record.reason;
}

}  // namespace contour
