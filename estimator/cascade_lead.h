#pragma once

#include <algorithm>
#include <numbers>

#include "estimator/exponential.h"
#include "estimator/resting_window.h"

namespace contour {

/// Unforeseen friction where a drive closes its own loop, as the wind-up has it: low-passed, since the drive
/// answers it by itself and only the screw behind the encoder is left to make up for.
class CascadeLead {
 public:
  struct Tuning {
    double lead_Hz = 8.0;          ///< while the axis moves
    double lead_at_rest_Hz = 0.4;  ///< only the noise of the reported torque is left of it
    /// A torque of up to this share of the friction level need not come through the screw of an axis that has
    /// not moved yet: cogging pulls at the motor as well, and as the bristles give way more and more of it is
    /// held.
    double held_share = 0.3;
    /// In motion too what is found is averaged, until its noise is of no account: where a drive answers every
    /// count of a coarse encoder.
    bool averages_noise = false;
  };

  CascadeLead() noexcept = default;
  CascadeLead(const Tuning& tuning, double period_s) noexcept
      : held_share_(tuning.held_share),
        moving_share_(-Expm1(-2.0 * std::numbers::pi * tuning.lead_Hz * period_s)),
        rest_share_(-Expm1(-2.0 * std::numbers::pi * tuning.lead_at_rest_Hz * period_s)),
        averages_noise_(tuning.averages_noise),
        period_s_(period_s),
        window_(period_s) {}

  void Reset() noexcept {
    lead_N_ = 0.0;
    moved_ = false;
    window_.Move();
  }
  /// `noise_takes_s`: see RestingWindow. What a low-pass leaves of the noise's variance is half its share per
  /// period.
  void Step(double unexplained_N, double level_N, bool at_rest, double noise_takes_s) noexcept {
    moved_ = moved_ || !at_rest;
    if (!at_rest) window_.Move();
    const double held_N = moved_ ? 0.0 : held_share_ * level_N;
    const double gap_N = unexplained_N - lead_N_;
    const double share = at_rest           ? window_.Rest(rest_share_, noise_takes_s)
                         : averages_noise_ ? std::min(moving_share_, 2.0 * period_s_ / noise_takes_s)
                                           : moving_share_;
    lead_N_ += share * (gap_N - std::min(std::max(gap_N, -held_N), held_N));
  }
  [[nodiscard]] double lead_N() const noexcept { return lead_N_; }

 private:
  double held_share_ = 0.0;
  double moving_share_ = 1.0;  // per period
  double rest_share_ = 1.0;
  bool averages_noise_ = false;
  double period_s_ = 1e-3;
  double lead_N_ = 0.0;
  bool moved_ = false;  // since the start
  RestingWindow window_;
};

}  // namespace contour
