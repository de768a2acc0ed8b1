#include "daemon/halt_keeper.h"

#include <spdlog/spdlog.h>

#include <cmath>
#include <utility>

namespace contour {
namespace {

/// A program's time that differs by less is the same instant: of a cycle, which is no shorter than 250 us.
constexpr double kSameTime_s = 1e-7;

}  // namespace

void HaltKeeper::Begin(std::uint32_t program_id, std::vector<ProgramHalt> halts) {
  Leave();
  program_id_ = program_id;
  halts_ = std::move(halts);
  done_ = 0;
}

void HaltKeeper::Leave() {
  at_ = 0;
  release_ = false;
  Tell();
}

const GcodeEvent* HaltKeeper::Now() const {
  if (at_ == 0 || at_ <= done_) return nullptr;
  const ProgramHalt& halt = halts_[at_ - 1];
  return event_ < halt.events.size() ? &halt.events[event_] : nullptr;
}

void HaltKeeper::Consume(const CycleRecord& record, const PacedPath::Halt& ahead) {
  if (outputs_ != nullptr) outputs_->Confirm();
  const bool runs = record.state == MachineState::kRunning && record.program_id == program_id_;
  // Stopping, ended, faulted: whatever it is, what the program switched on goes off.
  if (runs_ && !runs && outputs_ != nullptr) outputs_->Off();
  runs_ = runs;
  if (record.program_id != program_id_) return;
  const bool stands = record.state == MachineState::kRunning && record.pace == 0.0 && ahead.number > 0 &&
                      ahead.number <= halts_.size() &&
                      std::abs(record.path_time_s - ahead.time_s) <= kSameTime_s;
  if (!stands) {
    if (at_ != 0) Leave();
    return;
  }
  if (ahead.number == at_) return;
  at_ = ahead.number;
  event_ = 0;
  asked_ = false;
  if (at_ <= done_) {
    release_ = true;
    return;
  }
  Tell();
}

void HaltKeeper::Work() {
  while (const GcodeEvent* event = Now()) {
    if (outputs_ != nullptr && outputs_->Listens(*event)) {
      if (!asked_) outputs_->Do(*event);
      asked_ = true;
      if (!outputs_->Done()) return;
    }
    if (event->waits) return;
    Step();
  }
}

bool HaltKeeper::TakeLoss() { return outputs_ != nullptr && outputs_->TakeLoss() && runs_; }

bool HaltKeeper::holding() const {
  const GcodeEvent* event = Now();
  return event != nullptr && event->waits && (!asked_ || outputs_->Done());
}

void HaltKeeper::Resume() {
  if (!holding()) return;
  if (outputs_ != nullptr && asked_) outputs_->Over(*Now());
  Step();
}

void HaltKeeper::Step() {
  ++event_;
  asked_ = false;
  if (Now() == nullptr) {
    done_ = at_;
    release_ = true;
  }
  Tell();
}

bool HaltKeeper::TakeRelease() { return std::exchange(release_, false); }

void HaltKeeper::Tell() {
  const GcodeEvent* event = Now();
  std::optional<HaltStatus> status;
  if (event != nullptr) {
    status = HaltStatus{event->line, WordOf(*event), event->waits, ++waits_};
    spdlog::info("{} at line {}: {}", event->waits ? "holding" : "switching", event->line, status->word);
  }
  const std::lock_guard lock(mutex_);
  status_ = std::move(status);
}

std::optional<HaltStatus> HaltKeeper::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

}  // namespace contour
