#pragma once

#include <cstdint>
#include <optional>

namespace contour {

/// What an axis at rest can be held to, from its own numbers.
struct StandstillBounds {
  double step_N = 0.0;        ///< the smallest change of the force that can be sent
  double step_moves_m = 0.0;  ///< what it moves an axis that friction holds; 0: the axis is never left alone
  double count_m = 0.0;       ///< of the encoder
  double period_s = 1e-3;
  double swings_s = 0.0;  ///< period in which the axis swings on its bristles
  /// Without a scale, what the table may be off by from where the observer has it is a share of what friction
  /// winds the screw up by: a screw stiffer than stated. A loop that has not come to rest by itself is
  /// stopped within this. 0: never.
  double doubt_m = 0.0;
  double relief_N = 0.0;  ///< by which the force gives way when a table that slides is stopped so
};

/// An axis at rest: its friction and its loop, at the table.
struct RestingAxis {
  double mass_kg = 0.0;
  double step_N = 0.0;         ///< of the torque
  double friction_N = 0.0;     ///< Coulomb, of the direction that has less of it
  double stiffness_N_m = 0.0;  ///< of the screw; 0: the table is where it is measured
  double sigma0_N_m = 0.0;
  double sigma1_Ns_m = 0.0;
  double regulator_Hz = 0.0;
};
/// What holds it.
enum class Holder : std::uint8_t {
  kFriction,        ///< a constant torque, and friction
  kLoopFewSteps,    ///< its loop: friction holds too few steps of torque
  kLoopLongRinging  ///< its loop, the stiffer of both: bristles would ring on from one correction to the next
};
[[nodiscard]] Holder WhatHolds(const RestingAxis& axis) noexcept;
/// What a step of the torque moves it by, whatever holds it.
[[nodiscard]] double StepMoves_m(const RestingAxis& axis) noexcept;
[[nodiscard]] StandstillBounds BoundsOf(const RestingAxis& axis, double count_m, double period_s) noexcept;

/// Steps of torque that friction must hold for an axis to be left alone at rest.
inline constexpr double kHeldSteps = 5.0;
/// Of rated torque: the unit of torques on the bus.
inline constexpr double kTorqueStep = 1e-3;

/// An axis at rest within friction. A loop that answers there what is smaller than a step of torque steps to
/// and fro, friction gives way under that shaking, and the axis creeps or hunts. So it is held by a constant
/// force. Where that leaves it off by more than a step moves, the force goes over to the next step, gently:
/// the shares of both shift over some time, so that nothing rings. What is larger is for the loop.
///
/// A loop that leads its motor by the wind-up of a screw that is stiffer than stated drives the table the way
/// the force goes: dF moves it by dF (1/K - 1/K_true), bristles answer with sigma0 times that, and from
/// sigma0 (1/K - 1/K_true) = 1 on it hunts from one level of friction to the other, for good. A constant
/// force does not. So one that the loop has not brought to rest in time is held where its error is within the
/// doubt.
class Standstill {
 public:
  Standstill() noexcept = default;
  explicit Standstill(const StandstillBounds& bounds) noexcept;

  void Forget() noexcept;
  /// What there is to move in the cycles to come.
  enum class Motion : std::uint8_t {
    kNone,
    /// Of other axes of the path: an axis that waits its turn is near the level of its friction, where the
    /// bristles give way for next to nothing, and a constant force lets it creep. The loop goes on holding
    /// it.
    kOfOthers,
    kOwn  ///< or an experiment pushes
  };
  /// Once per cycle. `error_m`: the table as the observer sees it, beyond where it is to be; `sent_N`: what
  /// was sent last. The force to hold it by; nothing: the loop has to act.
  std::optional<double> Step(double error_m, double sent_N, Motion motion) noexcept;
  /// Before the first Step of an axis that has just been enabled: friction goes on holding it where it stood,
  /// without a torque, as before. A loop that begins to act there moves it by what it reads wrong. Where that
  /// does not hold it, the loop acts with the first reading that is off by what ends standing. An axis under
  /// a force, such as a weight, is the loop's from the beginning: whether friction, a brake or nothing bears
  /// it is not known.
  void Begin(double error_m, double planned_N) noexcept;

  [[nodiscard]] bool standing() const noexcept { return standing_; }

 private:
  [[nodiscard]] double Held_N(double error_m, double sent_N) noexcept;
  void Leave() noexcept;
  [[nodiscard]] double Doubt_m() const noexcept;
  void Stand(double size_m, double doubt_m) noexcept;
  void Watch(double error_m) noexcept;
  void Correct(double mean_m) noexcept;

  StandstillBounds bounds_;
  double share_ = 1.0;          ///< of the means, per cycle
  int settle_ = 1, watch_ = 1;  ///< cycles
  double ramp_s_ = 0.0;         ///< from one step of torque to the next
  double patience_ = 0.0;       ///< per cycle

  double waits_ = 1.0;     ///< how much more than a small error it is let off with, growing at rest
  double mean_m_ = 0.0;    ///< of the error
  double mean_N_ = 0.0;    ///< of what was sent
  double sum_m_ = 0.0;     ///< of errors while it is watched
  double begun_m_ = 0.0;   ///< error when it became small
  double unit_m_ = 0.0;    ///< the most that a step moves, as far as it has been seen
  double shown_m_ = 0.0;   ///< the same as means of many readings show it, finer than one count
  double moves_m_ = 0.0;   ///< what one moved last
  double before_m_ = 0.0;  ///< error before them
  double steps_ = 0.0;     ///< of the last correction
  double ramp_N_ = 0.0;    ///< per cycle
  double target_N_ = 0.0;  ///< one that can be sent
  double held_N_ = 0.0;    ///< on its way there
  double carry_N_ = 0.0;   ///< what rounding has kept back of it
  int quiet_ = 0;          ///< cycles in a row with a small error
  int since_ = 0;          ///< cycles since the target was reached
  double acts_s_ = 0.0;    ///< for which the loop has held an axis at rest, without coming to stand
  bool started_ = false;
  bool standing_ = false;
  bool untried_ = false;  ///< under a force that has not held it for long
  bool doubted_ = false;  ///< what holds it is within the doubt, and not corrected
};

}  // namespace contour
