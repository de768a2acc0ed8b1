#pragma once

#include <cstdint>
#include <vector>

#include "core/can_frame.h"
#include "core/cycle_record.h"
#include "core/fixed_vector.h"
#include "core/state_keeper.h"
#include "drivers/cia301/bring_up_status.h"
#include "drivers/cia301/master_watch.h"
#include "drivers/cia301/messages.h"
#include "drivers/cia301/sdo_step.h"
#include "drivers/cia301/sdo_transfer.h"

namespace contour {

/// A node to be brought up: deadlines in cycles, and what to do over SDO.
struct BringUpNode {
  std::uint8_t axis = 0;  ///< for messages
  std::uint8_t node_id = 0;
  std::uint64_t boot_up_cycles = 0;
  std::uint64_t sdo_cycles = 0;
  std::uint64_t operational_cycles = 0;
  std::vector<SdoStep> steps;
};

/// The bus as the one who brings it up knows it.
struct BringUpBus {
  std::uint8_t bus = 0;  ///< for messages
  std::uint8_t master_node_id = 0;
  std::uint64_t listen_cycles = 0;  ///< without a sign of another master, before the first frame is sent
};

/// Brings the nodes of one bus up, one step per cycle:
/// listening for another master, then NMT reset communication to all, boot-up messages (a node that sends
/// none is asked by SDO), NMT pre-operational, each node's script one object at a time, NMT start to all,
/// Operational confirmed by heartbeat. One SDO at a time per bus bounds the bus load. Nothing is retried but
/// a transfer that a service tool's came between; Start begins again from the reset.
///
/// It hears all the time: listening is over at once when the bus has been heard for long enough already.
class BringUp {
 public:
  using Frames = FixedVector<CanFrame, 20>;  ///< of one cycle: at most two NMT commands per node and one SDO

  BringUp() = default;
  BringUp(std::vector<BringUpNode> nodes, std::uint32_t cycle_us, const BringUpBus& bus = {});

  void Start() noexcept;
  /// Stops whatever is under way and reports that the bus went down.
  void BusDown() noexcept;

  /// A frame of this bus: heartbeats, boot-up messages, SDO replies and signs of another master concern it.
  void OnFrame(const CanFrame& frame) noexcept;
  /// One cycle: checks deadlines, goes on where it can and appends what is to be sent.
  void Step(std::uint64_t elapsed_cycles, Frames& out) noexcept;

  [[nodiscard]] const BringUpStatus& status() const noexcept { return status_; }
  [[nodiscard]] BringUpPhase phase() const noexcept { return phase_; }
  [[nodiscard]] bool failed() const noexcept { return status_.error != 0; }
  [[nodiscard]] bool done() const noexcept { return phase_ == BringUpPhase::kOperational && !failed(); }
  [[nodiscard]] bool second_master() const noexcept {
    return status_.error == static_cast<std::uint8_t>(BringUpError::kSecondMaster);
  }
  /// Whether the frame says that another master is there, which is not known yet.
  [[nodiscard]] bool NewSecondMaster(const CanFrame& frame) const noexcept {
    return !second_master() && IsSecondMaster(watch_.SignOf(frame));
  }
  /// Nothing may be sent on this bus, not even a heartbeat.
  [[nodiscard]] bool silent() const noexcept {
    return phase_ == BringUpPhase::kListen || (second_master() && phase_ != BringUpPhase::kOperational);
  }
  [[nodiscard]] bool running() const noexcept { return phase_ != BringUpPhase::kOff && !done() && !failed(); }

  /// The nodes and their scripts stay as constructed.
  void Keep(StateKeeper& keep) noexcept {
    keep(states_, phase_, status_, transfer_, node_, step_, waited_, kept_, kept_valid_, written_, watchdog_,
         marks_, differs_, unwatched_, ask_again_, quiet_, collided_, retries_);
  }

 private:
  struct NodeState {
    bool booted = false;
    bool operational = false;
    bool started_itself = false;  ///< said Operational before it was told to
    bool asked_again = false;     ///< had booted only after its first request
    NmtState nmt = NmtState::kUnknown;
  };

  /// What a comparison found where it had expected something else.
  struct Difference {
    bool known = false;
    std::uint16_t index = 0;
    std::uint8_t sub = 0;
    std::uint32_t expected = 0;
    std::uint32_t found = 0;
  };

  void OnSign(MasterSign sign, const CanFrame& frame) noexcept;
  void OnHeartbeat(std::size_t node, NmtState state) noexcept;
  void Compare(const SdoStep& step, bool ok) noexcept;
  void Refused(const SdoStep& step) noexcept;
  [[nodiscard]] bool Skipped(const SdoStep& step) const noexcept;
  void BeginTransfer(Frames& out) noexcept;
  void SendNmt(NmtCommand command, Frames& out) noexcept;
  void HoldBack(Frames& out) noexcept;
  void WaitForBootUp(Frames& out) noexcept;
  void Configure(Frames& out) noexcept;
  [[nodiscard]] bool Retry(Frames& out) noexcept;
  void FinishTransfer() noexcept;
  void Judge(const SdoStep& step, std::uint32_t found) noexcept;
  void NextStep(Frames& out) noexcept;
  void BeginStep(Frames& out) noexcept;
  void WaitForOperational() noexcept;
  void Fail(BringUpError error, std::uint32_t expected, std::uint32_t found) noexcept;
  void ShowNode(std::size_t node) noexcept;
  [[nodiscard]] std::uint32_t Milliseconds(std::uint64_t cycles) const noexcept;
  [[nodiscard]] const SdoStep& step() const noexcept { return nodes_[node_].steps[step_]; }
  [[nodiscard]] bool configuring() const noexcept;

  std::vector<BringUpNode> nodes_;
  std::vector<NodeState> states_;
  std::uint32_t cycle_us_ = 1000;
  BringUpPhase phase_ = BringUpPhase::kOff;
  BringUpStatus status_;
  SdoTransfer transfer_;
  std::size_t node_ = 0;  ///< the node whose script runs
  std::size_t step_ = 0;
  std::uint64_t waited_ = 0;  ///< cycles in this phase, or in this step
  std::uint32_t kept_ = 0;    ///< of the last kKeep
  bool kept_valid_ = false;
  bool written_ = false;    ///< the last write was accepted
  bool watchdog_ = false;   ///< a watchdog of this node could be set
  std::uint8_t marks_ = 0;  ///< of the group of steps under way
  Difference differs_;      ///< the first of that group
  Difference unwatched_;    ///< of a watchdog that could not be set
  bool ask_again_ = false;  ///< the node has only now booted: it has not heard the request
  MasterWatch watch_;
  BringUpBus bus_;
  std::uint64_t quiet_ = 0;   ///< cycles that the bus was heard without another master
  bool collided_ = false;     ///< somebody else asked the node while our transfer was under way
  std::uint8_t retries_ = 0;  ///< of this step
};

}  // namespace contour
