#include "drivers/cia301/bring_up.h"

#include <algorithm>
#include <utility>

namespace contour {
namespace {

bool Absent(std::uint32_t abort_code) noexcept {
  return abort_code == sdo_abort::kNoObject || abort_code == sdo_abort::kNoSubIndex;
}

bool CannotBeWritten(std::uint32_t abort_code) noexcept {
  return abort_code == sdo_abort::kReadOnly || abort_code == sdo_abort::kUnsupportedAccess;
}

bool Tolerated(Tolerate tolerate, std::uint32_t abort_code) noexcept {
  const bool absent = Absent(abort_code);
  const bool read_only = CannotBeWritten(abort_code);
  switch (tolerate) {
    case Tolerate::kNothing:
      return false;
    case Tolerate::kAbsent:
      return absent;
    case Tolerate::kReadOnly:
      return absent || read_only;
    case Tolerate::kAnyAbort:
      return true;
  }
  return false;
}

/// A transfer that collides with a service tool's is begun anew so often.
constexpr std::uint8_t kMaxRetries = 3;

std::uint32_t Distance(std::uint32_t a, std::uint32_t b) noexcept { return a > b ? a - b : b - a; }

}  // namespace

BringUp::BringUp(std::vector<BringUpNode> nodes, std::uint32_t cycle_us, const BringUpBus& bus)
    : nodes_(std::move(nodes)),
      states_(nodes_.size()),
      cycle_us_(cycle_us),
      watch_(bus.master_node_id),
      bus_(bus) {
  for (const BringUpNode& n : nodes_) watch_.Add(n.node_id);
}

void BringUp::Start() noexcept {
  std::fill(states_.begin(), states_.end(), NodeState{});
  transfer_.Cancel();
  status_ = {};
  node_ = 0;
  step_ = 0;
  waited_ = 0;
  phase_ = nodes_.empty()                 ? BringUpPhase::kOperational
           : quiet_ >= bus_.listen_cycles ? BringUpPhase::kReset
                                          : BringUpPhase::kListen;
  ShowNode(0);
}

void BringUp::BusDown() noexcept {
  quiet_ = 0;
  if (running()) Fail(BringUpError::kBusDown, 0, 0);
}

bool BringUp::configuring() const noexcept {
  return phase_ >= BringUpPhase::kFind && phase_ <= BringUpPhase::kMode;
}

void BringUp::OnFrame(const CanFrame& frame) noexcept {
  if (const MasterSign sign = watch_.SignOf(frame); sign != MasterSign::kNone) OnSign(sign, frame);
  if (!running()) return;
  transfer_.OnFrame(frame);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (frame.id == cob::kHeartbeat + nodes_[i].node_id && frame.length >= 1)
      OnHeartbeat(i, HeartbeatState(frame));
  }
}

// Before we have sent anything, whoever asks our drives is their master. Later an SDO is a service tool's,
// and may only have come between one of ours and its answer.
void BringUp::OnSign(MasterSign sign, const CanFrame& frame) noexcept {
  if (IsSecondMaster(sign) || (running() && phase_ == BringUpPhase::kListen)) {
    quiet_ = 0;
    if (!failed()) Fail(BringUpError::kSecondMaster, bus_.bus, frame.id);
  } else if (transfer_.state() == SdoTransfer::State::kWaiting && frame.id == transfer_.request().id) {
    collided_ = true;
  }
}

void BringUp::OnHeartbeat(std::size_t node, NmtState state) noexcept {
  states_[node].nmt = state;
  if (state == NmtState::kBootUp) {
    // Once a node's configuration has begun, a boot-up message says that it is lost again.
    const bool begun =
        (configuring() && (node < node_ || (node == node_ && step_ > 0))) || phase_ == BringUpPhase::kStart;
    if (begun) {
      ShowNode(node);
      Fail(BringUpError::kRestarted, 0, 0);
    }
    // It has not heard what it is being asked: it was given up waiting for, or booted twice. Once: it may
    // boot for ever.
    if (configuring() && node == node_ && !states_[node].asked_again)
      ask_again_ = states_[node].asked_again = true;
    states_[node].booted = phase_ != BringUpPhase::kReset;
  } else if (state == NmtState::kOperational) {
    states_[node].operational = phase_ == BringUpPhase::kStart;
    states_[node].started_itself = configuring();
  }
}

