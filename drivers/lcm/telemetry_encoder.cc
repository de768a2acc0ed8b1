#include "drivers/lcm/telemetry_encoder.h"

#include <algorithm>

#include "drivers/lcm/batch_checksums.h"
#include "drivers/lcm/cycle_messages.h"

namespace contour {
namespace {

std::vector<std::string> Channels(std::string_view prefix, std::span<const std::string> axis_names) {
  std::vector<std::string> channels;
  for (const std::string& name : axis_names) channels.push_back(std::string(prefix) + name);
  return channels;
}

void Send(const TelemetryEvent& event, std::span<TelemetrySink* const> sinks) {
  for (TelemetrySink* sink : sinks) sink->OnEvent(event);
}

template <class Message>
void Send(std::string_view channel, const Message& message, std::int64_t grid_time_ns,
          std::span<TelemetrySink* const> sinks) {
  const std::string bytes = Encode(message);
  Send({channel, bytes, grid_time_ns, 0}, sinks);
}

}  // namespace

TelemetryEncoder::TelemetryEncoder(const TelemetryConfig& config, int cycle_us,
                                   std::span<const std::string> axis_names)
    : batch_cycles_(static_cast<std::size_t>(std::max(1, config.batch_cycles))),
      look_every_cycles_(
          static_cast<std::uint64_t>(std::max(1, 1'000'000 / std::max(1, config.look_hz * cycle_us)))),
      axis_channels_(Channels("CONTOUR_AXIS_", axis_names)),
      friction_channels_(Channels("CONTOUR_FRICTION_", axis_names)) {
  batch_.crc32c = 0;
  batch_.batch_number = 0;
}

void TelemetryEncoder::Add(const CycleEntry& entry, std::span<TelemetrySink* const> sinks) {
  const CycleRecord& record = entry.output.record;
  batch_.entries.emplace_back();
  ToMessage(entry, batch_.entries.back());
  batch_time_ns_ = record.grid_time_ns;
  if (LookIsDue(record)) SendLook(record, batch_.entries.back(), sinks);
  if (batch_.entries.size() >= batch_cycles_) Flush(sinks);
}

void TelemetryEncoder::Flush(std::span<TelemetrySink* const> sinks) {
  if (batch_.entries.empty()) return;
  const std::string bytes = EncodeBatch(batch_);
  Send({kCyclesChannel, bytes, batch_time_ns_, batch_.count}, sinks);
  ++batch_.batch_number;
  batch_.entries.clear();
}

bool TelemetryEncoder::LookIsDue(const CycleRecord& record) noexcept {
  const bool changed = record.state != last_state_ || record.reason != last_reason_;
  last_state_ = record.state;
  last_reason_ = record.reason;
  return changed || record.cycle % look_every_cycles_ == 0;
}

void TelemetryEncoder::SendLook(const CycleRecord& record, const contour_lcm::cycle_entry& message,
                                std::span<TelemetrySink* const> sinks) {
  const std::int64_t time_ns = record.grid_time_ns;
  Send("CONTOUR_STATUS", message.status, time_ns, sinks);
  Send("CONTOUR_FAULTS", FaultsOf(record), time_ns, sinks);
  Send("CONTOUR_ERROR", message.contour, time_ns, sinks);
  Send("CONTOUR_TIMING", message.timing, time_ns, sinks);
  const std::size_t axes = std::min(message.axes.size(), axis_channels_.size());
  for (std::size_t axis = 0; axis < axes; ++axis) {
    Send(axis_channels_[axis], message.axes[axis], time_ns, sinks);
    Send(friction_channels_[axis], message.estimates[axis], time_ns, sinks);
  }
}

}  // namespace contour
