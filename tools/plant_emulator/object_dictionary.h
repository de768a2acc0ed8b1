#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace contour::plant {

/// SDO abort codes (CiA 301) this drive gives.
namespace abort_code {
inline constexpr std::uint32_t kNone = 0;
inline constexpr std::uint32_t kToggleBit = 0x05030000;
inline constexpr std::uint32_t kUnknownCommand = 0x05040001;
inline constexpr std::uint32_t kWriteOnly = 0x06010001;
inline constexpr std::uint32_t kReadOnly = 0x06010002;
inline constexpr std::uint32_t kNoObject = 0x06020000;
inline constexpr std::uint32_t kNotMappable = 0x06040041;
inline constexpr std::uint32_t kPdoTooLong = 0x06040042;
inline constexpr std::uint32_t kParameterConflict = 0x06040043;
inline constexpr std::uint32_t kLength = 0x06070010;
inline constexpr std::uint32_t kNoSubIndex = 0x06090011;
inline constexpr std::uint32_t kInvalidValue = 0x06090030;
inline constexpr std::uint32_t kTooHigh = 0x06090031;
inline constexpr std::uint32_t kTooLow = 0x06090032;
inline constexpr std::uint32_t kDeviceState = 0x08000022;
}  // namespace abort_code

enum class ObjectType : std::uint8_t { kU8, kI8, kU16, kI16, kU32, kI32, kText };
enum class ObjectAccess : std::uint8_t { kReadOnly, kWriteOnly, kReadWrite };

/// Into which PDOs an object may be mapped.
enum class ObjectMapping : std::uint8_t { kNone, kRpdo, kTpdo, kBoth };

constexpr std::size_t SizeOf(ObjectType t) noexcept {
  switch (t) {
    case ObjectType::kU8:
    case ObjectType::kI8:
      return 1;
    case ObjectType::kU16:
    case ObjectType::kI16:
      return 2;
    case ObjectType::kU32:
    case ObjectType::kI32:
      return 4;
    case ObjectType::kText:
      return 0;
  }
  return 0;
}

struct ObjectEntry {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  ObjectType type = ObjectType::kU32;
  ObjectAccess access = ObjectAccess::kReadOnly;
  ObjectMapping mapping = ObjectMapping::kNone;
  std::int64_t value = 0;
  std::int64_t initial = 0;
  std::int64_t low = 0;
  std::int64_t high = 0;
  std::string text;  ///< kText only
};

/// The drive's objects, by index and sub-index. Filled at construction; afterwards entries stay where they
/// are.
class ObjectDictionary {
 public:
  /// Limits default to what the type holds. Throws std::logic_error for an entry that exists already.
  void Add(std::uint16_t index, std::uint8_t sub, ObjectType type, ObjectAccess access, std::int64_t value,
           ObjectMapping mapping = ObjectMapping::kNone);
  void AddText(std::uint16_t index, std::string text);
  void Limit(std::uint16_t index, std::uint8_t sub, std::int64_t low, std::int64_t high);
  /// Call once after the last Add: sorts for look-up.
  void Seal();

  [[nodiscard]] ObjectEntry* Find(std::uint16_t index, std::uint8_t sub) noexcept;
  [[nodiscard]] bool HasIndex(std::uint16_t index) const noexcept;
  /// For objects that are known to exist; throws std::logic_error otherwise. Construction time only.
  [[nodiscard]] ObjectEntry& At(std::uint16_t index, std::uint8_t sub = 0);

  /// Puts every object of [first, last] back to its value of the start.
  void Restore(std::uint16_t first, std::uint16_t last) noexcept;

 private:
  std::vector<ObjectEntry> entries_;
};

/// Value of an entry as it goes over the wire (two's complement, little end first).
constexpr std::uint32_t WireValue(const ObjectEntry& e) noexcept {
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>(e.value));
}
/// Reads `raw` as a value of this type (sign extended).
std::int64_t FromWire(ObjectType type, std::uint32_t raw) noexcept;
/// Range check alone.
std::uint32_t CheckRange(const ObjectEntry& e, std::int64_t value) noexcept;

}  // namespace contour::plant