void BringUp::Step(std::uint64_t elapsed_cycles, Frames& out) noexcept {
  quiet_ += elapsed_cycles;
  if (!running()) return;
  waited_ += elapsed_cycles;
  if (phase_ == BringUpPhase::kListen && quiet_ >= bus_.listen_cycles) phase_ = BringUpPhase::kReset;
  if (phase_ == BringUpPhase::kListen) {
    // Not a frame.
  } else if (phase_ == BringUpPhase::kReset) {
    SendNmt(NmtCommand::kResetCommunication, out);
    phase_ = BringUpPhase::kBootUp;
    waited_ = 0;
  } else if (phase_ == BringUpPhase::kBootUp) {
    WaitForBootUp(out);
  } else if (phase_ == BringUpPhase::kStart) {
    WaitForOperational();
  } else {
    HoldBack(out);
    transfer_.Elapse(elapsed_cycles);
    Configure(out);
  }
  status_.phase = static_cast<std::uint8_t>(phase_);
  if (!failed()) status_.waited_us = static_cast<std::uint32_t>(waited_ * cycle_us_);
}

void BringUp::SendNmt(NmtCommand command, Frames& out) noexcept {
  for (const BringUpNode& n : nodes_) out.push_back(NmtFrame(command, n.node_id));
}

// PDOs are configured in Pre-operational; a node that starts itself is brought back there.
void BringUp::HoldBack(Frames& out) noexcept {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (!states_[i].started_itself) continue;
    out.push_back(NmtFrame(NmtCommand::kEnterPreOperational, nodes_[i].node_id));
    states_[i].started_itself = false;
  }
}

void BringUp::WaitForBootUp(Frames& out) noexcept {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (states_[i].booted || waited_ >= nodes_[i].boot_up_cycles) continue;
    ShowNode(i);
    return;
  }
  SendNmt(NmtCommand::kEnterPreOperational, out);
  node_ = 0;
  step_ = 0;
  ShowNode(0);
  watchdog_ = false;
  unwatched_ = {};
  ask_again_ = false;
  BeginStep(out);
}

void BringUp::Configure(Frames& out) noexcept {
  if (ask_again_ && transfer_.state() == SdoTransfer::State::kWaiting) BeginTransfer(out);
  ask_again_ = false;
  switch (transfer_.state()) {
    case SdoTransfer::State::kIdle:
    case SdoTransfer::State::kWaiting:
      return;
    case SdoTransfer::State::kTimedOut: {
      if (Retry(out)) return;
      out.push_back(SdoAbortFrame(nodes_[node_].node_id, step().index, step().sub, sdo_abort::kTimeout));
      const bool silent = phase_ == BringUpPhase::kFind && !states_[node_].booted;
      Fail(silent ? BringUpError::kNoAnswer : BringUpError::kSdoTimeout, 0, 0);
      return;
    }
    case SdoTransfer::State::kSegmented:
    case SdoTransfer::State::kUnexpected: {
      if (Retry(out)) return;
      out.push_back(SdoAbortFrame(nodes_[node_].node_id, step().index, step().sub, transfer_.abort_code()));
      const bool segmented = transfer_.state() == SdoTransfer::State::kSegmented;
      Fail(segmented ? BringUpError::kSegmentedReply : BringUpError::kUnexpectedReply, 0, transfer_.value());
      return;
    }
    case SdoTransfer::State::kAborted:
      if (Retry(out)) return;
      [[fallthrough]];
    case SdoTransfer::State::kDone:
      FinishTransfer();
      if (!failed()) NextStep(out);
      return;
  }
}

