#include "daemon/telemetry/emergency_history.h"

#include <algorithm>
#include <cstdio>

#include "drivers/cia301/emergency_table.h"

namespace contour {
namespace {

constexpr std::uint16_t kErrorField = 0x1003;
constexpr std::uint16_t kModeDisplay = 0x6061;
constexpr std::uint8_t kUploadReply = 0x40;
constexpr std::uint8_t kUploadRequest = 0x40;
constexpr std::uint8_t kExpedited = 0x02;

bool Is(const CanFrame& frame, std::uint16_t function) {
  return (frame.id & 0x780) == function && (frame.id & 0x7F) != 0;
}

}  // namespace

std::size_t EmergencyHistory::AxisOf(const StampedFrame& f) const {
  const unsigned node = f.frame.id & 0x7Fu;
  for (std::size_t i = 0; i < sources_.size() && i < drives_.size(); ++i)
    if (sources_[i].bus == f.bus && (sources_[i].frame_id & 0x7Fu) == node) return i;
  return drives_.size();
}

void EmergencyHistory::Add(const CycleEntry& entry) {
  news_.clear();
  for (const StampedFrame& f : entry.input.frames) {
    const bool emergency = Is(f.frame, cob::kEmergency) && f.frame.length >= 3;
    const bool reply = Is(f.frame, cob::kSdoReply) && f.frame.length == 8;
    if (!emergency && !reply) continue;
    const std::size_t axis = AxisOf(f);
    if (axis == drives_.size()) continue;
    if (emergency) OnEmergency(axis, f.frame, entry);
    if (reply) OnSdoReply(axis, f.frame, entry.input.cycle);
  }
  for (const StampedFrame& f : entry.output.frames) {
    const bool asks = Is(f.frame, cob::kSdoRequest) && f.frame.data[0] == kUploadRequest;
    if (!asks || GetU16(f.frame, 1) != kModeDisplay) continue;
    if (const std::size_t axis = AxisOf(f); axis < drives_.size()) ++drives_[axis].mode_reads;
  }
}

void EmergencyHistory::OnEmergency(std::size_t axis, const CanFrame& frame, const CycleEntry& entry) {
  ReceivedEmergency e{entry.input.cycle, entry.input.grid_time_ns, axis, DecodeEmergency(frame), {}};
  for (std::size_t i = 3; i < frame.length && i < 8; ++i) e.maker[i - 3] = frame.data[i];
  DriveErrors& d = drives_[axis];
  ++d.received_count;
  d.received.push_back(e);
  if (d.received.size() > kKeptEmergencies) d.received.pop_front();
  news_.push_back(e);
}

void EmergencyHistory::OnSdoReply(std::size_t axis, const CanFrame& frame, std::uint64_t cycle) {
  DriveErrors& d = drives_[axis];
  const bool read = (frame.data[0] & 0xE0) == kUploadReply && (frame.data[0] & kExpedited) != 0;
  const std::uint16_t index = GetU16(frame, 1);
  if (index == kModeDisplay) ++d.mode_answers;
  if (!read || index != kErrorField) return;
  const std::uint8_t sub = frame.data[3];
  d.stored_cycle = cycle;
  if (sub == 0) {
    d.stored.clear();
  } else if (d.stored.size() + 1 == sub) {
    d.stored.push_back(GetU32(frame, 4));
  }
}

std::string EmergencyLine(const ReceivedEmergency& e, const std::string& axis) {
  char text[96];
  std::snprintf(text, sizeof text, "emergency 0x%04X (", unsigned{e.emergency.error_code});
  std::string line = axis + ": " + text + std::string(EmergencyText(e.emergency.error_code)) + ")";
  std::snprintf(text, sizeof text, ", error register 0x%02X, in cycle %llu",
                unsigned{e.emergency.error_register}, static_cast<unsigned long long>(e.cycle));
  return line + text;
}

}  // namespace contour
