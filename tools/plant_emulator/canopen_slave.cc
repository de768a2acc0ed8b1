#include "tools/plant_emulator/canopen_slave.h"

#include <algorithm>

namespace contour::plant {
namespace {

constexpr std::int64_t kNsPerMs = 1'000'000;
constexpr std::int64_t kBootTime_ns = 2 * kNsPerMs;
constexpr std::int64_t kTpdoDelay_ns = 10'000;  ///< from SYNC to the TPDO ready for the bus
constexpr std::int64_t kSdoDelay_ns = 150'000;  ///< a drive answers SDO from its slow task
constexpr std::uint8_t kGenericError = 0x01;
constexpr std::uint8_t kCommunicationError = 0x10;
constexpr std::uint16_t kEmergencyHeartbeat = 0x8130;
constexpr std::uint16_t kEmergencyPdoLength = 0x8210;
constexpr std::uint16_t kEmergencyRpdoTimeout = 0x8250;

}  // namespace

void CanopenSlave::AddObjects(ObjectDictionary& o, std::uint8_t node_id, const Identity& identity) {
  using enum ObjectType;
  using enum ObjectAccess;
  o.Add(0x1000, 0, kU32, kReadOnly, 0x00020192);  // servo drive, profile 402
  o.Add(0x1001, 0, kU8, kReadOnly, 0, ObjectMapping::kTpdo);
  o.Add(0x1003, 0, kU8, kReadWrite, 0);
  for (std::uint8_t sub = 1; sub <= 8; ++sub) o.Add(0x1003, sub, kU32, kReadOnly, 0);
  o.Add(0x1005, 0, kU32, kReadOnly, 0x80);
  o.Add(0x1006, 0, kU32, kReadWrite, 0);
  o.AddText(0x1008, "contour emulated drive");
  o.AddText(0x1009, "A");
  o.AddText(0x100A, "1.0");
  o.Add(0x1014, 0, kU32, kReadOnly, 0x80 + node_id);
  o.Add(0x1015, 0, kU16, kReadWrite, 0);
  o.Add(0x1016, 0, kU8, kReadOnly, 1);
  o.Add(0x1016, 1, kU32, kReadWrite, 0);
  o.Add(0x1017, 0, kU16, kReadWrite, 0);
  o.Add(0x1018, 0, kU8, kReadOnly, 4);
  o.Add(0x1018, 1, kU32, kReadOnly, identity.vendor_id);
  o.Add(0x1018, 2, kU32, kReadOnly, identity.product_code);
  o.Add(0x1018, 3, kU32, kReadOnly, identity.revision);
  o.Add(0x1018, 4, kU32, kReadOnly, identity.serial);
  o.Add(0x1029, 0, kU8, kReadOnly, 1);
  o.Add(0x1029, 1, kU8, kReadWrite, 0);
  o.Limit(0x1029, 1, 0, 2);
  o.Add(0x1200, 0, kU8, kReadOnly, 2);
  o.Add(0x1200, 1, kU32, kReadOnly, 0x600 + node_id);
  o.Add(0x1200, 2, kU32, kReadOnly, 0x580 + node_id);
  PdoSet::AddObjects(o, node_id);
}

CanopenSlave::CanopenSlave(ObjectDictionary& objects, SlaveDevice& device, std::uint8_t node_id)
    : objects_(objects),
      device_(device),
      node_id_(node_id),
      sdo_(objects, device, node_id),
      pdo_(objects),
      heartbeat_producer_(&objects.At(0x1017)),
      heartbeat_consumer_(&objects.At(0x1016, 1)),
      error_behaviour_(&objects.At(0x1029, 1)),
      error_register_(&objects.At(0x1001)),
      emergency_inhibit_(&objects.At(0x1015)),
      error_count_(&objects.At(0x1003, 0)) {
  for (std::uint8_t i = 0; i < 8; ++i)
    error_history_[i] = &objects.At(0x1003, static_cast<std::uint8_t>(i + 1));
  pdo_.Refresh();
}

void CanopenSlave::OnFrame(const CanFrame& frame, std::int64_t bus_ns, std::int64_t drive_ns,
                           PendingFrames& out) noexcept {
  bus_ns_ = bus_ns;
  if (nmt_ == SlaveNmt::kInitialising) return;
  if (frame.id == 0x000) {
    if (frame.length == 2 && (frame.data[1] == 0 || frame.data[1] == node_id_)) OnNmt(frame.data[0], bus_ns);
    return;
  }
  const auto consumer = static_cast<std::uint32_t>(heartbeat_consumer_->value);
  if (frame.id >= 0x701 && frame.id <= 0x77F) {
    if (frame.id == 0x700U + (consumer >> 16U & 0x7FU) && (consumer & 0xFFFFU) != 0) {
      consuming_ = true;
      consumed_ns_ = drive_ns;
    }
    return;
  }
  if (frame.id == 0x600 + node_id_) {
    if (nmt_ == SlaveNmt::kStopped) return;
    PendingFrame reply;
    reply.ready_ns = bus_ns + kSdoDelay_ns;
    if (sdo_.Answer(frame, reply.frame)) out.push_back(reply);
    return;
  }
  if (nmt_ != SlaveNmt::kOperational) return;
  if (pdo_.OnFrame(frame, drive_ns, device_) == PdoSet::Received::kTooShort)
    Emergency(kEmergencyPdoLength, kCommunicationError);
}

void CanopenSlave::OnNmt(std::uint8_t command, std::int64_t bus_ns) noexcept {
  switch (command) {
    case 0x01:
      Enter(SlaveNmt::kOperational);
      return;
    case 0x02:
      Enter(SlaveNmt::kStopped);
      return;
    case 0x80:
      Enter(SlaveNmt::kPreOperational);
      return;
    case 0x81:
      device_.OnPowerCycle();
      Boot(bus_ns);
      return;
    case 0x82:
      if (nmt_ == SlaveNmt::kOperational) device_.OnConnectionLost(ConnectionLoss::kNmt);
      Boot(bus_ns);
      return;
    default:
      return;
  }
}

void CanopenSlave::Boot(std::int64_t bus_ns) noexcept {
  // The communication objects go back to what they were at power-on.
  objects_.Restore(0x1000, 0x1FFF);
  pdo_.Refresh();
  pdo_.Start();
  sdo_.Reset();
  nmt_ = SlaveNmt::kInitialising;
  boot_at_ns_ = bus_ns + kBootTime_ns;
  next_heartbeat_ns_ = kNever;
  heartbeat_changed_ = false;
  consuming_ = false;
  emergencies_waiting_ = 0;
  reported_ = false;
}

void CanopenSlave::Enter(SlaveNmt state) noexcept {
  if (state == nmt_) return;
  const bool left = nmt_ == SlaveNmt::kOperational;
  nmt_ = state;
  heartbeat_changed_ = true;
  if (state == SlaveNmt::kOperational) pdo_.Start();
  if (left) device_.OnConnectionLost(ConnectionLoss::kNmt);
}

void CanopenSlave::OnSync(std::int64_t bus_ns, PendingFrames& out) noexcept {
  bus_ns_ = bus_ns;
  if (nmt_ != SlaveNmt::kOperational) return;
  PendingFrame tpdo;
  const bool slow = ++syncs_ % answer_delay_every_ == 0;
  tpdo.ready_ns = std::max(bus_ns + kTpdoDelay_ns + (slow ? answer_delay_ns_ : 0), last_answer_ns_);
  last_answer_ns_ = tpdo.ready_ns;
  for (std::size_t i = 0; i < PdoSet::kCount; ++i)
    if (pdo_.DueAtSync(i, tpdo.frame)) out.push_back(tpdo);
  pdo_.ApplySync(device_);
}

void CanopenSlave::SendHeartbeat(std::uint8_t state, std::int64_t bus_ns, PendingFrames& out) const noexcept {
  PendingFrame beat;
  beat.ready_ns = bus_ns;
  beat.frame.id = static_cast<std::uint16_t>(0x700 + node_id_);
  beat.frame.length = 1;
  beat.frame.data[0] = state;
  out.push_back(beat);
}

void CanopenSlave::OnTimer(std::int64_t bus_ns, PendingFrames& out) noexcept {
  bus_ns_ = bus_ns;
  if (nmt_ == SlaveNmt::kInitialising) {
    if (bus_ns < boot_at_ns_) return;
    nmt_ = SlaveNmt::kPreOperational;
    SendHeartbeat(0, bus_ns, out);
    return;
  }
  const std::int64_t period_ns = heartbeat_producer_->value * kNsPerMs;
  if (period_ns > 0 && (heartbeat_changed_ || bus_ns >= next_heartbeat_ns_)) {
    SendHeartbeat(static_cast<std::uint8_t>(nmt_), bus_ns, out);
    next_heartbeat_ns_ = bus_ns + period_ns;
  }
  if (period_ns == 0) next_heartbeat_ns_ = kNever;
  heartbeat_changed_ = false;
  if (nmt_ == SlaveNmt::kStopped) return;
  if (emergencies_waiting_ > 0 && bus_ns >= emergency_allowed_ns_) {
    PendingFrame message;
    message.ready_ns = bus_ns;
    message.frame.id = static_cast<std::uint16_t>(0x80 + node_id_);
    message.frame.length = 8;
    message.frame.data[0] = static_cast<std::uint8_t>(emergencies_[0].code & 0xFFU);
    message.frame.data[1] = static_cast<std::uint8_t>(emergencies_[0].code >> 8U);
    message.frame.data[2] = emergencies_[0].error_register;
    out.push_back(message);
    for (std::size_t i = 1; i < emergencies_waiting_; ++i) emergencies_[i - 1] = emergencies_[i];
    --emergencies_waiting_;
    emergency_allowed_ns_ = bus_ns + emergency_inhibit_->value * 100'000;
  }
  if (nmt_ != SlaveNmt::kOperational) return;
  PendingFrame tpdo;
  tpdo.ready_ns = bus_ns + kTpdoDelay_ns;
  for (std::size_t i = 0; i < PdoSet::kCount; ++i)
    if (pdo_.DueByEvent(i, bus_ns, tpdo.frame)) out.push_back(tpdo);
}

std::int64_t CanopenSlave::NextTimer() const noexcept {
  if (nmt_ == SlaveNmt::kInitialising) return boot_at_ns_;
  std::int64_t next = next_heartbeat_ns_;
  if (heartbeat_changed_ && heartbeat_producer_->value > 0) next = bus_ns_;
  if (nmt_ == SlaveNmt::kStopped) return next;
  if (emergencies_waiting_ > 0) next = std::min(next, std::max(bus_ns_, emergency_allowed_ns_));
  if (nmt_ == SlaveNmt::kOperational) next = std::min(next, std::max(bus_ns_, pdo_.NextEvent_ns()));
  return next;
}

void CanopenSlave::Watch(std::int64_t drive_ns) noexcept {
  if (nmt_ == SlaveNmt::kInitialising) return;
  const auto consumer = static_cast<std::uint32_t>(heartbeat_consumer_->value);
  const std::int64_t timeout_ns = static_cast<std::int64_t>(consumer & 0xFFFFU) * kNsPerMs;
  if (timeout_ns == 0) consuming_ = false;
  if (consuming_ && drive_ns - consumed_ns_ >= timeout_ns) {
    consuming_ = false;  // monitoring starts anew with the next heartbeat
    Lost(ConnectionLoss::kHeartbeat, kEmergencyHeartbeat);
  }
  if (nmt_ == SlaveNmt::kOperational && pdo_.TimedOut(drive_ns))
    Lost(ConnectionLoss::kRpdoTimeout, kEmergencyRpdoTimeout);
}

void CanopenSlave::Lost(ConnectionLoss loss, std::uint16_t code) noexcept {
  Emergency(code, kCommunicationError);
  device_.OnConnectionLost(loss);
  // 0x1029:01 for communication errors: 0 leaves Operational, 1 changes nothing, 2 stops.
  if (error_behaviour_->value == 0 && nmt_ == SlaveNmt::kOperational) {
    nmt_ = SlaveNmt::kPreOperational;
    heartbeat_changed_ = true;
  } else if (error_behaviour_->value == 2 && nmt_ != SlaveNmt::kStopped) {
    nmt_ = SlaveNmt::kStopped;
    heartbeat_changed_ = true;
  }
}

void CanopenSlave::Emergency(std::uint16_t code, std::uint8_t register_bits) noexcept {
  error_register_->value |= kGenericError | register_bits;
  for (std::size_t i = error_history_.size() - 1; i > 0; --i)
    error_history_[i]->value = error_history_[i - 1]->value;
  error_history_[0]->value = code;
  error_count_->value =
      std::min<std::int64_t>(error_count_->value + 1, static_cast<std::int64_t>(error_history_.size()));
  reported_ = true;
  if (emergencies_waiting_ < emergencies_.size())
    emergencies_[emergencies_waiting_++] = {code, static_cast<std::uint8_t>(error_register_->value)};
}

void CanopenSlave::ClearErrors() noexcept {
  error_register_->value = 0;
  if (!reported_) return;
  reported_ = false;
  if (emergencies_waiting_ < emergencies_.size()) emergencies_[emergencies_waiting_++] = {0x0000, 0};
}

std::uint32_t CanopenSlave::CheckWrite(const ObjectEntry& entry, std::int64_t value) const noexcept {
  if (PdoSet::Owns(entry.index)) return pdo_.CheckWrite(entry, value, nmt_ == SlaveNmt::kOperational);
  if (entry.index == 0x1003) return value == 0 ? abort_code::kNone : abort_code::kInvalidValue;
  if (entry.index == 0x1016) {
    const auto raw = static_cast<std::uint32_t>(value);
    const bool sensible = (raw >> 16U) <= 127 && ((raw & 0xFFFFU) == 0 || (raw >> 16U) != node_id_);
    return sensible ? abort_code::kNone : abort_code::kParameterConflict;
  }
  return abort_code::kNone;
}

void CanopenSlave::OnWritten(const ObjectEntry& entry) noexcept {
  if (PdoSet::Owns(entry.index)) pdo_.Refresh();
  if (entry.index == 0x1017) heartbeat_changed_ = true;
  if (entry.index == 0x1016) consuming_ = false;
  if (entry.index == 0x1003)
    for (ObjectEntry* e : error_history_) e->value = 0;
}

}  // namespace contour::plant
