#include "daemon/telemetry/flight_recorder.h"

#include <algorithm>
#include <chrono>
#include <contour_lcm/cycle_batch.hpp>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "daemon/telemetry/log_writer.h"
#include "daemon/telemetry/tuning_note.h"
#include "drivers/lcm/batch_checksums.h"
#include "drivers/lcm/cycle_messages.h"

namespace contour {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPrefix = "fault-";
constexpr const char* kSuffix = ".lcmlog";
/// Each holds the window in memory until it is on the disk. The lane counts them as bytes.
constexpr std::size_t kRecordsUnderWay = 2;

std::int64_t UnixTime_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

/// A batch without the cycles up to and with `cycle`.
std::string After(const std::string& bytes, std::uint64_t cycle, int& count) {
  contour_lcm::cycle_batch batch;
  if (!DecodeChecked(bytes, batch)) return bytes;
  std::erase_if(batch.entries, [&](const contour_lcm::cycle_entry& e) {
    return static_cast<std::uint64_t>(e.input.cycle) <= cycle;
  });
  count = static_cast<int>(batch.entries.size());
  return EncodeBatch(batch);
}

fs::path Variable(const char* name) {
  const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): read at start-up, before threads
  const std::string text = value != nullptr ? value : "";
  return text.substr(0, text.find(':'));  // systemd may list several, the service's own first
}

}  // namespace

struct FlightRecorder::Job {
  Config config;
  fs::path file;
  LogHeader header;
  std::optional<LogState> state;
  std::vector<Tuning> tunings;
  std::string fault;
  Reason reason = Reason::kNone;
  std::deque<Batch> batches;
};

FlightRecorder::FlightRecorder(Config config, LogHeader header)
    : config_(std::move(config)),
      header_(std::move(header)),
      lane_("contour-flight", {kRecordsUnderWay, {}}) {
  written_->stats.enabled = true;
  written_->stats.directory = config_.directory.string();
}

void FlightRecorder::OnEvent(const TelemetryEvent& event) noexcept {
  if (event.cycles == 0) return;
  try {
    // Cycles arrive here before their batch does: it ends with the newest one.
    Batch batch;
    batch.first = batches_.empty() ? 1 : batches_.back().last + 1;
    batch.last = newest_cycle_;
    batch.grid_time_ns = event.grid_time_ns;
    batch.cycles = event.cycles;
    batch.bytes = std::make_shared<const std::string>(event.bytes);
    batches_.push_back(std::move(batch));
    Forget();
  } catch (const std::exception& e) {
    const std::lock_guard lock(written_->mutex);
    written_->stats.last_error = e.what();
  }
}

void FlightRecorder::OnState(std::uint64_t cycle, std::string bytes) {
  states_.push_back({cycle, header_.build, std::move(bytes)});
}

void FlightRecorder::OnNote(const std::string& key, const std::string& text) {
  const std::lock_guard lock(mutex_);
  if (key.starts_with(kTuningNote)) tunings_.push_back({key, text, 0});
}

void FlightRecorder::Forget() {
  // A record begins with the youngest state that still leaves the whole window.
  const std::uint64_t begin =
      newest_cycle_ > config_.window_cycles ? newest_cycle_ - config_.window_cycles : 0;
  if (fault_cycle_ != 0) return;  // what is to be written stays
  while (states_.size() > 1 && states_[1].cycle <= begin) states_.pop_front();
  if (states_.empty() || states_.front().cycle > begin) return;
  from_start_ = false;
  while (!batches_.empty() && batches_.front().last <= states_.front().cycle) batches_.pop_front();
}

void FlightRecorder::OnCycle(const CycleEntry& entry) {
  const CycleRecord& record = entry.output.record;
  newest_cycle_ = record.cycle;
  if (entry.input.request.kind == RequestKind::kTune) {
    const std::lock_guard lock(mutex_);
    for (Tuning& t : tunings_)
      if (t.key == kTuningNote + std::to_string(entry.input.request.program_id)) t.cycle = record.cycle;
  }
  const bool faulted = record.state == MachineState::kFaulted && last_state_ != MachineState::kFaulted;
  last_state_ = record.state;
  // A first start that fails has its own message and nothing that moved.
  if (faulted && fault_cycle_ == 0 && record.reason != Reason::kBringUpFailed) {
    fault_cycle_ = record.cycle;
    fault_reason_ = record.reason;
  }
  const bool enough = !batches_.empty() && batches_.back().last >= fault_cycle_ + config_.after_cycles;
  if (fault_cycle_ != 0 && enough) HandOver();
}

