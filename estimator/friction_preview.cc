#include "estimator/friction_preview.h"

#include <array>
#include <numbers>

#include "core/wide_vectors.h"

namespace contour {
namespace {

// From this share of its level on the bristle counts as sliding.
constexpr double kSlidingShare = 0.85;

// Low-pass of unforeseen friction where a drive closes its own loop: while the axis moves, and at rest, where
// only the noise of the reported torque is left of it.
constexpr double kLead_Hz = 8.0;
constexpr double kLeadAtRest_Hz = 0.4;
// A torque of up to this share of the friction level need not come through the screw of an axis that has not
// moved yet: cogging pulls at the motor as well, and as the bristles give way more and more of it is held.
constexpr double kHeldShare = 0.3;

using Row = std::array<double, kMaxHorizonPoints>;
using View = ReferenceTerms::View;

/// The law along the reference, one row per quantity. Only the bristle itself needs one point after the
/// other.
struct Along {
  alignas(32) Row factor, level_N, target_N, per_level_1_N, relaxation;
  alignas(32) Row bristle_N, next_N;  // at the point and at the next
  alignas(32) Row node_N, middle_N;   // friction
};

/// BristleRelaxation at every point, and where the bristle goes.
[[gnu::always_inline]] inline void Relax(double sigma0_N_m, double period_s, const View& at,
                                         std::size_t count, Along& a) noexcept {
  for (std::size_t j = 0; j < count; ++j) {
    a.per_level_1_N[j] = 1.0 / a.level_N[j];
    a.relaxation[j] =
        -Expm1OfNegative(-sigma0_N_m * std::abs(at.velocity_m_s[j]) * a.per_level_1_N[j] * period_s);
    a.target_N[j] = std::copysign(a.level_N[j], at.velocity_m_s[j]);
  }
}

/// The bristle from point to point.
[[gnu::always_inline]] inline void RollBristle(double bristle_N, std::size_t size, std::size_t count,
                                               Along& a) noexcept {
  for (std::size_t j = 0; j < size; ++j) {
    // The level may have come down since, by more than the bristle can follow.
    const double most_N = kMostLevels * a.level_N[j];
    bristle_N = std::min(std::max(bristle_N, -most_N), most_N);
    a.bristle_N[j] = bristle_N;
    bristle_N += (a.target_N[j] - bristle_N) * a.relaxation[j];
    a.next_N[j] = bristle_N;
  }
  for (std::size_t j = size; j < count; ++j) a.bristle_N[j] = a.next_N[j] = bristle_N;
}

/// Bristle with its damping: sigma1(v) (v - |v| F / G), see BristleDamping.
[[gnu::always_inline]] inline double Damped_N(double bristle_N, double per_level_1_N, double velocity_m_s,
                                              double sigma1_Ns_m) noexcept {
  const double share = std::min(std::max(bristle_N * per_level_1_N, -kMostLevels), kMostLevels);
  return bristle_N + sigma1_Ns_m * (velocity_m_s - std::abs(velocity_m_s) * share);
}

[[gnu::always_inline]] inline void AddDamping(double sigma1_Ns_m, const View& at, std::size_t count,
                                              Along& a) noexcept {
  for (std::size_t j = 0; j < count; ++j) a.node_N[j] = a.bristle_N[j];
  for (std::size_t j = 0; j < count; ++j) a.middle_N[j] = 0.5 * (a.bristle_N[j] + a.next_N[j]);
  if (sigma1_Ns_m == 0.0) return;
  for (std::size_t j = 0; j < count; ++j) {
    a.node_N[j] = Damped_N(a.node_N[j], a.per_level_1_N[j], at.node_velocity_m_s[j], at.node_sigma1_Ns_m[j]);
    a.middle_N[j] = Damped_N(a.middle_N[j], a.per_level_1_N[j], at.velocity_m_s[j], at.middle_sigma1_Ns_m[j]);
  }
}

/// What extensions of the model add.
void AddKnown(const KnownNow& known, const View& at, FrictionPreview& out) noexcept {
  for (std::size_t j = 0; j < out.size(); ++j) {
    out[j].node_N += known.effects.Viscous_N(at.node_velocity_m_s[j], known.temperature_degC);
    out[j].mid_N += known.effects.Viscous_N(at.velocity_m_s[j], known.temperature_degC) -
                    known.effects.Force_N(0.5 * (at.position_m[j] + at.position_m[j + 1]));
    out[j].lead_m = known.effects.Lead_m(at.position_m[j]);
  }
}

void AddMap(const AngleForceMap& map, const View& at, FrictionPreview& out) noexcept {
  for (std::size_t j = 0; j < out.size(); ++j)
    out[j].mid_N -= map.At_N(0.5 * (at.position_m[j] + at.position_m[j + 1]), at.velocity_m_s[j]);
}

}  // namespace

FrictionRoll::FrictionRoll(double period_s, bool cascade) noexcept
    : period_s_(period_s),
      cascade_(cascade),
      lead_share_(-Expm1(-2.0 * std::numbers::pi * kLead_Hz * period_s)),
      rest_share_(-Expm1(-2.0 * std::numbers::pi * kLeadAtRest_Hz * period_s)) {}

CONTOUR_WIDE_VECTORS
void FrictionRoll::Run(const SevenStateModel& model, const StateVector<kSevenStates>& x,
                       LevelCorrection& correction, ViscousCorrection& viscous, const KnownNow& known,
                       bool at_rest, const AxisHorizon& reference, std::size_t points,
                       FrictionPreview& out) noexcept {
  if (at_rest) {
    // In a cascade what is foreseen must not take the noise of the estimate over.
    if (!cascade_) bristle_N_ = x[kBristle];
    correction.Pause();
  }
  const std::size_t size = std::min(points, reference.size());
  out.resize(size);
  if (size == 0) return;
  constexpr std::size_t kVector = ReferenceTerms::kVector;
  const std::size_t count = (size + kVector - 1) / kVector * kVector;
  const Friction& f = model.friction();
  const View at = terms_.Follow(model, correction, reference, count);
  Along a;
  correction.Factors(at.basis, at.velocity_m_s, count, a.factor);
  if (!known.effects.neutral())
    for (std::size_t j = 0; j < count; ++j) a.factor[j] *= known.effects.LevelFactor(at.position_m[j]);
  model.Levels(x, at.velocity_m_s, at.low_speed, a.factor, count, a.level_N);
  Relax(f.sigma0_N_m * Exp(x[kLogSigma0]), period_s_, at, count, a);
  RollBristle(bristle_N_, size, count, a);
  AddDamping(f.sigma1_Ns_m, at, count, a);

  const double offset_N = x[kBristle] - a.bristle_N[0];
  bristle_N_ = a.next_N[0];
  const double unexplained_N = offset_N + x[kDisturbance];
  const double friction_lacks_N = unexplained_N - known.lasting_N;
  const double velocity = at.velocity_m_s[0];
  const bool forward = velocity >= 0.0;
  const double share = (forward ? a.bristle_N[0] : -a.bristle_N[0]) * a.per_level_1_N[0];
  const bool sliding = known.learns && !at_rest && share > kSlidingShare;
  // Of this period and the ones ahead, by what is known before this one teaches more.
  const double sigma2 = model.sigma2_Ns_m() + viscous.extra_Ns_m();
  if (sliding) {
    const double level_share = forward ? x[kLevelPlus] / f.Fc_plus_N : x[kLevelMinus] / f.Fc_minus_N;
    viscous.Learn(friction_lacks_N, reference[0].velocity_m_s, reference[0].acceleration_m_s2, level_share);
  }
  LevelCorrection::Terms terms;
  for (std::size_t i = 0; i < terms.size(); ++i) terms[i] = at.basis[i][0];
  correction.Learn(terms, forward, 1.0 - a.relaxation[0], friction_lacks_N * a.per_level_1_N[0],
                   velocity * period_s_, sliding);

  if (cascade_) {
    moved_ = moved_ || !at_rest;
    const double held_N = moved_ ? 0.0 : kHeldShare * a.level_N[0];
    const double gap_N = unexplained_N - lead_N_;
    lead_N_ += (at_rest ? rest_share_ : lead_share_) * (gap_N - std::min(std::max(gap_N, -held_N), held_N));
  }
  const double node_extra_N = cascade_ ? lead_N_ : unexplained_N;
  const double mid_extra_N = cascade_ ? 0.0 : unexplained_N;
  const double half_extra_kg = cascade_ ? 0.0 : 0.5 * known.extra_kg;
  for (std::size_t j = 0; j < count; ++j) {
    a.node_N[j] = a.node_N[j] + node_extra_N + sigma2 * at.node_velocity_m_s[j];
    a.middle_N[j] = a.middle_N[j] + mid_extra_N + sigma2 * at.velocity_m_s[j] +
                    half_extra_kg * (at.acceleration_m_s2[j] + at.acceleration_m_s2[j + 1]);
  }
  for (std::size_t j = 0; j < size; ++j) out[j] = {a.node_N[j], a.middle_N[j], 0.0};
  if (!known.effects.neutral()) AddKnown(known, at, out);
  if (known.map.in_use()) AddMap(known.map, at, out);
  rolled_N_ =
      out[0].mid_N - mid_extra_N - half_extra_kg * (at.acceleration_m_s2[0] + at.acceleration_m_s2[1]);
}

}  // namespace contour
