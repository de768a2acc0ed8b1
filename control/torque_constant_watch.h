#pragma once

#include <array>

#include "core/state_keeper.h"

namespace contour {

/// Watches what force an acceleration takes: u = k m a + F sgn(v) + b v by recursive least squares, one axis.
/// k is 1 where torque constant and mass are as stated; a drive that gives half the torque, or a table twice
/// as heavy, shows as k = 2. Only told, never acted upon.
class TorqueConstantWatch {
 public:
  /// `friction_N` sets what friction may vary by; `allowed_rel` is what k may be off before it is told.
  TorqueConstantWatch(double friction_N, double speed_m_s, double allowed_rel) noexcept;

  /// One sample of an axis that slides, low-passed alike: torque as force, m a as force, speed.
  void Learn(double force_N, double inertial_N, double velocity_m_s) noexcept;

  /// k is off by more than is allowed, and surely so.
  [[nodiscard]] bool changed() const noexcept { return changed_; }
  [[nodiscard]] double ratio() const noexcept { return theta_[0]; }
  /// What was learnt, not what it is held against.
  void Keep(StateKeeper& keep) noexcept { keep(theta_, p_, changed_); }

 private:
  [[nodiscard]] bool Changed() const noexcept;

  double noise_N2_;
  double allowed_log_;
  std::array<double, 3> theta_;
  std::array<std::array<double, 3>, 3> p_{};
  std::array<double, 3> prior_{};
  bool changed_ = false;
};

}  // namespace contour
