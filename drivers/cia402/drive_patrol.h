#pragma once

#include <cstdint>
#include <vector>

#include "core/can_frame.h"
#include "core/state_keeper.h"
#include "drivers/cia301/bring_up.h"
#include "drivers/cia301/sdo_transfer.h"

namespace contour {

/// One SDO at most in this time: what the bus arithmetic of config/bus_timing.cc reckons with.
inline constexpr std::uint32_t kPatrolGap_us = 2'000;
/// Each drive's mode of operation is read once in this time.
inline constexpr std::uint32_t kPatrolPeriod_us = 100'000;

/// A drive to be asked while it runs.
struct PatrolledDrive {
  std::uint8_t node_id = 0;
  std::uint8_t mode = 0;  ///< of operation, as 0x6061 must show it
  std::uint64_t sdo_cycles = 0;
};

/// Asks the drives of one bus over SDO while PDOs run, one object at a time and seldom: 0x6061 in turn, and
/// 0x1003 (what the drive itself remembers of errors) after the start and after each error. No answer is no
/// fault, a service tool may be in the way; another mode than the one that was set is remembered.
class DrivePatrol {
 public:
  DrivePatrol() = default;
  DrivePatrol(std::vector<PatrolledDrive> drives, std::uint32_t cycle_us);

  /// The drives have just been brought up: forgets all that was found.
  void Start() noexcept;
  void Stop() noexcept;
  /// A frame of this bus; SDO replies concern it.
  void OnFrame(const CanFrame& frame) noexcept;
  /// This drive has had an error: 0x1003 is to be read.
  void ReadErrors(std::size_t drive) noexcept;
  /// One cycle; appends a request when one is due.
  void Step(std::uint64_t elapsed_cycles, BringUp::Frames& out) noexcept;

  [[nodiscard]] bool mode_changed(std::size_t drive) const noexcept { return states_[drive].mode_changed; }

  /// The drives stay as constructed.
  void Keep(StateKeeper& keep) noexcept {
    keep(states_, transfer_, asked_, errors_, sub_, now_, free_at_, look_at_, running_);
  }

 private:
  struct State {
    bool mode_changed = false;
    bool errors_due = false;
    std::uint8_t next_error = 0;  ///< sub-index of 0x1003
    std::uint8_t errors = 0;      ///< how many there are
    std::uint64_t mode_at = 0;    ///< when its mode is next read
    std::uint64_t quiet_until = 0;
  };
  void Take() noexcept;
  void Ask(std::size_t drive, bool errors, BringUp::Frames& out) noexcept;
  [[nodiscard]] bool Due(std::size_t drive) const noexcept;

  std::vector<PatrolledDrive> drives_;
  std::vector<State> states_;
  std::uint64_t gap_ = 2;
  std::uint64_t period_ = 100;
  SdoTransfer transfer_;
  std::size_t asked_ = 0;  ///< the drive of the transfer
  bool errors_ = false;    ///< the transfer reads 0x1003, not 0x6061
  std::uint8_t sub_ = 0;   ///< of the transfer
  std::uint64_t now_ = 0;
  std::uint64_t free_at_ = 0;  ///< no request before
  std::uint64_t look_at_ = 0;  ///< nothing is due before
  bool running_ = false;
};

}  // namespace contour