// A drive serves one request at a time: it may have dropped ours for a service tool's, or have refused it.
bool BringUp::Retry(Frames& out) noexcept {
  if (!collided_ || retries_ == kMaxRetries) return false;
  ++retries_;
  BeginTransfer(out);
  return true;
}

void BringUp::FinishTransfer() noexcept {
  const SdoStep& s = step();
  const bool ok = transfer_.state() == SdoTransfer::State::kDone;
  if (s.action == SdoAction::kCompare) return Compare(s, ok);
  const bool right_as_it_is =
      s.or_zero && differs_.known && differs_.found == 0 && CannotBeWritten(transfer_.abort_code());
  if (!ok && !right_as_it_is && !Tolerated(s.tolerate, transfer_.abort_code())) return Refused(s);
  if (!ok && s.watchdog) unwatched_ = differs_;
  if (s.action == SdoAction::kWrite) {
    written_ = ok;
    watchdog_ = watchdog_ || (s.watchdog && ok);
  } else if (s.action == SdoAction::kKeep) {
    kept_ = transfer_.value();
    kept_valid_ = ok;
  } else if (ok) {
    Judge(s, transfer_.value());
  }
}

// An object that cannot even be read (write-only, say) is written; one that is not there is no concern of the
// steps behind, where that is tolerated.
void BringUp::Compare(const SdoStep& s, bool ok) noexcept {
  const std::uint32_t code = transfer_.abort_code();
  if (!ok && Absent(code)) {
    if (!Tolerated(s.tolerate, code)) Refused(s);
    return;
  }
  const std::uint32_t found = transfer_.value() & s.mask;
  if (ok && found == s.value) {
    watchdog_ = watchdog_ || s.watchdog;
    return;
  }
  marks_ |= s.mark;
  if (ok && !differs_.known) differs_ = {true, s.index, s.sub, s.value, found};
}

void BringUp::Refused(const SdoStep& s) noexcept {
  status_.abort_code = transfer_.abort_code();
  const bool read_only = s.action == SdoAction::kWrite && CannotBeWritten(transfer_.abort_code());
  if (!read_only || !differs_.known) return Fail(BringUpError::kSdoAbort, 0, 0);
  // Of a mapping, the first entry that differs is what to look at, not the count that was to be cleared.
  status_.index = differs_.index;
  status_.sub_index = differs_.sub;
  Fail(BringUpError::kReadOnlyDiffers, differs_.expected, differs_.found);
}

bool BringUp::Skipped(const SdoStep& s) const noexcept {
  if (s.only_if != 0 && (marks_ & s.only_if) == 0) return true;
  if ((marks_ & s.skip_if) != 0) return true;
  return (s.after_write && !written_) || (s.action == SdoAction::kRatio && !kept_valid_);
}

void BringUp::Judge(const SdoStep& s, std::uint32_t found) noexcept {
  switch (s.action) {
    case SdoAction::kEqual:
      if ((found & s.mask) != s.value) Fail(s.error, s.value, found & s.mask);
      return;
    case SdoAction::kNear:
      if (found == 0) {
        Fail(BringUpError::kRatedTorqueZero, s.value, found);
      } else if (Distance(found, s.value) > s.tolerance) {
        Fail(s.error, s.value, found);
      }
      return;
    case SdoAction::kBits:
      if ((found & s.value) != s.value) Fail(s.error, s.value, found);
      return;
    case SdoAction::kAtLeast:
      if (found < s.value) Fail(s.error, s.value, found);
      return;
    case SdoAction::kRatio:
      if (found == 0 || kept_ != static_cast<std::uint64_t>(s.value) * found) {
        Fail(s.error, s.value, found == 0 ? 0 : kept_ / found);
      }
      return;
    case SdoAction::kPoll:
      if (found != s.value && waited_ >= s.deadline_cycles) Fail(s.error, s.value, found);
      return;
    case SdoAction::kWrite:
    case SdoAction::kKeep:
    case SdoAction::kCompare:
    case SdoAction::kRequireWatchdog:
      return;
  }
}

