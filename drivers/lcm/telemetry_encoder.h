#pragma once

#include <contour_lcm/cycle_batch.hpp>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/cycle_record.h"
#include "drivers/lcm/telemetry_config.h"

namespace contour {

inline constexpr std::string_view kCyclesChannel = "CONTOUR_CYCLES";

/// A message on its way to the network or into a log. The views live as long as the call that hands them
/// over.
struct TelemetryEvent {
  std::string_view channel;
  std::string_view bytes;
  std::int64_t grid_time_ns = 0;  ///< of the newest cycle in it
  int cycles = 0;                 ///< how many cycles of the full-rate record it holds; 0 for looking only
};

/// Where messages go. Nothing may be thrown: what cannot be delivered is counted by the receiver.
class TelemetrySink {
 public:
  virtual ~TelemetrySink() = default;
  virtual void OnEvent(const TelemetryEvent& event) noexcept = 0;
};

/// Turns cycles into messages: every cycle in batches on CONTOUR_CYCLES, and at the rate for looking, or at
/// once when the state of the machine changes, CONTOUR_STATUS, CONTOUR_FAULTS, CONTOUR_ERROR, CONTOUR_TIMING
/// and for each axis CONTOUR_AXIS_<name> and CONTOUR_FRICTION_<name>.
class TelemetryEncoder {
 public:
  TelemetryEncoder(const TelemetryConfig& config, int cycle_us, std::span<const std::string> axis_names);

  void Add(const CycleEntry& entry, std::span<TelemetrySink* const> sinks);
  /// Sends a batch that is not full yet.
  void Flush(std::span<TelemetrySink* const> sinks);

 private:
  [[nodiscard]] bool LookIsDue(const CycleRecord& record) noexcept;
  void SendLook(const CycleRecord& record, const contour_lcm::cycle_entry& message,
                std::span<TelemetrySink* const> sinks);

  const std::size_t batch_cycles_;
  const std::uint64_t look_every_cycles_;
  std::vector<std::string> axis_channels_;
  std::vector<std::string> friction_channels_;
  contour_lcm::cycle_batch batch_;
  std::int64_t batch_time_ns_ = 0;
  MachineState last_state_ = MachineState::kOff;
  Reason last_reason_ = Reason::kNone;
};

}  // namespace contour
