#pragma once

#include <cstdint>

#include "core/cycle_record.h"
#include "core/reason.h"
#include "daemon/rt/transitions.h"
#include "drivers/cia402/drive_master.h"

namespace contour {

/// Keeps what the drives said when the machine's reason arose: what the reason's text tells must not be how
/// things stand after the stop.
class ReasonWatch {
 public:
  explicit ReasonWatch(std::uint32_t cycle_us) noexcept : cycle_us_(cycle_us) {}

  /// Once a cycle, after the machine's state has been decided and before anything is sent.
  void Update(const Transitions& machine, const DriveMaster& master) noexcept;

  [[nodiscard]] const ReasonDetail& detail() const noexcept { return detail_; }

 private:
  /// An emergency message may come a little after what it explains.
  static constexpr std::uint32_t kSoonAfter_cycles = 20;

  void Arose(const DriveMaster& master, std::uint32_t stayed_cycles) noexcept;
  void LookForSlowStops(const DriveMaster& master) noexcept;
  [[nodiscard]] bool OfDrive(const DriveMaster& master) const noexcept;

  std::uint32_t cycle_us_;
  Reason reason_ = Reason::kNone;
  std::uint8_t where_ = 0xFF;
  std::uint32_t age_ = 0;
  ReasonDetail detail_;
};

}  // namespace contour