void BringUp::NextStep(Frames& out) noexcept {
  const bool again = step().action == SdoAction::kPoll && transfer_.state() == SdoTransfer::State::kDone &&
                     transfer_.value() != step().value;
  if (again) {
    BeginTransfer(out);
    return;
  }
  ++step_;
  BeginStep(out);
}

// Sends the request of the next step that needs one; after the last step of the last node, starts all nodes.
void BringUp::BeginStep(Frames& out) noexcept {
  waited_ = 0;
  retries_ = 0;
  transfer_.Cancel();
  while (node_ < nodes_.size()) {
    if (step_ >= nodes_[node_].steps.size()) {
      ++node_;
      step_ = 0;
      watchdog_ = false;
      unwatched_ = {};
      continue;
    }
    const SdoStep& s = step();
    if (s.first) {
      marks_ = 0;
      differs_ = {};
    }
    phase_ = s.phase;
    ShowNode(node_);
    status_.index = s.index;
    status_.sub_index = s.sub;
    if (s.action == SdoAction::kRequireWatchdog) {
      if (!watchdog_) {
        Fail(s.error, unwatched_.expected, unwatched_.found);
        return;
      }
    } else if (!Skipped(s)) {
      break;
    }
    ++step_;
  }
  if (node_ == nodes_.size()) {
    SendNmt(NmtCommand::kStart, out);
    phase_ = BringUpPhase::kStart;
    status_.index = 0;
    status_.sub_index = 0;
    return;
  }
  BeginTransfer(out);
}

void BringUp::BeginTransfer(Frames& out) noexcept {
  const BringUpNode& n = nodes_[node_];
  const SdoStep& s = step();
  collided_ = false;
  if (s.action == SdoAction::kWrite) {
    transfer_.StartWrite(n.node_id, s.index, s.sub, s.size, s.value, n.sdo_cycles);
  } else {
    transfer_.StartRead(n.node_id, s.index, s.sub, n.sdo_cycles);
  }
  out.push_back(transfer_.request());
}

void BringUp::WaitForOperational() noexcept {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (states_[i].operational) continue;
    ShowNode(i);
    if (waited_ >= nodes_[i].operational_cycles) {
      Fail(BringUpError::kNotOperational, static_cast<std::uint32_t>(NmtState::kOperational),
           static_cast<std::uint32_t>(states_[i].nmt));
    }
    return;
  }
  phase_ = BringUpPhase::kOperational;
}

void BringUp::Fail(BringUpError error, std::uint32_t expected, std::uint32_t found) noexcept {
  const bool over_sdo = error == BringUpError::kSdoTimeout || error == BringUpError::kNoAnswer;
  status_.phase = static_cast<std::uint8_t>(phase_);
  status_.error = static_cast<std::uint8_t>(error);
  status_.expected = expected;
  status_.found = found;
  std::uint64_t waited = over_sdo ? transfer_.waited_cycles() : waited_;
  if (error == BringUpError::kNoAnswer) {
    waited += nodes_[node_].boot_up_cycles;
    // Each deadline has its key: in milliseconds, for the text.
    status_.expected = Milliseconds(nodes_[node_].boot_up_cycles);
    status_.found = Milliseconds(nodes_[node_].sdo_cycles);
  }
  status_.waited_us = static_cast<std::uint32_t>(waited * cycle_us_);
  transfer_.Cancel();
}

std::uint32_t BringUp::Milliseconds(std::uint64_t cycles) const noexcept {
  return static_cast<std::uint32_t>((cycles * cycle_us_ + 500) / 1000);
}

void BringUp::ShowNode(std::size_t node) noexcept {
  if (node >= nodes_.size()) return;
  status_.axis = nodes_[node].axis;
  status_.node_id = nodes_[node].node_id;
}

}  // namespace contour
