#pragma once

#include <algorithm>

namespace contour {

/// Over how long what holds an axis at rest is averaged: as far as the noise of its readings takes it, but
/// for no more than a share of the time that it has rested. Bristles give way ever more slowly: what did not
/// come down in a second hardly does so in the next tenth. And no longer than that, since what is believed
/// winds the screw up, bristles answer that, and a mean then takes several of its time constants to settle.
class RestingWindow {
 public:
  RestingWindow() noexcept = default;
  explicit RestingWindow(double period_s) noexcept : period_s_(period_s) {}

  void Move() noexcept { rested_s_ = 0.0; }
  /// A period of rest has passed. What of a new reading counts, where on a short rest or without noise it is
  /// `share`; `noise_takes_s`: over which the noise has to be averaged to be of no account.
  [[nodiscard]] double Rest(double share, double noise_takes_s) noexcept {
    rested_s_ = std::min(rested_s_ + period_s_, kLongest_s / kOfRest);
    return std::min(share, period_s_ / std::min(kOfRest * rested_s_, noise_takes_s));
  }

 private:
  // Where one axis waits for a side of a square, some tenths of a second, bristles are followed as they give
  // way; within the seconds of a hold nothing much is left of the noise.
  static constexpr double kOfRest = 0.125;
  // A force from outside that comes then is made up for within seconds.
  static constexpr double kLongest_s = 1.0;

  double period_s_ = 1e-3;
  double rested_s_ = 0.0;
};

}  // namespace contour
