#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "tools/plant_emulator/emulator_config.h"
#include "tools/plant_emulator/notch_filter.h"
#include "tools/plant_emulator/portable_math.h"
#include "tools/plant_emulator/rest_watch.h"

namespace contour::plant {

/// Where the drive is told to be, at one tick of its position loop. Motor side, as travel of the table.
struct CascadeTarget {
  double position_m = 0.0;
  double velocity_m_s = 0.0;
  double acceleration_m_s2 = 0.0;
};

/// Smooths the targets of successive SYNCs: a uniform quadratic B-spline through them, so that position and
/// velocity are continuous and acceleration is constant between SYNCs. It runs half a period behind the
/// targets.
class TargetInterpolator {
 public:
  void Reset(double position_m) noexcept { old_ = middle_ = new_ = position_m; }
  void Push(double position_m) noexcept {
    old_ = middle_;
    middle_ = new_;
    new_ = position_m;
  }
  /// `u` in [0, 1]: share of the interpolation period since the last SYNC; held beyond.
  [[nodiscard]] CascadeTarget At(double u, double period_s) const noexcept {
    u = std::clamp(u, 0.0, 1.0);
    const double position =
        0.5 * ((1.0 - u) * (1.0 - u) * old_ + (1.0 + 2.0 * u * (1.0 - u)) * middle_ + u * u * new_);
    const double velocity = ((1.0 - u) * (middle_ - old_) + u * (new_ - middle_)) / period_s;
    const double acceleration = (new_ - 2.0 * middle_ + old_) / (period_s * period_s);
    return {position, velocity, acceleration};
  }

 private:
  double old_ = 0.0;
  double middle_ = 0.0;
  double new_ = 0.0;
};

/// The drive's own cascade at its tick: position P, velocity PI with feed-forward, and a second set of gains
/// for an axis that rests, where the first would only answer to the noise of its readings. With a dual loop
/// the position is the scale's up to a frequency, and the motor's above it. In travel of the table; the
/// output is an acceleration, which the drive turns into torque by its inertia.
class DriveCascade {
 public:
  DriveCascade(const EmulatedCascadeConfig& gains, double tick_s, double count_m) noexcept
      : gains_(gains),
        tick_s_(tick_s),
        rest_(gains, tick_s, count_m),
        notch_(gains.notch_Hz, gains.notch_width, gains.notch_depth, tick_s),
        scale_share_(1.0 - portable::Exp(-6.283185307179586 * gains.dual_loop_Hz * tick_s)),
        mean_share_(1.0 - portable::Exp(-kSmoothingsPerRest * 1e3 * tick_s / gains.rest_delay_ms)),
        filter_share_(1.0 - portable::Exp(-6.283185307179586 * gains.velocity_filter_Hz * tick_s)) {}

  /// Encoder reading, so many ticks after the one before: a SYNC out of its time re-phases them. Velocity is
  /// the filtered difference.
  void Sense(double position_m, double ticks) noexcept {
    if (sensed_)
      velocity_m_s_ += filter_share_ * ((position_m - position_m_) / tick_s_ - velocity_m_s_ * ticks);
    position_m_ = position_m;
    sensed_ = true;
  }
  /// The linear scale at a tick, for a drive with a dual loop.
  void SenseScale(double position_m) noexcept {
    beyond_m_ += scale_share_ * (position_m - position_m_ - beyond_m_);
  }
  /// What a loop begins with. The table is where it is: a dual loop goes to the scale by and by.
  void Begin() noexcept {
    ResetIntegral();
    notch_.Reset();
    beyond_m_ = 0.0;
  }
  /// The gains are those of motion.
  void ResetIntegral() noexcept {
    integral_m_s_ = mean_m_s2_ = 0.0;
    share_ = 1.0;
    rest_.Reset();
  }

  double PositionLoop_m_s2(const CascadeTarget& target, double limit_m_s2) noexcept {
    TakeShare(rest_.Rests(target.position_m, controlled_position_m()) ? gains_.rest_gain_rel : 1.0);
    const double wanted = gains_.velocity_feedforward * target.velocity_m_s +
                          share_ * gains_.position_gain_1_s * (target.position_m - controlled_position_m());
    const double held =
        VelocityLoop_m_s2(wanted, gains_.acceleration_feedforward * target.acceleration_m_s2, limit_m_s2);
    mean_m_s2_ += mean_share_ * (held - mean_m_s2_);
    return held;
  }

  double VelocityLoop_m_s2(double wanted_m_s, double feedforward_m_s2, double limit_m_s2) noexcept {
    const double error = wanted_m_s - velocity_m_s_;
    const double free =
        notch_.Step(feedforward_m_s2 + share_ * gains_.velocity_gain_1_s * (error + integral_m_s_));
    const double held = std::clamp(free, -limit_m_s2, limit_m_s2);
    // The integral stands still while the limit holds the output and the error would push it further.
    if (held == free || (free > held) != (error > 0.0))
      integral_m_s_ += share_ * gains_.velocity_integral_1_s * tick_s_ * error;
    return held;
  }

  /// Of the motor.
  [[nodiscard]] double position_m() const noexcept { return position_m_; }
  /// What the position loop is closed on.
  [[nodiscard]] double controlled_position_m() const noexcept { return position_m_ + beyond_m_; }
  [[nodiscard]] double velocity_m_s() const noexcept { return velocity_m_s_; }

 private:
  /// Without a bump: the integral goes on with the torque that held the axis. What it has at one instant is,
  /// with the gains of motion, the noise of a reading; on the way into rest it takes the mean.
  void TakeShare(double share) noexcept {
    if (share == share_) return;
    if (share < share_)
      integral_m_s_ = mean_m_s2_ / (share * gains_.velocity_gain_1_s);
    else
      integral_m_s_ *= share_ / share;
    share_ = share;
  }

  static constexpr double kSmoothingsPerRest =
      4.0;  ///< time constants of the mean in the time rest is awaited

  EmulatedCascadeConfig gains_;
  double tick_s_;
  RestWatch rest_;
  NotchFilter notch_;
  double scale_share_;      ///< of the low-pass between motor and scale
  double beyond_m_ = 0.0;   ///< scale less motor, below the dual loop's frequency
  double share_ = 1.0;      ///< of the gains
  double mean_share_;       ///< of the low-pass on the output
  double mean_m_s2_ = 0.0;  ///< the output, smoothed
  double filter_share_;
  double position_m_ = 0.0;
  double velocity_m_s_ = 0.0;
  double integral_m_s_ = 0.0;
  bool sensed_ = false;
};

}  // namespace contour::plant
