#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "estimator/exponential.h"

namespace contour {

/// The first-order lag of a drive's current loop: f' = (u - f) / tau, with u held over one period. Followed
/// exactly, as mean force over each of Parts equal parts of the period. With a lag of 0.2 ms and a period of
/// 1 ms the mean over the period is 0.80 u(k) + 0.20 u(k-1).
template <std::size_t Parts>
class DriveLag {
 public:
  using Means = std::array<double, Parts>;

  DriveLag() noexcept = default;
  DriveLag(double period_s, double lag_s) noexcept {
    const double part_s = period_s / static_cast<double>(Parts);
    if (lag_s > 0.0) {
      decay_ = Exp(-part_s / lag_s);
      mean_ = lag_s / part_s * (1.0 - decay_);
    }
  }

  void Reset() noexcept { force_N_ = 0.0; }

  /// Mean force in each part of the next period under command `force_N`, without going there.
  [[nodiscard]] Means Look(double force_N) const noexcept {
    Means means{};
    double gap = force_N_ - force_N;
    for (auto& m : means) {
      m = force_N + mean_ * gap;
      gap *= decay_;
    }
    return means;
  }

  /// The same, and the period has passed.
  Means Step(double force_N) noexcept {
    const Means means = Look(force_N);
    for (std::size_t i = 0; i < Parts; ++i) force_N_ = force_N + decay_ * (force_N_ - force_N);
    return means;
  }

  /// Force that acts now.
  [[nodiscard]] double force_N() const noexcept { return force_N_; }

 private:
  double decay_ = 0.0;
  double mean_ = 0.0;
  double force_N_ = 0.0;
};

}  // namespace contour
