#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/cycle_record.h"
#include "core/mechanics.h"

namespace contour {

/// Where the table was on one pass of a program, seen by the scales, point by point.
///
/// A scale and an encoder count from different zeros, and the distance between them creeps with temperature.
/// What they have in common is known on average only: over a pass the table is where the motor says, less
/// what the force in the screw winds it up by.
class MeasuredPass {
 public:
  MeasuredPass() = default;
  MeasuredPass(std::vector<Mechanics> axes, std::size_t points, double period_s);

  /// A cycle in which the program ran, in order.
  void Add(const CycleRecord& record);

  /// Why nothing is to be learnt from it; empty: it may be.
  [[nodiscard]] std::string Problem() const;
  [[nodiscard]] std::size_t points() const { return points_; }
  [[nodiscard]] bool seen(std::size_t point) const { return seen_[point] != 0; }
  /// By how much the table was behind the reference that was followed; of a point that was seen.
  [[nodiscard]] double behind_m(std::size_t axis, std::size_t point) const;

 private:
  struct Axis {
    Mechanics mechanics;
    double zero_m = 0.0;          ///< scale less table at the first row
    double zero_change_m = 0.0;   ///< of later rows, summed up
    std::vector<float> behind_m;  ///< with the zero of the first row
    double first_motor_m = 0.0;
    double motor_square_m2 = 0.0;  ///< of the way from the first row, summed up, and times that of the scale
    double motor_scale_m2 = 0.0;
  };
  [[nodiscard]] bool ScaleFollowsMotor(const Axis& axis) const;
  [[nodiscard]] static double Zero_m(const Axis& axis, const AxisRecord& record);

  std::vector<Axis> axes_;
  std::size_t points_ = 0;
  double period_s_ = 0.0;
  std::vector<std::uint8_t> seen_;
  std::size_t count_ = 0;
  std::uint64_t last_cycle_ = 0;
  bool spoilt_ = false;
};

}  // namespace contour
