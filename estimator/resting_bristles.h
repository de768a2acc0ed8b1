#pragma once

#include "core/state_keeper.h"
#include "estimator/resting_window.h"

namespace contour {

/// What the bristles of an axis at rest still carry. Under a loop that holds it at one place they give way
/// within seconds, and the force that it needs for that comes down with them. Where it starts again from is
/// what they carry by then. Taken for a force from outside, the difference would be wrong twice: it does not
/// last, and the bristles come back along the way that follows.
class RestingBristles {
 public:
  RestingBristles() noexcept = default;
  /// `level_N`: of friction; `lasting_share`: of it, beyond which a force that comes at once is from outside.
  RestingBristles(double level_N, double lasting_share, double period_s) noexcept;

  /// The axis is no longer at rest.
  void Move() noexcept;
  /// A period of rest has passed. `carried_N`: by the bristles, as believed; `unexplained_N`: what the axis
  /// needs beyond what is believed, in the same direction; `noise_takes_s`: see RestingWindow. The factor by
  /// which the bristles carry less from now on, or as much again: never more than when the axis came to rest,
  /// nor the other way round.
  double Step(double carried_N, double unexplained_N, double noise_takes_s) noexcept;

  /// Constants stay as constructed.
  void Keep(StateKeeper& keep) noexcept { keep(share_, outside_N_, window_); }

 private:
  double most_unexplained_N_ = 0.0;
  double least_carried_N_ = 0.0;
  double rate_ = 1.0;  // per period

  double share_ = 1.0;  // of what they carried when the axis came to rest
  double outside_N_ = 0.0;
  RestingWindow window_;
};

}  // namespace contour
