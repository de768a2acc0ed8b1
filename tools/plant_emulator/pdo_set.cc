#include "tools/plant_emulator/pdo_set.h"

#include <algorithm>

#include "drivers/can/bus_node.h"

namespace contour::plant {
namespace {

constexpr std::uint16_t kReceiveCommunication = 0x1400;
constexpr std::uint16_t kReceiveMapping = 0x1600;
constexpr std::uint16_t kTransmitCommunication = 0x1800;
constexpr std::uint16_t kTransmitMapping = 0x1A00;
constexpr std::uint32_t kInvalidBit = 0x80000000U;
constexpr std::uint32_t kNoRtrBit = 0x40000000U;
constexpr std::int64_t kNsPerMs = 1'000'000;

std::uint16_t At(std::uint16_t base, std::size_t i) noexcept { return static_cast<std::uint16_t>(base + i); }
bool In(std::uint16_t index, std::uint16_t base) noexcept {
  return index >= base && index < base + PdoSet::kCount;
}

std::int64_t Value(ObjectDictionary& objects, std::uint16_t index, std::uint8_t sub) noexcept {
  const ObjectEntry* e = objects.Find(index, sub);
  return e == nullptr ? 0 : e->value;
}

void AddCommunication(ObjectDictionary& o, std::uint16_t index, std::int64_t cob_id) {
  o.Add(index, 0, ObjectType::kU8, ObjectAccess::kReadOnly, 5);
  o.Add(index, 1, ObjectType::kU32, ObjectAccess::kReadWrite, cob_id);
  o.Add(index, 2, ObjectType::kU8, ObjectAccess::kReadWrite, 255);
  o.Add(index, 3, ObjectType::kU16, ObjectAccess::kReadWrite, 0);
  o.Add(index, 5, ObjectType::kU16, ObjectAccess::kReadWrite, 0);
}

void AddMapping(ObjectDictionary& o, std::uint16_t index, std::int64_t first) {
  o.Add(index, 0, ObjectType::kU8, ObjectAccess::kReadWrite, first == 0 ? 0 : 1);
  for (std::uint8_t sub = 1; sub <= 8; ++sub)
    o.Add(index, sub, ObjectType::kU32, ObjectAccess::kReadWrite, sub == 1 ? first : 0);
}

}  // namespace

void PdoSet::AddObjects(ObjectDictionary& o, std::uint8_t node_id) {
  for (std::size_t i = 0; i < kCount; ++i) {
    const auto offset = static_cast<std::int64_t>(0x100 * i);
    const std::int64_t off = i < 2 ? 0 : std::int64_t{kInvalidBit};
    AddCommunication(o, At(kReceiveCommunication, i), (0x200 + offset + node_id) | off);
    AddMapping(o, At(kReceiveMapping, i), i < 2 ? 0x60400010 : 0);
    AddCommunication(o, At(kTransmitCommunication, i),
                     (0x180 + offset + node_id) | off | std::int64_t{kNoRtrBit});
    AddMapping(o, At(kTransmitMapping, i), i < 2 ? 0x60410010 : 0);
  }
}

bool PdoSet::Owns(std::uint16_t index) noexcept {
  return In(index, kReceiveCommunication) || In(index, kReceiveMapping) ||
         In(index, kTransmitCommunication) || In(index, kTransmitMapping);
}

void PdoSet::Refresh() noexcept {
  for (std::size_t i = 0; i < kCount; ++i) {
    Load(receive_[i], At(kReceiveCommunication, i), At(kReceiveMapping, i));
    Load(transmit_[i], At(kTransmitCommunication, i), At(kTransmitMapping, i));
  }
}

void PdoSet::Load(Pdo& pdo, std::uint16_t communication, std::uint16_t mapping) noexcept {
  const auto cob = static_cast<std::uint32_t>(Value(objects_, communication, 1));
  pdo.cob_id = static_cast<std::uint16_t>(cob & 0x7FFU);
  pdo.valid = (cob & kInvalidBit) == 0;
  pdo.type = static_cast<std::uint8_t>(Value(objects_, communication, 2));
  pdo.event_ms = static_cast<std::uint32_t>(Value(objects_, communication, 5));
  pdo.mapped = 0;
  pdo.length = 0;
  const auto count = static_cast<std::size_t>(Value(objects_, mapping, 0));
  for (std::size_t i = 0; i < count && i < pdo.objects.size(); ++i) {
    const auto entry = static_cast<std::uint32_t>(Value(objects_, mapping, static_cast<std::uint8_t>(i + 1)));
    ObjectEntry* object =
        objects_.Find(static_cast<std::uint16_t>(entry >> 16U), static_cast<std::uint8_t>(entry >> 8U));
    if (object == nullptr) break;
    pdo.objects[pdo.mapped++] = object;
    pdo.length = static_cast<std::uint8_t>(pdo.length + SizeOf(object->type));
  }
  if (!pdo.valid) {
    pdo.has_pending = false;
    pdo.armed = false;
    pdo.ever_sent = false;
    pdo.syncs = 0;
  }
}

std::uint32_t PdoSet::CheckMapping(const ObjectEntry& entry, std::int64_t value,
                                   bool receive) const noexcept {
  const std::uint16_t base = receive ? kReceiveMapping : kTransmitMapping;
  const std::size_t i = static_cast<std::size_t>(entry.index - base);
  const Pdo& pdo = receive ? receive_[i] : transmit_[i];
  if (pdo.valid) return abort_code::kDeviceState;
  if (entry.sub != 0) {
    if (Value(objects_, entry.index, 0) != 0) return abort_code::kDeviceState;
    const auto raw = static_cast<std::uint32_t>(value);
    const ObjectEntry* object =
        objects_.Find(static_cast<std::uint16_t>(raw >> 16U), static_cast<std::uint8_t>(raw >> 8U));
    if (object == nullptr || (raw & 0xFFU) != 8U * SizeOf(object->type)) return abort_code::kNotMappable;
    const ObjectMapping wanted = receive ? ObjectMapping::kRpdo : ObjectMapping::kTpdo;
    return object->mapping == wanted || object->mapping == ObjectMapping::kBoth ? abort_code::kNone
                                                                                : abort_code::kNotMappable;
  }
  if (value > 8) return abort_code::kPdoTooLong;
  std::uint32_t bits = 0;
  for (std::uint8_t sub = 1; sub <= value; ++sub) {
    const auto raw = static_cast<std::uint32_t>(Value(objects_, entry.index, sub));
    if (raw == 0) return abort_code::kNotMappable;
    bits += raw & 0xFFU;
  }
  return bits > 64 ? abort_code::kPdoTooLong : abort_code::kNone;
}

std::uint32_t PdoSet::CheckWrite(const ObjectEntry& entry, std::int64_t value,
                                 bool operational) const noexcept {
  if (operational) return abort_code::kDeviceState;
  if (In(entry.index, kReceiveMapping)) return CheckMapping(entry, value, true);
  if (In(entry.index, kTransmitMapping)) return CheckMapping(entry, value, false);
  const bool receive = In(entry.index, kReceiveCommunication);
  if (entry.sub == 1) {
    const auto cob = static_cast<std::uint32_t>(value);
    const auto id = cob & 0x7FFU;
    if ((cob & 0x3FFFF800U) != 0) return abort_code::kInvalidValue;  // 29-bit identifiers
    if ((cob & kInvalidBit) != 0) return abort_code::kNone;
    if (id < 0x181 || id > 0x57F) return abort_code::kInvalidValue;
    const auto old = static_cast<std::uint32_t>(entry.value);
    const bool was_valid = (old & kInvalidBit) == 0;
    return was_valid && (old & 0x7FFU) != id ? abort_code::kInvalidValue : abort_code::kNone;
  }
  if (entry.sub == 2) {
    const bool known = value <= 240 || value >= 254;
    return known ? abort_code::kNone : abort_code::kInvalidValue;
  }
  if (entry.sub == 3 && !receive) {
    // An inhibit time may only be changed while the PDO does not exist.
    const std::size_t i = static_cast<std::size_t>(entry.index - kTransmitCommunication);
    return transmit_[i].valid ? abort_code::kDeviceState : abort_code::kNone;
  }
  return abort_code::kNone;
}

PdoSet::Received PdoSet::OnFrame(const CanFrame& frame, std::int64_t now_ns, ObjectRules& rules) noexcept {
  for (Pdo& pdo : receive_) {
    if (!pdo.valid || pdo.cob_id != frame.id || pdo.mapped == 0) continue;
    if (frame.length < pdo.length) return Received::kTooShort;
    pdo.last_ns = now_ns;
    pdo.armed = pdo.event_ms != 0;
    if (pdo.type <= 240) {
      pdo.pending = frame;
      pdo.has_pending = true;
    } else {
      Store(pdo, frame, rules);
    }
    return Received::kTaken;
  }
  return Received::kNotOurs;
}

void PdoSet::ApplySync(ObjectRules& rules) noexcept {
  for (Pdo& pdo : receive_) {
    if (!pdo.has_pending) continue;
    pdo.has_pending = false;
    Store(pdo, pdo.pending, rules);
  }
}

void PdoSet::Store(const Pdo& pdo, const CanFrame& frame, ObjectRules& rules) noexcept {
  std::size_t at = 0;
  for (std::size_t i = 0; i < pdo.mapped; ++i) {
    ObjectEntry& e = *pdo.objects[i];
    std::uint32_t raw = 0;
    for (std::size_t b = 0; b < SizeOf(e.type); ++b)
      raw |= static_cast<std::uint32_t>(frame.data[at + b]) << (8U * b);
    at += SizeOf(e.type);
    const std::int64_t value = FromWire(e.type, raw);
    // A value that the object would refuse over SDO is passed over.
    if (CheckRange(e, value) != abort_code::kNone || rules.CheckWrite(e, value) != abort_code::kNone)
      continue;
    e.value = value;
    rules.OnWritten(e);
  }
}

bool PdoSet::TimedOut(std::int64_t now_ns) noexcept {
  bool late = false;
  for (Pdo& pdo : receive_) {
    if (!pdo.armed || now_ns - pdo.last_ns < pdo.event_ms * kNsPerMs) continue;
    pdo.armed = false;
    late = true;
  }
  return late;
}

CanFrame PdoSet::Build(const Pdo& pdo) noexcept {
  CanFrame frame;
  frame.id = pdo.cob_id;
  for (std::size_t i = 0; i < pdo.mapped; ++i) {
    const std::uint32_t raw = WireValue(*pdo.objects[i]);
    for (std::size_t b = 0; b < SizeOf(pdo.objects[i]->type); ++b)
      frame.data[frame.length++] = static_cast<std::uint8_t>(raw >> (8U * b));
  }
  return frame;
}

bool PdoSet::DueAtSync(std::size_t i, CanFrame& frame) noexcept {
  Pdo& pdo = transmit_[i];
  if (!pdo.valid || pdo.mapped == 0 || pdo.type > 240) return false;
  frame = Build(pdo);
  if (pdo.type == 0) {  // acyclic: at the SYNC after a change
    if (pdo.ever_sent && frame == pdo.sent) return false;
  } else if (++pdo.syncs < pdo.type) {
    return false;
  }
  pdo.syncs = 0;
  pdo.sent = frame;
  pdo.ever_sent = true;
  return true;
}

bool PdoSet::DueByEvent(std::size_t i, std::int64_t bus_ns, CanFrame& frame) noexcept {
  Pdo& pdo = transmit_[i];
  if (!pdo.valid || pdo.mapped == 0 || pdo.type < 254) return false;
  frame = Build(pdo);
  const bool timer = pdo.event_ms != 0 && bus_ns - pdo.last_ns >= pdo.event_ms * kNsPerMs;
  if (pdo.ever_sent && frame == pdo.sent && !timer) return false;
  pdo.last_ns = bus_ns;
  pdo.sent = frame;
  pdo.ever_sent = true;
  return true;
}

std::int64_t PdoSet::NextEvent_ns() const noexcept {
  std::int64_t next = kNever;
  for (const Pdo& pdo : transmit_)
    if (pdo.valid && pdo.mapped != 0 && pdo.type >= 254 && pdo.event_ms != 0)
      next = std::min(next, pdo.last_ns + pdo.event_ms * kNsPerMs);
  return next;
}

void PdoSet::Start() noexcept {
  for (Pdo& pdo : transmit_) {
    pdo.ever_sent = false;
    pdo.syncs = 0;
  }
  for (Pdo& pdo : receive_) {
    pdo.armed = false;
    pdo.has_pending = false;
  }
}

}  // namespace contour::plant
