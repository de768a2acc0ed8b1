#include "tools/plant_emulator/object_dictionary.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

namespace contour::plant {
namespace {

constexpr std::uint32_t Key(std::uint16_t index, std::uint8_t sub) noexcept {
  return static_cast<std::uint32_t>(index) << 8U | sub;
}
bool Before(const ObjectEntry& a, const ObjectEntry& b) noexcept {
  return Key(a.index, a.sub) < Key(b.index, b.sub);
}

template <class T>
void SetLimits(ObjectEntry& e) {
  e.low = std::numeric_limits<T>::min();
  e.high = std::numeric_limits<T>::max();
}

}  // namespace

void ObjectDictionary::Add(std::uint16_t index, std::uint8_t sub, ObjectType type, ObjectAccess access,
                           std::int64_t value, ObjectMapping mapping) {
  for (const ObjectEntry& e : entries_)
    if (Key(e.index, e.sub) == Key(index, sub))
      throw std::logic_error("object dictionary: entry added twice");
  ObjectEntry e{index, sub, type, access, mapping, value, value, 0, 0, {}};
  switch (type) {
    case ObjectType::kU8:
      SetLimits<std::uint8_t>(e);
      break;
    case ObjectType::kI8:
      SetLimits<std::int8_t>(e);
      break;
    case ObjectType::kU16:
      SetLimits<std::uint16_t>(e);
      break;
    case ObjectType::kI16:
      SetLimits<std::int16_t>(e);
      break;
    case ObjectType::kU32:
      SetLimits<std::uint32_t>(e);
      break;
    case ObjectType::kI32:
      SetLimits<std::int32_t>(e);
      break;
    case ObjectType::kText:
      break;
  }
  entries_.push_back(std::move(e));
}

void ObjectDictionary::AddText(std::uint16_t index, std::string text) {
  Add(index, 0, ObjectType::kText, ObjectAccess::kReadOnly, 0);
  entries_.back().text = std::move(text);
}

void ObjectDictionary::Limit(std::uint16_t index, std::uint8_t sub, std::int64_t low, std::int64_t high) {
  ObjectEntry& e = At(index, sub);
  e.low = low;
  e.high = high;
}

void ObjectDictionary::Seal() { std::sort(entries_.begin(), entries_.end(), Before); }

ObjectEntry* ObjectDictionary::Find(std::uint16_t index, std::uint8_t sub) noexcept {
  const std::uint32_t key = Key(index, sub);
  const auto found =
      std::lower_bound(entries_.begin(), entries_.end(), key,
                       [](const ObjectEntry& e, std::uint32_t k) { return Key(e.index, e.sub) < k; });
  return found != entries_.end() && Key(found->index, found->sub) == key ? &*found : nullptr;
}

bool ObjectDictionary::HasIndex(std::uint16_t index) const noexcept {
  const auto found =
      std::lower_bound(entries_.begin(), entries_.end(), Key(index, 0),
                       [](const ObjectEntry& e, std::uint32_t k) { return Key(e.index, e.sub) < k; });
  return found != entries_.end() && found->index == index;
}

ObjectEntry& ObjectDictionary::At(std::uint16_t index, std::uint8_t sub) {
  for (ObjectEntry& e : entries_)
    if (Key(e.index, e.sub) == Key(index, sub)) return e;
  throw std::logic_error("object dictionary: no such entry");
}

void ObjectDictionary::Restore(std::uint16_t first, std::uint16_t last) noexcept {
  for (ObjectEntry& e : entries_)
    if (e.index >= first && e.index <= last) e.value = e.initial;
}

std::int64_t FromWire(ObjectType type, std::uint32_t raw) noexcept {
  switch (type) {
    case ObjectType::kU8:
      return static_cast<std::uint8_t>(raw);
    case ObjectType::kI8:
      return static_cast<std::int8_t>(raw);
    case ObjectType::kU16:
      return static_cast<std::uint16_t>(raw);
    case ObjectType::kI16:
      return static_cast<std::int16_t>(raw);
    case ObjectType::kI32:
      return static_cast<std::int32_t>(raw);
    case ObjectType::kU32:
    case ObjectType::kText:
      return raw;
  }
  return raw;
}

std::uint32_t CheckRange(const ObjectEntry& e, std::int64_t value) noexcept {
  if (value > e.high) return abort_code::kTooHigh;
  if (value < e.low) return abort_code::kTooLow;
  return abort_code::kNone;
}

}  // namespace contour::plant
