#include "drivers/can/loopback_bus.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "drivers/can/frame_timing.h"

namespace contour {
namespace {

constexpr std::size_t kMailboxesPerNode = 64;

}  // namespace

LoopbackBus::LoopbackBus(std::uint32_t bitrate_bit_s, std::vector<BusNode*> nodes)
    : bitrate_bit_s_(bitrate_bit_s),
      nodes_(std::move(nodes)),
      mailbox_capacity_(kMailboxesPerNode * std::max<std::size_t>(1, nodes_.size())) {
  if (bitrate_bit_s_ == 0) throw std::invalid_argument("loopback bus: the bit rate must not be 0");
  mailboxes_.reserve(mailbox_capacity_);
  state_.up = true;
}

std::size_t LoopbackBus::Receive(std::int64_t now_ns, std::span<StampedFrame> frames) noexcept {
  AdvanceTo(now_ns);
  const std::size_t count = std::min(frames.size(), receive_count_);
  std::size_t own = 0;
  for (std::size_t i = 0; i < count; ++i) {
    frames[i] = receive_queue_[receive_head_];
    own += (frames[i].frame.id & kOwnFrame) != 0 ? 1U : 0U;
    receive_head_ = (receive_head_ + 1) % kReceiveQueue;
  }
  receive_count_ -= count;
  state_.frames_received += count - own;
  return count;
}

std::size_t LoopbackBus::Send(std::int64_t now_ns, std::span<const CanFrame> frames) noexcept {
  AdvanceTo(now_ns);
  std::size_t accepted = 0;
  while (state_.up && accepted < frames.size() && send_count_ < kSendQueue) {
    send_queue_[(send_head_ + send_count_) % kSendQueue] = {frames[accepted], now_ns_, kMaster};
    ++send_count_;
    ++accepted;
  }
  state_.send_failures += frames.size() - accepted;
  state_.frames_sent += accepted;
  return accepted;
}

// Ends of frames come before timers, timers before the next arbitration. Arbitration at `now_ns` itself waits
// for the next call, so that what the master sends at that instant takes part.
void LoopbackBus::AdvanceTo(std::int64_t now_ns) noexcept {
  while (true) {
    const std::int64_t end = busy_ ? frame_end_ns_ : kNever;
    const std::int64_t timer = NextTimer();
    const std::int64_t start = NextStart();
    if (end <= now_ns && end <= timer && end <= start) {
      EndFrame();
    } else if (timer <= now_ns && timer <= start) {
      RunTimers(timer);
    } else if (start < now_ns) {
      StartFrame(start);
    } else {
      break;
    }
  }
  now_ns_ = std::max(now_ns_, now_ns);
}

std::int64_t LoopbackBus::NextStart() const noexcept {
  if (busy_) return kNever;
  std::int64_t ready = send_count_ > 0 ? send_queue_[send_head_].ready_ns : kNever;
  for (const Waiting& w : mailboxes_) ready = std::min(ready, w.ready_ns);
  return ready == kNever ? kNever : std::max(ready, idle_from_ns_);
}

void LoopbackBus::StartFrame(std::int64_t time_ns) noexcept {
  std::size_t winner = kMaster;
  std::uint32_t lowest = UINT32_MAX;
  if (send_count_ > 0 && send_queue_[send_head_].ready_ns <= time_ns)
    lowest = send_queue_[send_head_].frame.id;
  for (std::size_t i = 0; i < mailboxes_.size(); ++i) {
    const Waiting& w = mailboxes_[i];
    if (w.ready_ns > time_ns || w.frame.id > lowest) continue;
    if (w.frame.id == lowest && (winner == kMaster || w.ready_ns >= mailboxes_[winner].ready_ns)) continue;
    winner = i;
    lowest = w.frame.id;
  }
  if (winner == kMaster) {
    on_wire_ = send_queue_[send_head_];
    send_head_ = (send_head_ + 1) % kSendQueue;
    --send_count_;
  } else {
    on_wire_ = mailboxes_[winner];
    mailboxes_.erase(mailboxes_.begin() + static_cast<std::ptrdiff_t>(winner));
  }
  const std::uint32_t bits = FrameBits(on_wire_.frame);
  busy_ = true;
  frame_end_ns_ = time_ns + BitsToNs(bits - kIntermissionBits, bitrate_bit_s_);
  idle_from_ns_ = time_ns + BitsToNs(bits, bitrate_bit_s_);
  busy_ns_ += BitsToNs(bits, bitrate_bit_s_);
}

void LoopbackBus::EndFrame() noexcept {
  busy_ = false;
  now_ns_ = frame_end_ns_;
  if (on_wire_.sender != kMaster) {
    Deliver(on_wire_.frame, frame_end_ns_);
  } else if (on_wire_.frame.id == told_id_) {
    CanFrame own = on_wire_.frame;
    own.id |= kOwnFrame;
    Deliver(own, frame_end_ns_);
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (i == on_wire_.sender) continue;
    scratch_.clear();
    nodes_[i]->OnFrame(on_wire_.frame, frame_end_ns_, scratch_);
    Post(i);
  }
}

void LoopbackBus::Deliver(const CanFrame& frame, std::int64_t time_ns) noexcept {
  if (receive_count_ == kReceiveQueue) {
    ++state_.receive_overflows;
    return;
  }
  receive_queue_[(receive_head_ + receive_count_) % kReceiveQueue] = {frame, 0, time_ns};
  ++receive_count_;
}

std::int64_t LoopbackBus::NextTimer() const noexcept {
  std::int64_t next = kNever;
  for (const BusNode* n : nodes_) next = std::min(next, n->NextTimer());
  return next == kNever ? kNever : std::max(next, now_ns_);
}

void LoopbackBus::RunTimers(std::int64_t time_ns) noexcept {
  now_ns_ = time_ns;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (nodes_[i]->NextTimer() > time_ns) continue;
    scratch_.clear();
    nodes_[i]->OnTimer(time_ns, scratch_);
    Post(i);
  }
}

void LoopbackBus::Post(std::size_t node) noexcept {
  if (!state_.up) return;
  for (const PendingFrame& p : scratch_) {
    if (mailboxes_.size() == mailbox_capacity_) {
      ++node_overflows_;
      continue;
    }
    mailboxes_.push_back({p.frame, std::max(p.ready_ns, now_ns_), node});
  }
}

}  // namespace contour
