#pragma once

#include <cstdint>

#include "core/can_frame.h"
#include "tools/plant_emulator/object_dictionary.h"

namespace contour::plant {

/// Says whether the device takes a value, beyond access, length and range; and hears of the values it took.
class ObjectRules {
 public:
  virtual ~ObjectRules() = default;
  /// Abort code, or abort_code::kNone.
  [[nodiscard]] virtual std::uint32_t CheckWrite(const ObjectEntry& entry,
                                                 std::int64_t value) const noexcept = 0;
  virtual void OnWritten(const ObjectEntry& entry) noexcept = 0;
};

/// SDO server of a CANopen slave (CiA 301): expedited download and upload, segmented upload for texts,
/// aborts. Objects never exceed four bytes otherwise, so a segmented download is a length error.
class SdoServer {
 public:
  SdoServer(ObjectDictionary& objects, ObjectRules& rules, std::uint8_t node_id) noexcept
      : objects_(objects), rules_(rules), node_id_(node_id) {}

  /// Answers a request (COB-ID 0x600 + node). Returns false when nothing is to be sent.
  bool Answer(const CanFrame& request, CanFrame& reply) noexcept;
  void Reset() noexcept { text_ = nullptr; }

 private:
  void Download(const CanFrame& request, CanFrame& reply) noexcept;
  void Upload(const CanFrame& request, CanFrame& reply) noexcept;
  void UploadSegment(const CanFrame& request, CanFrame& reply) noexcept;
  static void Abort(const CanFrame& request, CanFrame& reply, std::uint32_t code) noexcept;

  ObjectDictionary& objects_;
  ObjectRules& rules_;
  std::uint8_t node_id_;
  const ObjectEntry* text_ = nullptr;  ///< being read in segments
  std::size_t text_sent_ = 0;
  bool toggle_ = false;
};

}  // namespace contour::plant
