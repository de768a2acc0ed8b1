#pragma once

#include <cstdint>

#include "config/machine_config.h"
#include "core/axis.h"
#include "core/cycle_input.h"

namespace contour::faults {

/// The motion of a run, made point by point: up to the feed by a smooth ramp, on at that feed, once to and
/// fro if asked, and to rest at the latest where the travel ends.
class TestPath {
 public:
  struct Shape {
    double feed_m_s = 0.0;    ///< of the axes that move, along each
    int direction = 1;        ///< of the first motion
    double constant_s = 0.2;  ///< at feed before a reversal
    bool reverses = false;
    double end_s = 10.0;  ///< comes to rest by itself then
  };
  /// `moves`: which axes do; a ramp stays within 70 % of their acceleration and jerk, the travel within 80 %
  /// of the way from the start to the nearer limit.
  TestPath(const Shape& shape, const MachineConfig& machine, const PerAxis<double>& start_m,
           const PerAxis<bool>& moves, std::uint32_t program_id);

  /// False when the last point has been given before.
  bool Next(PathPoint& point);

  [[nodiscard]] double ramp_s() const noexcept { return ramp_s_; }
  /// When the motion turns, from its start.
  [[nodiscard]] double reversal_s() const noexcept {
    return ramp_s_ + shape_.constant_s + 0.5 * TurnRamp_s();
  }

 private:
  enum class Part : std::uint8_t { kUp, kConstant, kTurn, kAway, kDown, kEnded };
  [[nodiscard]] double TurnRamp_s() const noexcept { return 2.0 * ramp_s_; }
  [[nodiscard]] double Ramp_s(const MachineConfig& machine) const;
  void Begin(Part part, double from_m_s, double to_m_s, double seconds);

  Shape shape_;
  PerAxis<double> start_m_;
  PerAxis<bool> moves_;
  std::uint32_t program_id_;
  double period_s_;
  double ramp_s_ = 0.0;
  double travel_m_ = 0.0;  ///< allowed to either side

  Part part_ = Part::kUp;
  std::uint64_t index_ = 0;       ///< of the next point
  std::uint64_t part_index_ = 0;  ///< points since the part began
  double part_s_ = 0.0;           ///< how long it lasts
  double part_begin_m_ = 0.0;
  double from_m_s_ = 0.0;
  double to_m_s_ = 0.0;
};

}  // namespace contour::faults
