#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/wide_numbers.h"
#include "estimator/friction_model.h"
#include "estimator/sqrt_ukf.h"
#include "estimator/square_root.h"

namespace contour {

/// States of the friction filter. The parameters come last, so that keeping them costs little.
enum SevenState : std::size_t {
  kPosition,     ///< centre of mass, m
  kVelocity,     ///< m/s
  kBristle,      ///< F = sigma0 z, N
  kDisturbance,  ///< leaky, positive opposes positive motion, N
  kLevelPlus,    ///< Coulomb level g of the positive direction, N
  kLevelMinus,   ///< and of the negative one
  kLogSigma0,    ///< ln(sigma0 / commissioned sigma0)
};
inline constexpr std::size_t kSevenStates = 7;
inline constexpr std::size_t kMovingStates = 4;  // the others are parameters
inline constexpr std::size_t kSubsteps = 2;

/// What is known of one period beforehand.
struct SevenStateInput {
  std::array<double, kSubsteps> force_N{};  ///< mean force of the drive in each substep
  double ripple_plus = 1.0;                 ///< factor of the level at this place, per direction
  double ripple_minus = 1.0;
  double sigma1_Ns_m = 0.0;  ///< bristle damping at the speed of this period
  bool at_rest = false;      ///< the disturbance keeps its value: nothing tells it from the bristle now
  double lasting_N = 0.0;    ///< what the disturbance fades to
};

/// What of the law depends on the velocity alone.
struct SpeedTerms {
  double low_speed = 1.0;    ///< exp(-(|v| / vs)^n) of the Stribeck curve
  double sigma1_Ns_m = 0.0;  ///< bristle damping
};

/// One rigid axis with LuGre friction in two substeps per period:
///   F+ = F + (sgn(v) G - F) (1 - exp(-a h)),  G = g(dir) Stribeck(v) ripple(p)
///   a = sigma0 |v| / G / (1 + sigma0 C max(0, 1 - sgn(v) F / G)): the bristle sees the table,
///   which trails v by C F'
///   v+ = A v + B (u - F+ - sigma1 (v - |v| F+ / G) - d),  A = exp(-sigma2 h / m),  B = (1 - A) / sigma2
///   p+ = p + h (v + v+) / 2
/// The new F goes into the velocity update (eq. 9 as printed is unstable in presliding). sigma1 fades with
/// speed, exp(-(v / vd)^2); it is taken at the mean speed and is the same for all sigma points.
class SevenStateModel {
 public:
  SevenStateModel() noexcept = default;
  /// compliance_m_N: by how much the centre of mass runs ahead of the table per newton of friction, because
  /// the screw winds up.
  SevenStateModel(const Friction& friction, double mass_kg, double period_s, double disturbance_decay_s,
                  double compliance_m_N = 0.0) noexcept;

  /// All sigma points, in place, as SqrtUkf::Draw drew them. `low_speed`: SpeedTerms at the mean's velocity.
  void Propagate(SigmaPoints<kSevenStates>& points, const SevenStateInput& in,
                 double low_speed) const noexcept;

  /// One state, over a period, whose `low_speed` and stiffness are known already.
  void Propagate(StateVector<kSevenStates>& x, const SevenStateInput& in, double low_speed,
                 double sigma0_N_m) const noexcept;
  void Propagate(StateVector<kSevenStates>& x, const SevenStateInput& in) const noexcept;

  [[nodiscard]] double Sigma0_N_m(const StateVector<kSevenStates>& x) const noexcept {
    return friction_.sigma0_N_m * Exp(x[kLogSigma0]);
  }

  /// One state, and `tangent` (each column a direction) by the chain rule.
  void PropagateTangent(StateVector<kSevenStates>& x, SquareMatrix<kSevenStates>& tangent,
                        const SevenStateInput& in) const noexcept;

  [[nodiscard]] SpeedTerms TermsAt(double velocity_m_s) const noexcept;

