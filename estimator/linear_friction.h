#pragma once

#include <array>
#include <cstddef>

#include "estimator/friction_config.h"

namespace contour {

/// Terms of friction along a known motion; the number is rounded up to whole registers.
inline constexpr std::size_t kFrictionTerms = 24;
using FrictionTerms = std::array<double, kFrictionTerms>;

/// What each term is. The friction is the sum of parameter times term; parameters are in N, but for the last
/// two.
namespace friction_term {
inline constexpr std::size_t kDahl = 0;           ///< 4 Dahl operators, lengths about the presliding length
inline constexpr std::size_t kStop = 4;           ///< 4 elasto-plastic stops (Maxwell slip)
inline constexpr std::size_t kConstant = 8;       ///< directions differ; weight of a vertical axis
inline constexpr std::size_t kStribeck = 9;       ///< 2, relaxed by the bristle
inline constexpr std::size_t kEvenStribeck = 11;  ///< the same of break-away levels that differ by direction
inline constexpr std::size_t kSlowBristle = 12;   ///< bristle that fades with speed
inline constexpr std::size_t kDamping = 13;       ///< of the bristle
inline constexpr std::size_t kTurn = 14;  ///< 4: cosine and sine of the screw's angle and of twice it, signed
inline constexpr std::size_t kEvenTurn = 18;  ///< 2: the same of its angle whatever the direction
inline constexpr std::size_t kStroke = 20;    ///< friction over the stroke
inline constexpr std::size_t kViscous = 21;   ///< in N at 25 Stribeck velocities
inline constexpr std::size_t kMass = 22;      ///< kg: the term is the acceleration
inline constexpr std::size_t kUsed = 23;
}  // namespace friction_term

/// Lengths and speeds of one axis that its friction is laid over.
struct FrictionScale {
  double level_N = 0.0;       ///< Coulomb level, mean of both directions
  double presliding_m = 0.0;  ///< level / sigma0
  double vs_m_s = 0.0;        ///< Stribeck velocity
  double sigma1_decay_m_s = 0.0;
  double lead_m = 0.0;
  double centre_m = 0.0;  ///< of the stroke
  double half_stroke_m = 0.0;
};

FrictionScale ScaleOf(const Friction& friction, double lead_m, double position_min_m,
                      double position_max_m) noexcept;

/// What of the past counts: four bristles, four stops, eight signs that bristles relax.
struct FrictionTermsState {
  std::array<double, 4> dahl{};
  std::array<double, 4> stop{};
  std::array<double, 8> relaxed{};

  friend bool operator==(const FrictionTermsState&, const FrictionTermsState&) = default;
};

/// Friction along a motion that is known in advance, linear in its parameters. Every length is a share of the
/// axis's own presliding length, every speed one of its Stribeck velocity, so that axes of the same shape of
/// friction have the same parameters in units of their level. Only the motion goes in, no measurement: what
/// is learnt through these terms closes no loop of its own.
class LinearFriction {
 public:
  LinearFriction() noexcept = default;
  explicit LinearFriction(const FrictionScale& scale) noexcept;

  [[nodiscard]] const FrictionScale& scale() const noexcept { return scale_; }
  /// The axis is shaken, by so much travel per step: bristles let go of what they hold, and a motion that is
  /// slow beside it is held by less than the level.
  void Shake(double travel_m) noexcept { shake_m_ = travel_m; }
  static constexpr double kViscousSpeeds = 25.0;

  /// The term is of bristles: it stays when the axis stands, and may give way then.
  static constexpr bool Carried(std::size_t term) noexcept {
    using namespace friction_term;  // NOLINT(google-build-using-namespace): names of terms only
    return term < kConstant || (term >= kStribeck && term < kDamping) ||
           (term >= kTurn && term < kEvenTurn) || term == kStroke;
  }

  /// The fading of the Stribeck terms, then of the even one and the slow bristle, at a speed in vs.
  static std::array<double, 3> StribeckAt(double speed) noexcept;

  /// Moves on to `position_m`, `step_m` from where it was, and gives the terms there.
  void Follow(double step_m, double position_m, double velocity_m_s, double acceleration_m_s2,
              FrictionTermsState& memory, FrictionTerms& terms) const noexcept;

 private:
  FrictionScale scale_;
  std::array<double, 4> per_dahl_1_m_{};
  std::array<double, 4> per_stop_1_m_{};
  double per_turn_1_m_ = 0.0;
  double shake_m_ = 0.0;
};

/// Scalar product in an order that is stated.
[[gnu::always_inline]] inline double Sum(const FrictionTerms& a, const FrictionTerms& b) noexcept {
  std::array<double, 4> part{};
  for (std::size_t i = 0; i < kFrictionTerms; i += 4)
    for (std::size_t j = 0; j < 4; ++j) part[j] += a[i + j] * b[i + j];
  return (part[0] + part[2]) + (part[1] + part[3]);
}

}  // namespace contour
