#pragma once

#include <string>
#include <vector>

#include "core/cycle_record.h"
#include "tools/plant_emulator/truth.h"

namespace contour::faults {

/// Compares the machine's truth with the path that was commanded, cycle by cycle. Motor side, as travel of
/// the table. What contourd believes of the axes is not asked.
class TruthWatch {
 public:
  TruthWatch(std::size_t axes, double period_s) : period_s_(period_s), axes_(axes) {}

  /// Cycles before the fault, with the truth of the instant that the record is about.
  void Pair(const CycleRecord& record, const TruthRow& truth) noexcept {
    paired_cycle_ = record.cycle;
    paired_s_ = truth.time_s;
  }
  /// The fault is there from now on.
  void Begin(const TruthRow& newest) noexcept;
  /// From the fault on this axis has no torque, whatever its drive's state.
  void SetPowerless(std::size_t axis) { axes_[axis].powerless = true; }
  /// Every cycle. `holds`: the machine follows a commanded path; after that the path ends where it had come
  /// to.
  void Follow(const CycleRecord& record, const TruthRow& newest, bool holds) noexcept;

  /// Largest departure of an axis that was under torque.
  [[nodiscard]] double departure_m(std::size_t axis) const { return axes_[axis].departure_m; }
  /// From the fault to the last instant at which it moved under torque.
  [[nodiscard]] double moving_until_s(std::size_t axis) const { return axes_[axis].moving_until_s; }
  [[nodiscard]] double since_fault_s() const noexcept { return now_s_ - begin_s_; }

  /// The drive controls the motor, or current still flows.
  static bool UnderTorque(const AxisTruth& truth) noexcept;
  static bool AtRest(const AxisTruth& truth) noexcept;

 private:
  struct Axis {
    double commanded_m = 0.0;
    bool has_command = false;
    bool powerless = false;
    double zero_m = 0.0;    ///< where the encoder began to count, before the fault
    double stands_m = 0.0;  ///< true position less commanded, of a fault that came first
    double departure_m = 0.0;
    double moving_until_s = 0.0;
  };
  double period_s_;
  std::uint64_t paired_cycle_ = 0;
  double paired_s_ = 0.0;
  bool begun_ = false;
  double begin_s_ = 0.0;
  double now_s_ = 0.0;
  std::vector<Axis> axes_;
};

}  // namespace contour::faults
