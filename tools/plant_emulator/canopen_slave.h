#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "drivers/can/bus_node.h"
#include "tools/plant_emulator/object_dictionary.h"
#include "tools/plant_emulator/pdo_set.h"
#include "tools/plant_emulator/sdo_server.h"

namespace contour::plant {

enum class SlaveNmt : std::uint8_t {
  kInitialising = 0,
  kStopped = 4,
  kOperational = 5,
  kPreOperational = 127
};

/// Why the connection to the master ended, for 0x6007.
enum class ConnectionLoss : std::uint8_t { kHeartbeat, kRpdoTimeout, kNmt };

/// What a slave's device profile has to do with its communication.
class SlaveDevice : public ObjectRules {
 public:
  virtual void OnConnectionLost(ConnectionLoss loss) noexcept = 0;
  /// NMT reset node: as if switched off and on.
  virtual void OnPowerCycle() noexcept = 0;
};

/// The communication part of a CANopen slave (CiA 301): NMT, heartbeat both ways, SDO, PDO, EMCY. Two clocks
/// are handed in: bus time for what goes out by itself, and the drive's own time for its watchdogs (see
/// EmulatedMachine).
class CanopenSlave {
 public:
  CanopenSlave(ObjectDictionary& objects, SlaveDevice& device, std::uint8_t node_id);

  /// Every `every`-th answer to SYNC comes this much later; those after it do not overtake it.
  void DelayAnswers(std::int64_t delay_ns, int every) noexcept {
    answer_delay_ns_ = delay_ns;
    answer_delay_every_ = static_cast<std::uint64_t>(every);
  }

  struct Identity {
    std::uint32_t vendor_id = 0;
    std::uint32_t product_code = 0;
    std::uint32_t revision = 0;
    std::uint32_t serial = 0;
  };
  /// Adds the objects of CiA 301 to a dictionary that is not sealed yet.
  static void AddObjects(ObjectDictionary& objects, std::uint8_t node_id, const Identity& identity);

  /// Every frame except SYNC.
  void OnFrame(const CanFrame& frame, std::int64_t bus_ns, std::int64_t drive_ns,
               PendingFrames& out) noexcept;
  /// At a SYNC, position latched: TPDOs go out, then the waiting RPDOs take effect.
  void OnSync(std::int64_t bus_ns, PendingFrames& out) noexcept;
  /// Boot-up, heartbeat, held back emergencies, event-driven TPDOs.
  void OnTimer(std::int64_t bus_ns, PendingFrames& out) noexcept;
  [[nodiscard]] std::int64_t NextTimer() const noexcept;
  /// Watchdogs, by the drive's time.
  void Watch(std::int64_t drive_ns) noexcept;

  /// An emergency message; goes out at the next OnTimer, not sooner than the inhibit time (0x1015) allows.
  void Emergency(std::uint16_t code, std::uint8_t register_bits) noexcept;
  /// As if switched off and on.
  void Restart() noexcept {
    device_.OnPowerCycle();
    Boot(bus_ns_);
  }
  /// All errors are gone: EMCY 0x0000 if any was reported.
  void ClearErrors() noexcept;

  // What drives do unasked:
  /// To Pre-operational, as after an error of its own; the next heartbeat says so.
  void LeaveOperational() noexcept { Enter(SlaveNmt::kPreOperational); }
  /// As if switched off and on; the device has its power cycle beside this.
  void Restart(std::int64_t bus_ns) noexcept { Boot(bus_ns); }

  [[nodiscard]] SlaveNmt nmt() const noexcept { return nmt_; }
  /// The value of an object of ours was written over SDO or RPDO.
  void OnWritten(const ObjectEntry& entry) noexcept;
  /// Abort code for our own objects.
  [[nodiscard]] std::uint32_t CheckWrite(const ObjectEntry& entry, std::int64_t value) const noexcept;

 private:
  void OnNmt(std::uint8_t command, std::int64_t bus_ns) noexcept;
  void Boot(std::int64_t bus_ns) noexcept;
  void Enter(SlaveNmt state) noexcept;
  void Lost(ConnectionLoss loss, std::uint16_t code) noexcept;
  void SendHeartbeat(std::uint8_t state, std::int64_t bus_ns, PendingFrames& out) const noexcept;

  struct QueuedEmergency {
    std::uint16_t code = 0;
    std::uint8_t error_register = 0;
  };

  ObjectDictionary& objects_;
  SlaveDevice& device_;
  std::uint8_t node_id_;
  SdoServer sdo_;
  PdoSet pdo_;
  SlaveNmt nmt_ = SlaveNmt::kInitialising;

  ObjectEntry* heartbeat_producer_;
  ObjectEntry* heartbeat_consumer_;
  ObjectEntry* error_behaviour_;
  ObjectEntry* error_register_;
  ObjectEntry* emergency_inhibit_;
  ObjectEntry* error_count_;
  std::array<ObjectEntry*, 8> error_history_{};

  std::int64_t boot_at_ns_ = 0;
  std::int64_t next_heartbeat_ns_ = kNever;
  bool heartbeat_changed_ = false;  ///< NMT state or period changed: send one now
  bool consuming_ = false;
  std::int64_t consumed_ns_ = 0;
  std::array<QueuedEmergency, 8> emergencies_{};
  std::size_t emergencies_waiting_ = 0;
  std::int64_t emergency_allowed_ns_ = 0;
  bool reported_ = false;
  std::int64_t bus_ns_ = 0;
  std::uint64_t syncs_ = 0;
  std::int64_t answer_delay_ns_ = 0;
  std::uint64_t answer_delay_every_ = 1;
  std::int64_t last_answer_ns_ = 0;
};

}  // namespace contour::plant
