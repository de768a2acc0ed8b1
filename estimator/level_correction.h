#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/wide_numbers.h"
#include "estimator/exponential.h"
#include "estimator/share_of_period.h"
#include "estimator/turn.h"

namespace contour {

/// What the commissioned friction level lacks, per direction, as a factor 1 + sum(c_i f_i) on g: two
/// harmonics of the screw's turn (ripple) and a rise at low speed (a wrong Stribeck curve). It belongs inside
/// g: as a force beside the bristle it would jump at a reversal.
///
/// Learnt on line by least mean squares from how far the estimated bristle is from the one rolled along the
/// reference. The bristle follows its level only as fast as it relaxes, so each term is passed through the
/// same relaxation first: in presliding, where the level has no say, nothing is learnt.
class LevelCorrection {
 public:
  static constexpr std::size_t kRippleTerms = 4;
  static constexpr std::size_t kTerms = kRippleTerms + 1;
  using Terms = std::array<double, kTerms>;

  struct Tuning {
    double lead_m = 5e-3;
    double vs_m_s = 2e-3;
    double ripple_rate = 0.1;     ///< share of the error taken over per radian of the screw
    double stribeck_rate = 0.05;  ///< and per millisecond, by the low-speed term
    double period_s = 1e-3;
  };

  LevelCorrection() noexcept = default;
  explicit LevelCorrection(const Tuning& tuning) noexcept
      : tuning_(tuning),
        stribeck_share_(ShareOfPeriod(tuning.stribeck_rate, tuning.period_s)),
        mean_share_(ShareOfPeriod(kMeanShare, tuning.period_s)),
        per_turn_1_m_(1.0 / tuning.lead_m),
        per_speed_s_m_(1.0 / tuning.vs_m_s) {}

  void Reset() noexcept { plus_ = minus_ = {}; }

  /// Term values at a place and speed: cos, sin of the screw's angle and of twice it, and exp(-|v| / vs).
  [[nodiscard]] Terms Basis(double position_m, double velocity_m_s) const noexcept {
    Terms basis = RippleBasis(position_m);
    basis[kRippleTerms] = ExpOfNegative(LowSpeedExponent(velocity_m_s));
    return basis;
  }

  /// All terms but the last, and what the last is an exponential of.
  [[nodiscard]] Terms RippleBasis(double position_m) const noexcept {
    const CosSin one = Turn(position_m * per_turn_1_m_);
    return {one.cos, one.sin, one.cos * one.cos - one.sin * one.sin, 2.0 * one.sin * one.cos, 0.0};
  }
  [[nodiscard]] double LowSpeedExponent(double velocity_m_s) const noexcept {
    return -std::abs(velocity_m_s) * per_speed_s_m_;
  }

  /// The same for `count` places, row i of `basis` for term i.
  template <class Row>
  [[gnu::always_inline]] void Basis(const Row& position_m, const Row& velocity_m_s, std::size_t count,
                                    std::array<Row, kTerms>& basis) const noexcept {
    for (std::size_t k = 0; k < count; ++k) {
      const CosSin one = Turn(position_m[k] * per_turn_1_m_);
      basis[0][k] = one.cos;
      basis[1][k] = one.sin;
    }
    for (std::size_t k = 0; k < count; ++k) {
      const double cos = basis[0][k], sin = basis[1][k];
      basis[2][k] = cos * cos - sin * sin;
      basis[3][k] = 2.0 * sin * cos;
      basis[kRippleTerms][k] = ExpOfNegative(LowSpeedExponent(velocity_m_s[k]));
    }
  }

  /// Factors at four places in the direction of motion there; `basis[i]`: from where term i stands.
  [[gnu::always_inline]] void Factors(const std::array<const double*, kTerms>& basis,
                                      const wide::Quad& velocity_m_s, wide::Quad& factor) const noexcept {
    wide::Quad forward{}, backward{};
    for (std::size_t i = 0; i < kTerms; ++i) {
      wide::Quad term;
      wide::Load(basis[i], term);
      forward += plus_.coefficient[i] * term;
      backward += minus_.coefficient[i] * term;
    }
    wide::Quad sum = velocity_m_s >= 0.0 ? forward : backward;
    wide::Clamp(sum, kLargest);
    factor = 1.0 + sum;
  }

  /// Factor of the level, within 1 +- kLargest.
  [[nodiscard]] double Factor(const Terms& basis, bool forward) const noexcept {
    const Terms& c = forward ? plus_.coefficient : minus_.coefficient;
    double sum = 0.0;
    for (std::size_t i = 0; i < kTerms; ++i) sum += c[i] * basis[i];
    return 1.0 + std::clamp(sum, -kLargest, kLargest);
  }

  /// One period along the reference: `kept` is the share of the bristle that relaxation left, `travel_m` the
  /// way. `excess` is the estimated bristle minus the rolled one at the period's start over the level, signed
  /// as the force is; `sliding` says whether it means anything.
  void Learn(const Terms& basis, bool forward, double kept, double excess, double travel_m,
             bool sliding) noexcept {
    const double ripple =
        std::min(tuning_.ripple_rate * std::abs(travel_m) * per_turn_1_m_ * 2.0 * std::numbers::pi, 0.5);
    Direction& active = forward ? plus_ : minus_;
    Direction& other = forward ? minus_ : plus_;
    const double along = forward ? excess : -excess;
    const double low_speed = basis[kRippleTerms];
    // The low-speed term is told from the level itself by comparison with what was seen at speed, not long
    // ago.
    if (sliding && low_speed < kAtSpeed) {
      active.excess_at_speed += mean_share_ * (along - active.excess_at_speed);
      active.since_speed_s = 0.0;
    } else {
      active.since_speed_s = std::min(active.since_speed_s + tuning_.period_s, kForgotten_s);
    }
    for (std::size_t i = 0; i < kTerms; ++i) {
      if (sliding) {
        const bool slow = i == kRippleTerms;
        const bool known = low_speed >= kAtSpeed && active.since_speed_s < kForgotten_s;
        const double rate = slow ? (known ? stribeck_share_ : 0.0) : ripple;
        const double error = slow ? along - active.excess_at_speed : along;
        active.coefficient[i] =
            std::clamp(active.coefficient[i] + rate * error * active.follows[i], -kLargest, kLargest);
      }
      active.follows[i] = kept * active.follows[i] + (1.0 - kept) * basis[i];
      other.follows[i] *= kept;
    }
  }

  /// At rest nothing is known of what the bristle still follows.
  void Pause() noexcept { plus_.follows = minus_.follows = {}; }

  [[nodiscard]] const Terms& plus() const noexcept { return plus_.coefficient; }
  [[nodiscard]] const Terms& minus() const noexcept { return minus_.coefficient; }

 private:
  static constexpr double kLargest = 0.5;
  static constexpr double kMeanShare = 0.02;  // per millisecond
  static constexpr double kAtSpeed = 0.1;     // exp(-|v| / vs) above 2.3 Stribeck velocities
  static constexpr double kForgotten_s = 1.0;

  struct Direction {
    Terms coefficient{};
    Terms follows{};  ///< terms as the bristle follows them: d(bristle / level) / d(coefficient)
    double excess_at_speed = 0.0;
    double since_speed_s = kForgotten_s;
  };

  Tuning tuning_;
  double stribeck_share_ = 0.0;  // per period
  double mean_share_ = 0.0;
  double per_turn_1_m_ = 0.0;
  double per_speed_s_m_ = 0.0;
  Direction plus_;
  Direction minus_;
};

}  // namespace contour
