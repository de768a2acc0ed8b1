#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/states.h"
#include "drivers/can/bus_node.h"
#include "drivers/cia301/messages.h"

namespace contour::test {

/// A small scripted CiA 402 slave for tests of the master: object dictionary, NMT, SDO, one RPDO, one TPDO,
/// heartbeat both ways and the state machine; the motor is a free inertia. It can be told to misbehave.
class FakeSlave : public BusNode {
 public:
  using Object = std::pair<std::uint16_t, std::uint8_t>;

  struct Behaviour {
    bool boot_up = true;                         ///< sends a boot-up message after a reset
    std::int64_t boot_ns = 2'000'000;            ///< and answers no SDO before
    bool self_start = false;                     ///< goes to Operational by itself after a reset
    bool silent = false;                         ///< answers nothing
    bool stays_pre_operational = false;          ///< ignores NMT start
    std::optional<Object> mute_object;           ///< never answers this object
    std::optional<Object> segmented;             ///< wants to send this object in segments
    std::map<Object, std::uint32_t> aborts;      ///< refused with this code, read and write
    std::map<Object, std::uint32_t> sticky;      ///< accepts a write but holds this value
    std::map<Object, std::uint32_t> read_only;   ///< refuses writes with this code
    DriveState stuck_in = DriveState::kUnknown;  ///< goes no further than this state
    std::int64_t reply_ns = 100'000;
    std::int64_t tpdo_ns = 20'000;  ///< from SYNC to its TPDO
    bool unanswered = false;        ///< no TPDO
    bool follows = true;            ///< bit 12 while enabled
    bool remote = true;             ///< bit 9; without it no controlword is obeyed
    bool no_remote_bit = false;     ///< bit 9 is never shown
    bool obeys_another = false;     ///< another master's RPDO comes last before each SYNC, unless stopped
  };

  explicit FakeSlave(std::uint8_t node_id) : node_id_(node_id) {
    objects_ = {
        {{0x1000, 0}, 0x00020192}, {{0x1006, 0}, 0},       {{0x1015, 0}, 0},      {{0x1016, 1}, 0},
        {{0x1017, 0}, 0},          {{0x1018, 1}, 0x1234},  {{0x1018, 2}, 0x5678}, {{0x1018, 3}, 1},
        {{0x1029, 1}, 0},          {{0x6007, 0}, 1},       {{0x605A, 0}, 2},      {{0x605B, 0}, 0},
        {{0x605C, 0}, 1},          {{0x605D, 0}, 1},       {{0x605E, 0}, 2},      {{0x6060, 0}, 0},
        {{0x6061, 0}, 0},          {{0x6072, 0}, 1000},    {{0x6076, 0}, 637},    {{0x607E, 0}, 0},
        {{0x6085, 0}, 0},          {{0x608F, 1}, 1048576}, {{0x608F, 2}, 1},      {{0x6091, 1}, 1},
        {{0x6091, 2}, 1},          {{0x60C2, 1}, 0},       {{0x60C2, 2}, 0},      {{0x6502, 0}, 0x280},
        {{0x60E0, 0}, 1000},       {{0x60E1, 0}, 1000}};
    for (std::uint16_t i = 0; i < 4; ++i) {
      const auto offset = static_cast<std::uint32_t>(0x100 * i + node_id);
      const auto n = static_cast<std::uint16_t>(i);
      objects_[{static_cast<std::uint16_t>(0x1400 + n), 1}] = 0x200 + offset;
      objects_[{static_cast<std::uint16_t>(0x1400 + n), 2}] = 255;
      objects_[{static_cast<std::uint16_t>(0x1800 + n), 1}] = 0x40000180 + offset;
      objects_[{static_cast<std::uint16_t>(0x1800 + n), 2}] = 254;
      for (std::uint8_t sub = 0; sub <= 8; ++sub) {
        objects_[{static_cast<std::uint16_t>(0x1600 + n), sub}] = 0;
        objects_[{static_cast<std::uint16_t>(0x1A00 + n), sub}] = 0;
      }
    }
    objects_[{0x1400, 5}] = 0;
  }

