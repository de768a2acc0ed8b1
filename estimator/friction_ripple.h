#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "estimator/turn.h"

namespace contour {

/// How the friction level varies over a turn of the screw: two harmonics of the lead per direction, as a
/// factor 1 + sum(a_i cos + b_i sin) on the level g, learnt on line by least mean squares. It belongs inside
/// g: as a force beside the bristle it would jump at a reversal.
class FrictionRipple {
 public:
  static constexpr std::size_t kTerms = 4;
  using Terms = std::array<double, kTerms>;

  FrictionRipple() noexcept = default;
  /// rate: share of the error taken over per radian of the screw.
  FrictionRipple(double lead_m, double rate) noexcept : per_turn_1_m_(1.0 / lead_m), rate_(rate) {}

  void Reset() noexcept { plus_ = minus_ = {}; }

  [[nodiscard]] Terms Basis(double position_m) const noexcept {
    const CosSin one = Turn(position_m * per_turn_1_m_);
    return {one.cos, one.sin, one.cos * one.cos - one.sin * one.sin, 2.0 * one.sin * one.cos};
  }

  /// Factor of the level, within +-kLargest.
  [[nodiscard]] double Factor(const Terms& basis, bool forward) const noexcept {
    const Terms& c = forward ? plus_ : minus_;
    double sum = 0.0;
    for (std::size_t i = 0; i < kTerms; ++i) sum += c[i] * basis[i];
    return 1.0 + std::clamp(sum, -kLargest, kLargest);
  }

  /// `excess`: measured level over the level expected with the present factor, minus one. Learns by the way
  /// travelled, so that standing still teaches nothing.
  void Learn(const Terms& basis, bool forward, double excess, double travel_m) noexcept {
    Terms& c = forward ? plus_ : minus_;
    constexpr double kTwoPi = 6.283185307179586;
    const double step = std::min(rate_ * std::abs(travel_m) * per_turn_1_m_ * kTwoPi, 0.5);
    for (std::size_t i = 0; i < kTerms; ++i) c[i] += step * excess * basis[i];
  }

  [[nodiscard]] const Terms& plus() const noexcept { return plus_; }
  [[nodiscard]] const Terms& minus() const noexcept { return minus_; }

 private:
  static constexpr double kLargest = 0.4;

  double per_turn_1_m_ = 0.0;
  double rate_ = 0.0;
  Terms plus_{};
  Terms minus_{};
};

}  // namespace contour
