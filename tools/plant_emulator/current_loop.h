#pragma once

#include "tools/plant_emulator/portable_math.h"

namespace contour::plant {

/// The drive's current loop: torque follows the command with a first-order lag, stepped exactly.
class CurrentLoop {
 public:
  explicit CurrentLoop(double lag_s) noexcept : lag_s_(lag_s) {}

  void SetCommand(double torque_Nm) noexcept { command_Nm_ = torque_Nm; }

  /// Advances by a step and returns the mean torque over it.
  double StepMean_Nm(double step_s) noexcept {
    if (lag_s_ <= 0.0) {
      torque_Nm_ = command_Nm_;
      return torque_Nm_;
    }
    if (step_s != step_s_) {
      step_s_ = step_s;
      decay_ = portable::DecayOver(step_s / lag_s_);
    }
    const double away = torque_Nm_ - command_Nm_;
    torque_Nm_ = portable::WithoutDust(command_Nm_ + away * decay_.remaining);
    return command_Nm_ + away * decay_.mean;
  }

  [[nodiscard]] double command_Nm() const noexcept { return command_Nm_; }
  /// Now: without a lag the command acts at once.
  [[nodiscard]] double torque_Nm() const noexcept { return lag_s_ > 0.0 ? torque_Nm_ : command_Nm_; }

 private:
  double lag_s_;
  double command_Nm_ = 0.0;
  double torque_Nm_ = 0.0;
  double step_s_ = -1.0;
  portable::Decay decay_;
};

}  // namespace contour::plant
