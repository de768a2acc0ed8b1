#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/can_frame.h"
#include "tools/plant_emulator/object_dictionary.h"
#include "tools/plant_emulator/sdo_server.h"

namespace contour::plant {

/// Four RPDOs and four TPDOs of a slave: communication and mapping parameters with the rules of CiA 301 about
/// the order in which they may be changed, and the copying between frames and objects.
class PdoSet {
 public:
  static constexpr std::size_t kCount = 4;

  /// Adds 0x1400.., 0x1600.., 0x1800.., 0x1A00.. to a dictionary that is not sealed yet.
  static void AddObjects(ObjectDictionary& objects, std::uint8_t node_id);

  explicit PdoSet(ObjectDictionary& objects) noexcept : objects_(objects) {}

  /// Reads the parameters anew: after sealing, after a reset and after every write to them.
  void Refresh() noexcept;
  static bool Owns(std::uint16_t index) noexcept;
  [[nodiscard]] std::uint32_t CheckWrite(const ObjectEntry& entry, std::int64_t value,
                                         bool operational) const noexcept;

  enum class Received : std::uint8_t { kNotOurs, kTaken, kTooShort };
  /// A frame while Operational. Synchronous ones wait for ApplySync; `now_ns` is the drive's time, for the
  /// time-out.
  Received OnFrame(const CanFrame& frame, std::int64_t now_ns, ObjectRules& rules) noexcept;
  /// Values of the synchronous RPDOs that came since the last SYNC take effect.
  void ApplySync(ObjectRules& rules) noexcept;
  /// A watched RPDO (0x1400:05) did not come in time. Reported once; armed again by the next one.
  [[nodiscard]] bool TimedOut(std::int64_t now_ns) noexcept;

  /// TPDO `i` at a SYNC or between: fills `frame` if it is due. `bus_ns` serves event timers.
  bool DueAtSync(std::size_t i, CanFrame& frame) noexcept;
  bool DueByEvent(std::size_t i, std::int64_t bus_ns, CanFrame& frame) noexcept;
  [[nodiscard]] std::int64_t NextEvent_ns() const noexcept;
  /// Entering Operational: event-driven TPDOs go out once, watches start anew.
  void Start() noexcept;

 private:
  struct Pdo {
    std::uint16_t cob_id = 0;
    bool valid = false;
    std::uint8_t type = 255;
    std::uint32_t event_ms = 0;
    std::uint8_t length = 0;
    std::size_t mapped = 0;
    std::array<ObjectEntry*, 8> objects{};
    // Running state.
    CanFrame pending;
    bool has_pending = false;
    bool armed = false;
    std::int64_t last_ns = 0;
    std::uint32_t syncs = 0;
    CanFrame sent;
    bool ever_sent = false;
  };

  void Load(Pdo& pdo, std::uint16_t communication, std::uint16_t mapping) noexcept;
  void Store(const Pdo& pdo, const CanFrame& frame, ObjectRules& rules) noexcept;
  static CanFrame Build(const Pdo& pdo) noexcept;
  [[nodiscard]] std::uint32_t CheckMapping(const ObjectEntry& entry, std::int64_t value,
                                           bool receive) const noexcept;

  ObjectDictionary& objects_;
  std::array<Pdo, kCount> receive_;
  std::array<Pdo, kCount> transmit_;
};

}  // namespace contour::plant