  Behaviour behaviour;
  std::vector<std::int64_t> latched;  ///< position at each SYNC, the first one's at [0]
  std::map<Object, std::uint32_t>& objects() { return objects_; }
  [[nodiscard]] DriveState state() const { return state_; }
  [[nodiscard]] NmtState nmt() const { return nmt_; }
  [[nodiscard]] std::int16_t torque_per_mille() const { return torque_; }
  [[nodiscard]] std::int32_t target_position() const { return target_position_; }
  [[nodiscard]] std::uint64_t syncs() const { return syncs_; }
  [[nodiscard]] const std::vector<Object>& writes() const { return writes_; }
  /// Transfers that the master broke off, with its code.
  [[nodiscard]] const std::vector<std::pair<Object, std::uint32_t>>& master_aborts() const {
    return master_aborts_;
  }
  [[nodiscard]] std::uint64_t reads() const { return reads_; }
  [[nodiscard]] Object last_read() const { return last_read_; }
  [[nodiscard]] std::uint64_t master_heartbeats() const { return master_heartbeats_; }
  [[nodiscard]] std::int64_t position() const { return position_; }
  void set_position(std::int64_t counts) { position_ = counts; }
  /// Faults now; the emergency message goes out with the next frame or timer.
  void Fault(std::uint16_t code) {
    state_ = DriveState::kFault;
    emergency_ = Emergency{code, 1};
  }
  /// An emergency message and nothing else; goes out with the next frame or timer.
  void Report(Emergency e) { emergency_ = e; }
  void LeaveEnabled() { state_ = DriveState::kSwitchedOn; }
  void EnterPreOperational() { nmt_ = NmtState::kPreOperational; }
  void StopHeartbeat() { next_heartbeat_ns_ = kNever; }
  /// As after a power cycle: everything forgotten, boot-up sent with the next timer.
  void Restart(std::int64_t now_ns) {
    nmt_ = NmtState::kPreOperational;
    state_ = DriveState::kSwitchOnDisabled;
    restart_ns_ = now_ns;
    next_heartbeat_ns_ = kNever;
  }

  void OnFrame(const CanFrame& frame, std::int64_t time_ns, PendingFrames& out) noexcept override {
    if (behaviour.silent) return;
    FlushEmergency(time_ns, out);
    if (frame.id == cob::kNmt) {
      if (frame.data[1] == 0 || frame.data[1] == node_id_)
        OnNmt(static_cast<NmtCommand>(frame.data[0]), time_ns, out);
    } else if (frame.id == cob::kSync) {
      if (nmt_ == NmtState::kOperational) OnSync(time_ns, out);
    } else if (frame.id == cob::kSdoRequest + node_id_) {
      if (nmt_ != NmtState::kStopped) OnSdo(frame, time_ns, out);
    } else if (frame.id == (Value({0x1400, 1}) & 0x7FF) && nmt_ == NmtState::kOperational) {
      rpdo_ = frame;
      rpdo_waiting_ = true;
    } else if (Value({0x1016, 1}) != 0 && frame.id == cob::kHeartbeat + (Value({0x1016, 1}) >> 16)) {
      ++master_heartbeats_;
    }
  }

  void OnTimer(std::int64_t time_ns, PendingFrames& out) noexcept override {
    if (restart_ns_ <= time_ns) {
      restart_ns_ = kNever;
      out.push_back({HeartbeatFrame(node_id_, NmtState::kBootUp), time_ns});
    }
    if (next_heartbeat_ns_ <= time_ns) {
      next_heartbeat_ns_ = time_ns + static_cast<std::int64_t>(Value({0x1017, 0})) * 1'000'000;
      if (!behaviour.silent) out.push_back({HeartbeatFrame(node_id_, nmt_), time_ns});
      FlushEmergency(time_ns, out);
    }
  }
  [[nodiscard]] std::int64_t NextTimer() const noexcept override {
    return restart_ns_ < next_heartbeat_ns_ ? restart_ns_ : next_heartbeat_ns_;
  }

 private:
  [[nodiscard]] std::uint32_t Value(const Object& object) const {
    const auto found = objects_.find(object);
    return found == objects_.end() ? 0 : found->second;
  }

  void FlushEmergency(std::int64_t time_ns, PendingFrames& out) {
    if (!emergency_) return;
    out.push_back({EmergencyFrame(node_id_, *emergency_), time_ns});
    emergency_.reset();
  }

