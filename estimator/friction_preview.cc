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

constexpr std::size_t kVector = ReferenceTerms::kVector;

/// The law along the reference, one row per quantity. Only the bristle itself needs one point after the
/// other; all else is four points at a time, in registers.
struct Along {
  alignas(32) Row level_N, target_N, per_level_1_N, relaxation;
  alignas(32) Row bristle_N, next_N;  // at the point and at the next
};

/// Level and BristleRelaxation at four points, and where the bristle goes.
[[gnu::always_inline]] inline void LayLevels(const SevenStateModel& model, const StateVector<kSevenStates>& x,
                                             const LevelCorrection& correction, const KnownNow& known,
                                             double period_s, const View& at, std::size_t from,
                                             Along& a) noexcept {
  wide::Quad velocity, low_speed, factor, level, size, target, relaxed;
  wide::Load(at.velocity_m_s + from, velocity);
  wide::Load(at.low_speed + from, low_speed);
  std::array<const double*, LevelCorrection::kTerms> basis = at.basis;
  for (const double*& row : basis) row += from;
  correction.Factors(basis, velocity, factor);
  if (!known.effects.neutral())
    for (std::size_t j = 0; j < kVector; ++j) factor[j] *= known.effects.LevelFactor(at.position_m[from + j]);
  model.Levels(x, velocity, low_speed, factor, level);
  const wide::Quad per_level = 1.0 / level;
  wide::Sizes(velocity, size);
  const wide::Quad exponent = -known.sigma0_N_m * size * per_level * period_s;
  Expm1OfNegative<wide::Quad>(exponent, relaxed);
  wide::WithSigns(level, velocity, target);
  wide::Store(&a.level_N[from], level);
  wide::Store(&a.target_N[from], target);
  wide::Store(&a.per_level_1_N[from], per_level);
  const wide::Quad relaxation = -relaxed;
  wide::Store(&a.relaxation[from], relaxation);
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

/// Adds the bristle's damping at four points: sigma1(v) (v - |v| F / G), see BristleDamping.
[[gnu::always_inline]] inline void Damp(const wide::Quad& per_level, const double* velocity_m_s,
                                        const double* sigma1_Ns_m, wide::Quad& force_N) noexcept {
  wide::Quad velocity, sigma1, size, share = force_N * per_level;
  wide::Load(velocity_m_s, velocity);
  wide::Load(sigma1_Ns_m, sigma1);
  wide::Clamp(share, kMostLevels);
  wide::Sizes(velocity, size);
  force_N = force_N + sigma1 * (velocity - size * share);
}

/// What is added to the bristle's force at every point.
struct Extra {
  bool damped;  ///< there is bristle damping
  double sigma2_Ns_m, node_N, mid_N, half_kg;
};

/// Friction at four points.
[[gnu::always_inline]] inline void LayFriction(const Extra& extra, const View& at, std::size_t from,
                                               const Along& a, wide::Quad& node_N,
                                               wide::Quad& middle_N) noexcept {
  wide::Quad next, per_level, velocity, acceleration, acceleration_next;
  wide::Load(&a.bristle_N[from], node_N);
  wide::Load(&a.next_N[from], next);
  middle_N = 0.5 * (node_N + next);
  if (extra.damped) {
    wide::Load(&a.per_level_1_N[from], per_level);
    Damp(per_level, at.node_velocity_m_s + from, at.node_sigma1_Ns_m + from, node_N);
    Damp(per_level, at.velocity_m_s + from, at.middle_sigma1_Ns_m + from, middle_N);
  }
  wide::Load(at.node_velocity_m_s + from, velocity);
  node_N = node_N + extra.node_N + extra.sigma2_Ns_m * velocity;
  wide::Load(at.velocity_m_s + from, velocity);
  wide::Load(at.acceleration_m_s2 + from, acceleration);
  wide::Load(at.acceleration_m_s2 + from + 1, acceleration_next);
  middle_N = middle_N + extra.mid_N + extra.sigma2_Ns_m * velocity +
             extra.half_kg * (acceleration + acceleration_next);
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
  const std::size_t count = (size + kVector - 1) / kVector * kVector;
  const Friction& f = model.friction();
  const View at = terms_.Follow(model, correction, reference, count);
  Along a;
  for (std::size_t from = 0; from < count; from += kVector)
    LayLevels(model, x, correction, known, period_s_, at, from, a);
  RollBristle(bristle_N_, size, count, a);

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
  const Extra extra{f.sigma1_Ns_m != 0.0, sigma2, cascade_ ? lead_N_ : unexplained_N,
                    cascade_ ? 0.0 : unexplained_N, cascade_ ? 0.0 : 0.5 * known.extra_kg};
  for (std::size_t from = 0; from < count; from += kVector) {
    wide::Quad node_N, middle_N;
    LayFriction(extra, at, from, a, node_N, middle_N);
    // There is room for whole vectors.
    for (std::size_t j = 0; j < kVector; ++j) out[from + j] = {node_N[j], middle_N[j], 0.0};
  }
  if (!known.effects.neutral()) AddKnown(known, at, out);
  if (known.map.in_use()) AddMap(known.map, at, out);
  rolled_N_ =
      out[0].mid_N - extra.mid_N - extra.half_kg * (at.acceleration_m_s2[0] + at.acceleration_m_s2[1]);
}

}  // namespace contour