  /// Level G that holds in this state; `at`: the terms at its velocity.
  [[nodiscard]] double Level(const StateVector<kSevenStates>& x, const SpeedTerms& at,
                             const SevenStateInput& in) const noexcept {
    const bool forward = x[kVelocity] >= 0.0;
    const double g = forward ? x[kLevelPlus] * in.ripple_plus : x[kLevelMinus] * in.ripple_minus;
    const double ratio = forward ? ratio_plus_ : ratio_minus_;
    return std::max(g * (1.0 + (ratio - 1.0) * at.low_speed), kLeastLevel_N);
  }

  /// (|v| / vs)^n of the Stribeck curve at `count` velocities.
  template <class Row>
  [[gnu::always_inline]] void StribeckPowers(const Row& velocity_m_s, std::size_t count,
                                             Row& power) const noexcept {
    const double inverse_vs = 1.0 / friction_.vs_m_s;
    for (std::size_t k = 0; k < count; ++k) power[k] = std::abs(velocity_m_s[k]) * inverse_vs;
    if (friction_.stribeck_exponent == 2.0) {
      for (std::size_t k = 0; k < count; ++k) power[k] *= power[k];
    } else if (friction_.stribeck_exponent != 1.0) {
      for (std::size_t k = 0; k < count; ++k) power[k] = std::pow(power[k], friction_.stribeck_exponent);
    }
  }

  /// SpeedTerms::low_speed at `count` velocities.
  template <class Row>
  [[gnu::always_inline]] void LowSpeeds(const Row& velocity_m_s, std::size_t count,
                                        Row& low_speed) const noexcept {
    StribeckPowers(velocity_m_s, count, low_speed);
    for (std::size_t k = 0; k < count; ++k) low_speed[k] = ExpOfNegative(-low_speed[k]);
  }

  /// Levels with the parameters of `x` at four other velocities, each with its factor.
  [[gnu::always_inline]] void Levels(const StateVector<kSevenStates>& x, const wide::Quad& velocity_m_s,
                                     const wide::Quad& low_speed, const wide::Quad& factor,
                                     wide::Quad& level_N) const noexcept {
    const double plus_N = x[kLevelPlus], minus_N = x[kLevelMinus];
    const double more_plus_N = plus_N * (ratio_plus_ - 1.0), more_minus_N = minus_N * (ratio_minus_ - 1.0);
    const wide::Quad forward_N = plus_N + more_plus_N * low_speed;
    const wide::Quad backward_N = minus_N + more_minus_N * low_speed;
    const wide::Quad least_N = wide::Quad{} + kLeastLevel_N;
    level_N = (velocity_m_s >= 0.0 ? forward_N : backward_N) * factor;
    level_N = level_N < least_N ? least_N : level_N;
  }

  /// Bristle, its damping, viscous friction and disturbance together.
  [[nodiscard]] double Friction_N(const StateVector<kSevenStates>& x, const SpeedTerms& at,
                                  const SevenStateInput& in) const noexcept {
    const double v = x[kVelocity];
    const double damping = in.sigma1_Ns_m * (v - std::abs(v) * ShareOfLevel(x[kBristle], Level(x, at, in)));
    return x[kBristle] + damping + sigma2_ * v + x[kDisturbance];
  }

  [[nodiscard]] double sigma2_Ns_m() const noexcept { return sigma2_; }
  [[nodiscard]] const Friction& friction() const noexcept { return friction_; }

 private:
  template <class Row>
  [[gnu::always_inline]] void Substep(Row& p, Row& v, Row& f, Row& d, const Row& gp, const Row& gm,
                                      const Row& s0, const Row& low_speed, double force_N,
                                      const SevenStateInput& in) const noexcept;

  Friction friction_;
  double sigma2_ = 0.0;
  double step_s_ = 0.0;          // h
  double velocity_decay_ = 1.0;  // A
  double velocity_gain_ = 0.0;   // B
  double compliance_m_N_ = 0.0;
  double leak_ = 1.0;        // of d, per substep
  double ratio_plus_ = 1.0;  // Fs / Fc
  double ratio_minus_ = 1.0;
};

}  // namespace contour