  void OnNmt(NmtCommand command, std::int64_t time_ns, PendingFrames& out) {
    switch (command) {
      case NmtCommand::kResetNode:
      case NmtCommand::kResetCommunication:
        for (const Object& o : {Object{0x1016, 1}, Object{0x1017, 0}}) {
          if (objects_.contains(o) && !behaviour.read_only.contains(o)) objects_[o] = 0;
        }
        next_heartbeat_ns_ = Value({0x1017, 0}) == 0 ? kNever : time_ns + behaviour.boot_ns + 50'000'000;
        nmt_ = behaviour.self_start ? NmtState::kOperational : NmtState::kPreOperational;
        state_ = DriveState::kSwitchOnDisabled;
        if (behaviour.boot_up)
          out.push_back({HeartbeatFrame(node_id_, NmtState::kBootUp), time_ns + behaviour.boot_ns});
        booted_ns_ = time_ns + behaviour.boot_ns;
        return;
      case NmtCommand::kStart:
        if (!behaviour.stays_pre_operational) nmt_ = NmtState::kOperational;
        return;
      case NmtCommand::kStop:
        nmt_ = NmtState::kStopped;
        return;
      case NmtCommand::kEnterPreOperational:
        nmt_ = NmtState::kPreOperational;
        return;
    }
  }

  void Reply(CanFrame f, std::uint8_t command, std::uint32_t value, std::int64_t time_ns,
             PendingFrames& out) const {
    f.id = static_cast<std::uint16_t>(cob::kSdoReply + node_id_);
    f.data[0] = command;
    PutU32(f, 4, value);
    out.push_back({f, time_ns + behaviour.reply_ns});
  }

  void OnSdo(const CanFrame& f, std::int64_t time_ns, PendingFrames& out) {
    const Object object{GetU16(f, 1), f.data[3]};
    const auto command = static_cast<std::uint8_t>(f.data[0] & 0xE0);
    if (command == 0x80) master_aborts_.push_back({object, GetU32(f, 4)});
    if (command == 0x80 || behaviour.mute_object == object || time_ns < booted_ns_) return;
    reads_ += command == 0x40 ? 1 : 0;
    if (command == 0x40) last_read_ = object;
    if (behaviour.segmented == object) return Reply(f, 0x41, 12, time_ns, out);
    if (behaviour.aborts.contains(object)) return Reply(f, 0x80, behaviour.aborts.at(object), time_ns, out);
    if (!objects_.contains(object)) return Reply(f, 0x80, 0x06020000, time_ns, out);
    if (command == 0x40) return Reply(f, 0x43, objects_.at(object), time_ns, out);
    if (behaviour.read_only.contains(object))
      return Reply(f, 0x80, behaviour.read_only.at(object), time_ns, out);
    Write(object, GetU32(f, 4), time_ns);
    Reply(f, 0x60, 0, time_ns, out);
  }

  void Write(Object object, std::uint32_t value, std::int64_t time_ns) {
    writes_.push_back(object);
    objects_[object] = behaviour.sticky.contains(object) ? behaviour.sticky.at(object) : value;
    if (object == Object{0x6060, 0}) objects_[{0x6061, 0}] = objects_[object];
    if (object == Object{0x1017, 0})
      next_heartbeat_ns_ = time_ns + static_cast<std::int64_t>(value) * 1'000'000;
  }

  // Latches the position, sends the TPDO, then applies the RPDO, as a drive does at SYNC.
  void OnSync(std::int64_t time_ns, PendingFrames& out) {
    ++syncs_;
    position_ += velocity_;
    latched.push_back(position_);
    const std::uint32_t cob_id = Value({0x1800, 1});
    const std::uint32_t type = Value({0x1800, 2});
    if ((cob_id & 0x80000000) == 0 && type >= 1 && type <= 240)
      if (!behaviour.unanswered) out.push_back({Feedback(cob_id), time_ns + behaviour.tpdo_ns});
    if (rpdo_waiting_ && !behaviour.obeys_another) Apply();
    if (state_ == DriveState::kOperationEnabled) velocity_ += torque_;
    if (state_ != DriveState::kOperationEnabled) velocity_ = 0;
  }

