#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "drivers/can/bus_node.h"
#include "drivers/can/frame_bus.h"

namespace contour {

/// An in-process CAN bus in virtual time: the master's end is this object, the other participants are
/// BusNodes.
///
/// Modelled: one frame at a time, each as long as its own bits (stuff bits counted exactly) take at the bit
/// rate; when the bus falls idle the ready frame with the lowest identifier is sent, and what is on the wire
/// is not interrupted. The master sends from one first-in-first-out queue, as a controller behind SocketCAN
/// does: only its oldest frame takes part in arbitration. Nodes have a mailbox per frame: all their ready
/// frames take part; equal identifiers go in order of readiness. A frame arrives, everywhere at once, at the
/// end of its last bit before the intermission. Not modelled: bit errors, lost arbitration of equal
/// identifiers.
///
/// Time goes on in Receive and Send only, to the `now_ns` handed in (never back); in between, ends of frames
/// and the nodes' timers are worked off in the order of their times, so that the same calls always give the
/// same result.
class LoopbackBus : public FrameBus {
 public:
  static constexpr std::size_t kSendQueue = 64;  ///< frames the master's queue holds; more are send failures
  static constexpr std::size_t kReceiveQueue = 256;  ///< frames waiting for Receive; more are overflows

  /// The nodes must outlive the bus. Throws std::invalid_argument for a bit rate of 0.
  LoopbackBus(std::uint32_t bitrate_bit_s, std::vector<BusNode*> nodes);

  std::size_t Receive(std::int64_t now_ns, std::span<StampedFrame> frames) noexcept override;
  std::size_t Send(std::int64_t now_ns, std::span<const CanFrame> frames) noexcept override;
  [[nodiscard]] BusState State() const noexcept override { return state_; }

  /// Takes the link down (all frames waiting and on the wire are lost, nobody can send) or up again, as
  /// `ip link set ... down` would. The nodes' timers go on.
  void SetLink(std::int64_t now_ns, bool up) noexcept;

  /// From now on the master's frames of this identifier come back to Receive as kOwnFrame | id when they have
  /// been on the wire.
  void TellOf(std::uint16_t id) noexcept { told_id_ = id; }

  /// A frame of somebody who is neither the master nor one of the nodes, ready now: all of them receive it.
  void Inject(std::int64_t now_ns, const CanFrame& frame) noexcept;
  /// An error frame as SocketCAN has them: what a controller would say. Frames go on.
  void InjectErrorFrame(std::uint32_t id, std::span<const std::uint8_t, 8> data) noexcept;

  /// Time the bus has been busy, for load figures.
  [[nodiscard]] std::int64_t busy_ns() const noexcept { return busy_ns_; }
  /// Frames of nodes that found no room in their mailboxes.
  [[nodiscard]] std::uint64_t node_overflows() const noexcept { return node_overflows_; }

 private:
  static constexpr std::size_t kMaster = SIZE_MAX;        ///< sender number of the master
  static constexpr std::size_t kStranger = SIZE_MAX - 1;  ///< of a frame that was injected

  struct Waiting {
    CanFrame frame;
    std::int64_t ready_ns = 0;
    std::size_t sender = 0;
  };

  void AdvanceTo(std::int64_t now_ns) noexcept;
  [[nodiscard]] std::int64_t NextStart() const noexcept;
  void StartFrame(std::int64_t time_ns) noexcept;
  void EndFrame() noexcept;
  void RunTimers(std::int64_t time_ns) noexcept;
  [[nodiscard]] std::int64_t NextTimer() const noexcept;
  void Post(std::size_t node) noexcept;
  void Deliver(const CanFrame& frame, std::int64_t time_ns) noexcept;

  std::uint32_t bitrate_bit_s_;
  std::vector<BusNode*> nodes_;
  std::vector<Waiting> mailboxes_;  ///< of all nodes, in order of posting
  std::size_t mailbox_capacity_;
  PendingFrames scratch_;

  std::array<Waiting, kSendQueue> send_queue_{};
  std::size_t send_head_ = 0;
  std::size_t send_count_ = 0;
  std::array<StampedFrame, kReceiveQueue> receive_queue_{};
  std::size_t receive_head_ = 0;
  std::size_t receive_count_ = 0;

  std::uint16_t told_id_ = kOwnFrame;  ///< of no frame at first
  Waiting on_wire_;
  bool busy_ = false;
  std::int64_t frame_end_ns_ = 0;  ///< of the frame on the wire
  std::int64_t idle_from_ns_ = 0;  ///< after the intermission
  std::int64_t now_ns_ = 0;
  std::int64_t busy_ns_ = 0;
  std::uint64_t node_overflows_ = 0;
  BusState state_;
};

}  // namespace contour
