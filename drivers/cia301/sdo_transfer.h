#pragma once

#include <cstdint>
#include <string_view>

#include "core/can_frame.h"

namespace contour {

/// Abort codes of CiA 301 that the driver itself tells apart.
namespace sdo_abort {
inline constexpr std::uint32_t kTimeout = 0x05040000;
inline constexpr std::uint32_t kCommandUnknown = 0x05040001;
inline constexpr std::uint32_t kUnsupportedAccess = 0x06010000;
inline constexpr std::uint32_t kWriteOnly = 0x06010001;
inline constexpr std::uint32_t kReadOnly = 0x06010002;
inline constexpr std::uint32_t kNoObject = 0x06020000;
inline constexpr std::uint32_t kLengthTooHigh = 0x06070012;
inline constexpr std::uint32_t kNoSubIndex = 0x06090011;
}  // namespace sdo_abort

/// Text of an SDO abort code as CiA 301 words it; "unknown abort code" for codes of the manufacturer.
[[nodiscard]] std::string_view SdoAbortText(std::uint32_t code) noexcept;

/// Request to read an object.
[[nodiscard]] CanFrame SdoReadFrame(std::uint8_t node_id, std::uint16_t index, std::uint8_t sub) noexcept;
/// Request to write 1, 2 or 4 bytes (expedited).
[[nodiscard]] CanFrame SdoWriteFrame(std::uint8_t node_id, std::uint16_t index, std::uint8_t sub,
                                     std::uint8_t size, std::uint32_t value) noexcept;
/// Abort from the client.
[[nodiscard]] CanFrame SdoAbortFrame(std::uint8_t node_id, std::uint16_t index, std::uint8_t sub,
                                     std::uint32_t code) noexcept;

/// One expedited SDO transfer with one node, as a step machine: frames and elapsed cycles are handed in.
class SdoTransfer {
 public:
  enum class State : std::uint8_t {
    kIdle,
    kWaiting,
    kDone,
    kAborted,  ///< by the drive
    kTimedOut,
    kSegmented,   ///< the drive wants to send in segments; no object of ours is longer than four bytes
    kUnexpected,  ///< a reply to something else than was asked; value() is its first byte
  };

  void StartRead(std::uint8_t node_id, std::uint16_t index, std::uint8_t sub,
                 std::uint64_t deadline_cycles) noexcept;
  void StartWrite(std::uint8_t node_id, std::uint16_t index, std::uint8_t sub, std::uint8_t size,
                  std::uint32_t value, std::uint64_t deadline_cycles) noexcept;
  void Cancel() noexcept { state_ = State::kIdle; }

  /// The request, to be sent once after a Start.
  [[nodiscard]] const CanFrame& request() const noexcept { return request_; }

  /// A frame from the bus. True when it is this transfer's reply; replies to earlier requests are passed
  /// over.
  bool OnFrame(const CanFrame& frame) noexcept;
  /// Time goes on; the transfer times out when its deadline passes.
  void Elapse(std::uint64_t cycles) noexcept;

  [[nodiscard]] State state() const noexcept { return state_; }
  /// Read, in kDone; bytes that the drive wants to send, in kSegmented, 0 when it does not say.
  [[nodiscard]] std::uint32_t value() const noexcept { return value_; }
  /// In kAborted; what the drive is to be sent, in kSegmented and kUnexpected.
  [[nodiscard]] std::uint32_t abort_code() const noexcept { return abort_code_; }
  [[nodiscard]] std::uint64_t waited_cycles() const noexcept { return waited_; }

 private:
  void Start(const CanFrame& request, bool write, std::uint64_t deadline_cycles) noexcept;
  void End(State state, std::uint32_t value, std::uint32_t abort_code) noexcept;

  CanFrame request_{};
  std::uint64_t deadline_ = 0;
  std::uint64_t waited_ = 0;
  std::uint32_t value_ = 0;
  std::uint32_t abort_code_ = 0;
  State state_ = State::kIdle;
  bool write_ = false;
};

}  // namespace contour
