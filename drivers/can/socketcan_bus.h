#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

#include "drivers/can/frame_bus.h"

namespace contour {

/// The environment lacks a bus; what() names the interface, the cause and what to do. Programs end with
/// status 3.
class BusUnavailable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A SocketCAN interface (can0, vcan0, ...) through CAN_RAW, in non-blocking batches: one recvmmsg or
/// sendmmsg takes a whole cycle's frames. Receive and Send make these system calls, and read the clock to
/// place time stamps; nothing else of the real-time side does.
///
/// - Time stamps are the kernel's (end of reception, CLOCK_REALTIME), moved to CLOCK_MONOTONIC, the loop's
/// clock, by
///   the difference of the two clocks at the call.
/// - A full transmit queue (ENOBUFS), a link that is down (ENETDOWN) and a vanished interface are counted as
/// send
///   failures. The link counts as up again as soon as a frame is taken or seen; a vanished interface is bound
///   again when it comes back.
/// - bus_off is set by an error frame, and stays until the controller restarts, or until a data frame is
/// received in a
///   later call; at least one call of State() sees it.
/// - A link that comes up again has a controller that counts its errors anew, and is not bus-off.
/// - Only data frames with 11-bit identifiers are passed on.
/// - With `nodes`, our own SYNCs come back as kOwnFrame | 0x080, with the time at which the controller had
/// sent them
///   (drivers without an echo of their own: at which it took them).
class SocketCanBus : public FrameBus {
 public:
  /// Opens and binds. With `nodes`, the kernel passes on only what concerns them: every frame of theirs or to
  /// them in the predefined connection set, NMT, SYNC and all heartbeats; without, everything. Throws
  /// BusUnavailable when there is no CAN in the kernel, no such interface, no permission.
  explicit SocketCanBus(const std::string& interface, std::span<const int> nodes = {});
  ~SocketCanBus() override;
  SocketCanBus(const SocketCanBus&) = delete;
  SocketCanBus& operator=(const SocketCanBus&) = delete;

  std::size_t Receive(std::int64_t now_ns, std::span<StampedFrame> frames) noexcept override;
  std::size_t Send(std::int64_t now_ns, std::span<const CanFrame> frames) noexcept override;
  [[nodiscard]] BusState State() const noexcept override { return state_; }

  [[nodiscard]] int fd() const noexcept override { return fd_; }
  [[nodiscard]] const std::string& interface() const noexcept { return interface_; }
  /// errno of the last failure to send or receive; 0 none. For messages.
  [[nodiscard]] int last_error() const noexcept { return last_error_; }

 private:
  struct Batch;  ///< buffers of the system calls

  void Open(std::span<const int> nodes);
  void SetFilters(std::span<const int> nodes);
  [[nodiscard]] bool Bind() noexcept;
  std::size_t TakeBatch(std::size_t count, std::int64_t to_monotonic_ns,
                        std::span<StampedFrame> frames) noexcept;
  void OnFailure(int error) noexcept;
  void CountAsUp() noexcept;
  void TryBindAgain() noexcept;

  std::string interface_;
  std::unique_ptr<Batch> batch_;
  int fd_ = -1;
  int last_error_ = 0;
  std::int64_t down_ns_ = 0;  ///< when it was last seen to be down, by CLOCK_MONOTONIC
  std::uint32_t overflows_seen_ = 0;
  std::uint32_t calls_unbound_ = 0;
  bool bound_ = false;
  bool bus_off_is_new_ = false;
  bool tells_own_ = false;
  BusState state_;
};

/// Waits until one of the descriptors is readable or CLOCK_MONOTONIC reaches the deadline; true when
/// readable. Uses ppoll, whose timeout has the resolution of the high-resolution timers (SO_RCVTIMEO would
/// round to jiffies).
[[nodiscard]] bool WaitReadable(std::span<const int> fds, std::int64_t deadline_monotonic_ns) noexcept;

}  // namespace contour
