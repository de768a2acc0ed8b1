#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

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
/// from what was expected. With a linear scale the table is where the scale has it, and the motor where the
/// commissioned screw puts it from there; what the encoder is off by beyond is a state of its own.
class TwoInertiaObserver {
 public:
  struct Setup {
    TwoInertiaAxis axis;
    TwoInertiaLoop loop;
    double period_s = 1e-3;
    double measurement_std_m = 1e-8;
    InnovationGate gate;
    double sudden_m = 0.0;                       ///< see SuddenGate
    std::optional<TwoInertiaLoop> scale_loop{};  ///< with the linear scale
  };
  struct Seen {
    double innovation_m = 0.0;
    double innovation_std_m = 0.0;
    bool gated = false;
  };

  explicit TwoInertiaObserver(const Setup& setup);

  /// At rest there, under no force.
  void Reset(double position_m) noexcept;
  /// The same with the table there, by the scale.
  void Reset(double position_m, double table_m) noexcept;
  /// The scale is not believed any more: the motor is where its encoder is, its velocity as it was, the table
  /// behind by the wind-up of the force through the screw, under `disturbance_N`.
  void GoOnByMotor(double position_m, double screw_N, double disturbance_N) noexcept;
  /// To the next sample. What encoder and scale are apart by beyond the wind-up changes by `beyond_m`.
  void Predict(const PeriodForces& forces, double beyond_m = 0.0) noexcept;
  Seen Correct(double position_m) noexcept;
  /// By both. No reading of the scale in this cycle: the table is where it was expected.
  Seen Correct(double position_m, std::optional<double> table_m) noexcept;
  /// Where the next sample will find the axis.
  [[nodiscard]] LoopMotion Ahead(const PeriodForces& forces) const noexcept;

  [[nodiscard]] const LoopMotion& motion() const noexcept { return motion_; }
  /// Encoder before the motor of motion(); 0 without a scale.
  [[nodiscard]] double beyond_m() const noexcept { return beyond_m_; }
  [[nodiscard]] double disturbance_N() const noexcept { return disturbance_N_; }
  [[nodiscard]] const TwoInertiaLoop& loop() const noexcept { return loop_; }
  [[nodiscard]] bool Sound() const noexcept;

  void Keep(StateKeeper& keep) noexcept {
    keep(motion_, disturbance_N_, beyond_m_, gate_, unseen_periods_, seldom_readings_, again_readings_,
         gated_in_a_row_, gated_m_);
  }

 private:
  bool CameSeldom(double innovation_m) noexcept;
  using Gain = std::array<std::array<double, 2>, kObserverStates>;
  Seen Judge(double innovation_m, double std_m) noexcept;
  bool AgreesWithGated(double position_m) noexcept;
  void GoOnByGated(double position_m, double table_m) noexcept;

  TwoInertiaLoop loop_;
  Gain scale_gain_{};
  double stiffness_N_m_;
  double mass_kg_;
  LoopMotion motion_from_motor_force_{};
  double period_s_;
  double innovation_std_m_;
  double scale_innovation_std_m_;
  SuddenGate gate_;
  LoopMotion motion_{};
  double disturbance_N_ = 0.0;
  double beyond_m_ = 0.0;
  std::uint32_t unseen_periods_ = 0;   ///< since the newest reading that was used
  std::uint32_t seldom_readings_ = 0;  ///< for which one that came late is remembered
  std::uint32_t again_readings_ = 0;   ///< and that it was not the first
  std::uint32_t gated_in_a_row_ = 0;
  std::array<double, 2> gated_m_{};  ///< the newest readings that were left out, newest first
};

}  // namespace contour
