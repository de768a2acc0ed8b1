#include "drivers/cia402/drive_patrol.h"

#include <algorithm>
#include <utility>

#include "drivers/cia301/messages.h"

namespace contour {
namespace {

constexpr std::uint16_t kModeDisplay = 0x6061;
constexpr std::uint16_t kErrorField = 0x1003;
constexpr std::uint32_t kMostErrors = 8;  // the newest ones; the field may have 254
constexpr std::uint64_t kQuietPeriods = 10;

}  // namespace

DrivePatrol::DrivePatrol(std::vector<PatrolledDrive> drives, std::uint32_t cycle_us)
    : drives_(std::move(drives)),
      states_(drives_.size()),
      gap_(std::max<std::uint64_t>(1, (kPatrolGap_us + cycle_us - 1) / cycle_us)),
      period_(std::max<std::uint64_t>(1, kPatrolPeriod_us / cycle_us)) {}

void DrivePatrol::Start() noexcept {
  running_ = true;
  transfer_.Cancel();
  free_at_ = now_ + gap_;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    states_[i] = {};
    // In turn, not all at once.
    states_[i].mode_at = now_ + period_ * (i + 1) / states_.size();
    ReadErrors(i);
  }
}

void DrivePatrol::Stop() noexcept {
  running_ = false;
  transfer_.Cancel();
}

void DrivePatrol::ReadErrors(std::size_t drive) noexcept {
  states_[drive].errors_due = true;
  states_[drive].next_error = 0;
  look_at_ = 0;
}

void DrivePatrol::OnFrame(const CanFrame& frame) noexcept {
  if (!running_ || (frame.id & 0x780) != cob::kSdoReply || transfer_.OnFrame(frame)) return;
  // Not ours: a service tool talks to this drive, and ours would get between its segments.
  for (std::size_t i = 0; i < drives_.size(); ++i)
    if (frame.id == cob::kSdoReply + drives_[i].node_id)
      states_[i].quiet_until = now_ + kQuietPeriods * period_;
}

void DrivePatrol::Take() noexcept {
  State& s = states_[asked_];
  const bool done = transfer_.state() == SdoTransfer::State::kDone;
  if (!errors_) {
    if (done) s.mode_changed = (transfer_.value() & 0xFF) != drives_[asked_].mode;
    return;
  }
  if (sub_ != s.next_error) return;  // begun anew meanwhile
  if (done && sub_ == 0)
    s.errors = static_cast<std::uint8_t>(std::min(transfer_.value() & 0xFF, kMostErrors));
  s.errors_due = done && s.next_error < s.errors;
  ++s.next_error;
}

bool DrivePatrol::Due(std::size_t drive) const noexcept {
  const State& s = states_[drive];
  return now_ >= s.quiet_until && (s.errors_due || now_ >= s.mode_at);
}

void DrivePatrol::Step(std::uint64_t elapsed_cycles, BringUp::Frames& out) noexcept {
  now_ += elapsed_cycles;
  if (!running_ || drives_.empty()) return;
  using enum SdoTransfer::State;
  if (transfer_.state() == kWaiting) {
    transfer_.Elapse(elapsed_cycles);
    if (transfer_.state() == kWaiting) return;
  }
  if (transfer_.state() != kIdle) {
    const bool foreign = transfer_.state() == kSegmented || transfer_.state() == kUnexpected;
    if (foreign)
      out.push_back(SdoAbortFrame(drives_[asked_].node_id, errors_ ? kErrorField : kModeDisplay, sub_,
                                  transfer_.abort_code()));
    Take();
    transfer_.Cancel();
    if (foreign) return;
  }
  if (now_ < free_at_ || now_ < look_at_) return;
  // The mode goes first: a supervisor waits for it.
  for (const bool errors : {false, true}) {
    for (std::size_t i = 0; i < drives_.size(); ++i) {
      const std::size_t drive = (asked_ + 1 + i) % drives_.size();
      if (Due(drive) && (errors || now_ >= states_[drive].mode_at)) return Ask(drive, errors, out);
    }
  }
  look_at_ = ~std::uint64_t{0};
  for (const State& s : states_)
    look_at_ = std::min(look_at_, std::max(s.quiet_until, s.errors_due ? now_ + 1 : s.mode_at));
}

void DrivePatrol::Ask(std::size_t drive, bool errors, BringUp::Frames& out) noexcept {
  asked_ = drive;
  errors_ = errors;
  free_at_ = now_ + gap_;
  State& s = states_[drive];
  if (!errors) s.mode_at = now_ + period_;
  sub_ = errors ? s.next_error : std::uint8_t{0};
  transfer_.StartRead(drives_[drive].node_id, errors ? kErrorField : kModeDisplay, sub_,
                      drives_[drive].sdo_cycles);
  out.push_back(transfer_.request());
}

}  // namespace contour
