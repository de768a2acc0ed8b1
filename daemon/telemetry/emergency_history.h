#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "core/cycle_record.h"
#include "daemon/telemetry/cycle_health.h"
#include "drivers/cia301/messages.h"

namespace contour {

/// An emergency message as it came.
struct ReceivedEmergency {
  std::uint64_t cycle = 0;
  std::int64_t grid_time_ns = 0;
  std::size_t axis = 0;
  Emergency emergency;
  std::array<std::uint8_t, 5> maker{};  ///< the manufacturer's bytes
};

/// What a drive said of its errors: the newest messages, and what it remembers itself (0x1003), as it was
/// read.
struct DriveErrors {
  std::deque<ReceivedEmergency> received;  ///< newest last; the last kKeptEmergencies
  std::uint64_t received_count = 0;
  std::vector<std::uint32_t> stored;  ///< newest first
  std::uint64_t stored_cycle = 0;     ///< when the last of it was read; 0 never
  std::uint64_t mode_reads = 0;       ///< requests for 0x6061
  std::uint64_t mode_answers = 0;
};
inline constexpr std::size_t kKeptEmergencies = 16;
/// Key of the note that the log gets of each message, with the axis behind it; and LCM's channel of them.
inline constexpr char kEmergencyNote[] = "emergency ";
inline constexpr std::string_view kEmergencyChannel = "CONTOUR_EMERGENCY";

/// Made from the frames that every cycle takes in and gives out, so that the cycle has nothing to do with it.
class EmergencyHistory {
 public:
  explicit EmergencyHistory(std::size_t axes) : drives_(axes) {}
  /// Where the drives are, in the order of the axes.
  void Watch(const std::vector<FeedbackSource>& sources) { sources_ = sources; }

  /// The emergency messages of this cycle are left in news().
  void Add(const CycleEntry& entry);
  [[nodiscard]] const std::vector<ReceivedEmergency>& news() const { return news_; }
  [[nodiscard]] const std::vector<DriveErrors>& drives() const { return drives_; }

 private:
  void OnEmergency(std::size_t axis, const CanFrame& frame, const CycleEntry& entry);
  void OnSdoReply(std::size_t axis, const CanFrame& frame, std::uint64_t cycle);
  [[nodiscard]] std::size_t AxisOf(const StampedFrame& frame) const;

  std::vector<FeedbackSource> sources_;
  std::vector<DriveErrors> drives_;
  std::vector<ReceivedEmergency> news_;
};

/// "x: emergency 0x4210 (excess temperature of the device), error register 0x09, in cycle 123".
std::string EmergencyLine(const ReceivedEmergency& e, const std::string& axis);

}  // namespace contour