  CanFrame Feedback(std::uint32_t cob_id) {
    CanFrame f{static_cast<std::uint16_t>(cob_id & 0x7FF), 0, {}};
    for (std::uint8_t sub = 1; sub <= Value({0x1A00, 0}); ++sub) {
      const std::uint32_t entry = Value({0x1A00, sub});
      std::uint32_t value = 0;
      if (entry >> 16 == 0x6041) value = Statusword();
      if (entry >> 16 == 0x6064) value = static_cast<std::uint32_t>(static_cast<std::uint64_t>(position_));
      if (entry >> 16 == 0x6077) value = static_cast<std::uint16_t>(torque_);
      for (std::uint32_t bit = 0; bit < (entry & 0xFF); bit += 8) {
        f.data[f.length++] = static_cast<std::uint8_t>(value >> bit);
      }
    }
    return f;
  }

  void Apply() {
    rpdo_waiting_ = false;
    const std::uint16_t word = GetU16(rpdo_, 0);
    if (Value({0x6061, 0}) == 10) torque_ = static_cast<std::int16_t>(GetU16(rpdo_, 2));
    if (Value({0x6061, 0}) == 8) {
      target_position_ = static_cast<std::int32_t>(GetU32(rpdo_, 2));
      if (rpdo_.length == 8) torque_ = static_cast<std::int16_t>(GetU16(rpdo_, 6));
    }
    const bool reset_edge = (word & 0x80) != 0 && (last_word_ & 0x80) == 0;
    last_word_ = word;
    if (state_ != behaviour.stuck_in && behaviour.remote) Transition(word, reset_edge);
    if (state_ != DriveState::kOperationEnabled) torque_ = 0;
  }

  void Transition(std::uint16_t word, bool reset_edge) {
    using enum DriveState;
    if (state_ == kFault) {
      if (reset_edge) state_ = kSwitchOnDisabled;
      return;
    }
    if ((word & 0x02) == 0) {  // disable voltage
      state_ = kSwitchOnDisabled;
    } else if ((word & 0x04) == 0) {  // quick stop: at rest one cycle later
      state_ = state_ == kOperationEnabled ? kQuickStopActive : kSwitchOnDisabled;
    } else if ((word & 0x0F) == 0x06) {
      if (state_ != kQuickStopActive) state_ = kReadyToSwitchOn;
    } else if ((word & 0x0F) == 0x07) {
      if (state_ == kReadyToSwitchOn || state_ == kOperationEnabled) state_ = kSwitchedOn;
    } else if ((word & 0x0F) == 0x0F) {
      if (state_ == kSwitchedOn) state_ = kOperationEnabled;
    }
  }

  [[nodiscard]] std::uint16_t Statusword() const {
    return static_cast<std::uint16_t>(StatesBits() |
                                      (behaviour.remote && !behaviour.no_remote_bit ? 0x0200 : 0));
  }
  [[nodiscard]] std::uint16_t StatesBits() const {
    switch (state_) {
      case DriveState::kReadyToSwitchOn:
        return 0x0031;
      case DriveState::kSwitchedOn:
        return 0x0033;
      case DriveState::kOperationEnabled:
        return behaviour.follows ? 0x1037 : 0x0037;
      case DriveState::kQuickStopActive:
        return 0x0017;
      case DriveState::kFault:
        return 0x0018;
      case DriveState::kFaultReactionActive:
        return 0x001F;
      default:
        return 0x0050;
    }
  }

  std::uint8_t node_id_;
  std::map<Object, std::uint32_t> objects_;
  std::vector<Object> writes_;
  std::vector<std::pair<Object, std::uint32_t>> master_aborts_;
  std::uint64_t reads_ = 0;
  Object last_read_{};
  std::int64_t booted_ns_ = 0;
  NmtState nmt_ = NmtState::kStopped;  // a master must not rely on what it finds
  DriveState state_ = DriveState::kSwitchOnDisabled;
  std::int64_t next_heartbeat_ns_ = kNever;
  std::int64_t restart_ns_ = kNever;
  std::optional<Emergency> emergency_;
  CanFrame rpdo_;
  bool rpdo_waiting_ = false;
  std::uint16_t last_word_ = 0;
  std::int16_t torque_ = 0;
  std::int32_t target_position_ = 0;
  std::int64_t position_ = 1000;
  std::int64_t velocity_ = 0;
  std::uint64_t syncs_ = 0;
  std::uint64_t master_heartbeats_ = 0;
};

}  // namespace contour::test
