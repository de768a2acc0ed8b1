#pragma once

#include <array>
#include <cstdint>

#include "core/state_keeper.h"
#include "core/two_inertia_axis.h"
#include "core/two_inertia_loop.h"
#include "estimator/gaussian.h"

namespace contour {

/// Forces of one period.
struct PeriodForces {
  std::array<double, 2> input_N{};  ///< of the drive, as TwoInertiaLoop has them
  double motor_N = 0.0;             ///< on the motor beside it, towards positive position
  double table_N = 0.0;             ///< on the table as far as known, against positive motion
};

/// What a newton on the motor, towards positive position, does to the motion over one period.
[[nodiscard]] LoopMotion MotionFromMotorForce(TwoInertiaAxis axis, double period_s);

/// Motor, screw and table: where they are by the motor's encoder and the torque that was given, and what
/// force acts on the table beyond what is known. The stationary Kalman filter of TwoInertiaLoop, in
/// positions: known forces, friction along the reference among them, are inputs, so that it finds deviations
/// from what was expected.
class TwoInertiaObserver {
 public:
  struct Setup {
    TwoInertiaAxis axis;
    TwoInertiaLoop loop;
    double period_s = 1e-3;
    double measurement_std_m = 1e-8;
    InnovationGate gate;
    double sudden_m = 0.0;  ///< see SuddenGate
  };
  struct Seen {
    double innovation_m = 0.0;
    double innovation_std_m = 0.0;
    bool gated = false;
  };

  explicit TwoInertiaObserver(const Setup& setup);

  /// At rest there, under no force.
  void Reset(double position_m) noexcept;
  /// To the next sample.
  void Predict(const PeriodForces& forces) noexcept;
  Seen Correct(double position_m) noexcept;
  /// Where the next sample will find the axis.
  [[nodiscard]] LoopMotion Ahead(const PeriodForces& forces) const noexcept;

  [[nodiscard]] const LoopMotion& motion() const noexcept { return motion_; }
  [[nodiscard]] double disturbance_N() const noexcept { return disturbance_N_; }
  [[nodiscard]] const TwoInertiaLoop& loop() const noexcept { return loop_; }
  [[nodiscard]] bool Sound() const noexcept;

  void Keep(StateKeeper& keep) noexcept { keep(motion_, disturbance_N_, gate_, gated_in_a_row_); }

 private:
  TwoInertiaLoop loop_;
  LoopMotion motion_from_motor_force_{};
  double period_s_;
  double innovation_std_m_;
  SuddenGate gate_;
  LoopMotion motion_{};
  double disturbance_N_ = 0.0;
  std::uint32_t gated_in_a_row_ = 0;
};

}  // namespace contour