bool FlightRecorder::Finish(std::chrono::steady_clock::time_point deadline) {
  if (fault_cycle_ != 0) HandOver();
  return lane_.Finish(deadline);
}

void FlightRecorder::HandOver() {
  try {
    auto job = std::make_shared<Job>();
    job->config = config_;
    job->file = FileName();
    job->header = header_;
    job->batches = batches_;
    job->reason = fault_reason_;
    job->fault = std::string(Name(fault_reason_)) + " at cycle " + std::to_string(fault_cycle_);
    const std::int64_t length_ns =
        batches_.empty() ? 0 : batches_.back().grid_time_ns - batches_.front().grid_time_ns;
    job->header.start_unix_us = UnixTime_us() - length_ns / 1000;
    if (!from_start_ && !states_.empty()) job->state = states_.front();
    const std::uint64_t after = job->state ? job->state->cycle : 0;
    {
      const std::lock_guard lock(mutex_);
      for (const Tuning& t : tunings_) {
        if (t.cycle == 0 || t.cycle > after) {
          job->tunings.push_back(t);
        } else {
          // The state at the beginning was reached with these.
          for (std::string& change : Lines(t.text)) job->header.overrides.push_back(std::move(change));
        }
      }
    }
    if (!lane_.Post(1, [job, written = written_] { Write(*job, *written); }))
      throw std::runtime_error("the disk has not taken the records before this one");
  } catch (const std::exception& e) {
    const std::lock_guard lock(written_->mutex);
    written_->stats.last_error = e.what();
  }
  fault_cycle_ = 0;
  Forget();
}

// In the lane's thread.
void FlightRecorder::Write(const Job& job, Written& written) {
  FlightRecordStats stats;
  {
    const std::lock_guard lock(written.mutex);
    stats = written.stats;
  }
  const std::uint64_t after = job.state ? job.state->cycle : 0;
  try {
    fs::create_directories(job.config.directory);
    LogWriter writer(job.file, job.header);
    if (job.state) writer.State(*job.state);
    for (const Tuning& t : job.tunings) writer.Note(t.key, t.text);
    writer.Note("fault", job.fault);
    for (const Batch& batch : job.batches) {
      int cycles = batch.cycles;
      const std::string bytes = batch.first <= after ? After(*batch.bytes, after, cycles) : *batch.bytes;
      if (cycles > 0) writer.OnEvent({kCyclesChannel, bytes, batch.grid_time_ns, cycles});
    }
    writer.Close();
    stats.file = job.file.string();
    stats.first_cycle = after + 1;
    stats.last_cycle = job.batches.empty() ? after : job.batches.back().last;
    stats.reason = Name(job.reason);
    stats.last_error = writer.stats().last_error;
    ++stats.written;
    RemoveOldest(job.config);
  } catch (const std::exception& e) {
    stats.last_error = e.what();
  }
  const std::lock_guard lock(written.mutex);
  written.stats = stats;
}

fs::path FlightRecorder::FileName() const {
  const auto seconds = static_cast<std::time_t>(UnixTime_us() / 1'000'000);
  std::tm utc{};
  ::gmtime_r(&seconds, &utc);
  char time[32];
  std::strftime(time, sizeof time, "%Y%m%dT%H%M%SZ", &utc);
  // The cycle makes two faults of one second two files.
  return config_.directory / (kPrefix + std::string(time) + "-" + std::to_string(fault_cycle_) + "-" +
                              std::string(Name(fault_reason_)) + kSuffix);
}

void FlightRecorder::RemoveOldest(const Config& config) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(config.directory)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(kPrefix) && name.ends_with(kSuffix)) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  while (files.size() > config.keep_files) {
    fs::remove(files.front());
    files.erase(files.begin());
  }
}

FlightRecordStats FlightRecorder::stats() const {
  const std::lock_guard lock(written_->mutex);
  return written_->stats;
}

fs::path DefaultFlightDirectory() {
  for (const char* service : {"LOGS_DIRECTORY", "STATE_DIRECTORY"})
    if (const fs::path own = Variable(service); !own.empty()) return own;
  if (const fs::path user = Variable("XDG_STATE_HOME"); !user.empty()) return user / "contourd";
  if (const fs::path home = Variable("HOME"); !home.empty()) return home / ".local/state/contourd";
  return {};
}

}  // namespace contour
