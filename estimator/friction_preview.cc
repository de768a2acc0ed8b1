#include "estimator/friction_preview.h"

#include <array>

#include "core/wide_vectors.h"

namespace contour {
namespace {

// From this share of its level on the bristle counts as sliding.
constexpr double kSlidingShare = 0.85;

// Low-pass of unforeseen friction where a drive closes its own loop: while the axis moves, and at rest, where
// only the noise of the reported torque is left of it.
constexpr double kLead_Hz = 8.0;
constexpr double kLeadAtRest_Hz = 0.4;
constexpr double kRadPerTurn = 6.283185307179586;

// Points are taken by whole vectors: up to this many at a time, the last point repeated.
constexpr std::size_t kVector = 4;
static_assert(kMaxHorizonPoints % kVector == 0);

using Row = std::array<double, kMaxHorizonPoints>;

/// The reference and the law along it, one row per quantity. Only the bristle itself needs one point after
/// the other.
struct Along {
  alignas(32) Row position_m, node_velocity_m_s,
      velocity_m_s;  // at the point, and in the middle of the period from there
  alignas(32) std::array<Row, LevelCorrection::kTerms> basis;
  alignas(32) Row factor, level_N, target_N, per_level_1_N, relaxation;
  alignas(32) Row bristle_N, next_N;  // at the point and at the next
  alignas(32) Row node_N, middle_N;   // friction
};

/// The point after `j`, or the last one.
const ReferencePoint& After(const AxisHorizon& reference, std::size_t j) noexcept {
  return reference[std::min(j + 1, reference.size() - 1)];
}

[[gnu::always_inline]] inline void Lay(const AxisHorizon& reference, std::size_t count, Along& a) noexcept {
  const std::size_t size = std::min(count, reference.size());
  for (std::size_t j = 0; j < size; ++j) {
    a.position_m[j] = reference[j].position_m;
    a.node_velocity_m_s[j] = reference[j].velocity_m_s;
  }
  for (std::size_t j = size; j < count; ++j) {
    a.position_m[j] = a.position_m[size - 1];
    a.node_velocity_m_s[j] = a.node_velocity_m_s[size - 1];
  }
  for (std::size_t j = 0; j + 1 < count; ++j)
    a.velocity_m_s[j] = 0.5 * (a.node_velocity_m_s[j] + a.node_velocity_m_s[j + 1]);
  a.velocity_m_s[count - 1] =
      0.5 * (a.node_velocity_m_s[count - 1] + After(reference, count - 1).velocity_m_s);
}

/// BristleRelaxation at every point, and where the bristle goes.
[[gnu::always_inline]] inline void Relax(double sigma0_N_m, double period_s, std::size_t count,
                                         Along& a) noexcept {
  for (std::size_t j = 0; j < count; ++j) {
    a.per_level_1_N[j] = 1.0 / a.level_N[j];
    a.relaxation[j] = -Expm1(-sigma0_N_m * std::abs(a.velocity_m_s[j]) * a.per_level_1_N[j] * period_s);
    a.target_N[j] = std::copysign(a.level_N[j], a.velocity_m_s[j]);
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
                                              double sigma1_Ns_m, double per_decay_s_m) noexcept {
  const double u = velocity_m_s * per_decay_s_m;
  const double share = std::min(std::max(bristle_N * per_level_1_N, -kMostLevels), kMostLevels);
  return bristle_N + sigma1_Ns_m * Exp(-u * u) * (velocity_m_s - std::abs(velocity_m_s) * share);
}

[[gnu::always_inline]] inline void AddDamping(const Friction& f, std::size_t count, Along& a) noexcept {
  const double sigma1 = f.sigma1_Ns_m;
  const double per_decay = 1.0 / f.sigma1_decay_m_s;
  for (std::size_t j = 0; j < count; ++j) a.node_N[j] = a.bristle_N[j];
  for (std::size_t j = 0; j < count; ++j) a.middle_N[j] = 0.5 * (a.bristle_N[j] + a.next_N[j]);
  if (sigma1 == 0.0) return;
  for (std::size_t j = 0; j < count; ++j) {
    a.node_N[j] = Damped_N(a.node_N[j], a.per_level_1_N[j], a.node_velocity_m_s[j], sigma1, per_decay);
    a.middle_N[j] = Damped_N(a.middle_N[j], a.per_level_1_N[j], a.velocity_m_s[j], sigma1, per_decay);
  }
}

/// What extensions of the model add.
void AddKnown(const KnownNow& known, const AxisHorizon& reference, const Along& a,
              FrictionPreview& out) noexcept {
  for (std::size_t j = 0; j < out.size(); ++j) {
    const double next_m = After(reference, j).position_m;
    out[j].node_N += known.effects.Viscous_N(a.node_velocity_m_s[j], known.temperature_degC);
    out[j].mid_N += known.effects.Viscous_N(a.velocity_m_s[j], known.temperature_degC) -
                    known.effects.Force_N(0.5 * (a.position_m[j] + next_m));
    out[j].lead_m = known.effects.Lead_m(a.position_m[j]);
  }
}

void AddMap(const AngleForceMap& map, const AxisHorizon& reference, const Along& a,
            FrictionPreview& out) noexcept {
  for (std::size_t j = 0; j < out.size(); ++j)
    out[j].mid_N -= map.At_N(0.5 * (a.position_m[j] + After(reference, j).position_m), a.velocity_m_s[j]);
}

}  // namespace

FrictionRoll::FrictionRoll(double period_s, bool cascade) noexcept
    : period_s_(period_s),
      cascade_(cascade),
      lead_share_(-Expm1(-kRadPerTurn * kLead_Hz * period_s)),
      rest_share_(-Expm1(-kRadPerTurn * kLeadAtRest_Hz * period_s)) {}

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
  Along a;
  Lay(reference, count, a);
  correction.Basis(a.position_m, a.velocity_m_s, count, a.basis);
  correction.Factors(a.basis, a.velocity_m_s, count, a.factor);
  if (!known.effects.neutral())
    for (std::size_t j = 0; j < count; ++j) a.factor[j] *= known.effects.LevelFactor(a.position_m[j]);
  model.Levels(x, a.velocity_m_s, a.factor, count, a.level_N);
  Relax(f.sigma0_N_m * Exp(x[kLogSigma0]), period_s_, count, a);
  RollBristle(bristle_N_, size, count, a);
  AddDamping(f, count, a);

  const double offset_N = x[kBristle] - a.bristle_N[0];
  bristle_N_ = a.next_N[0];
  const double unexplained_N = offset_N + x[kDisturbance];
  const double friction_lacks_N = unexplained_N - known.lasting_N;
  const double velocity = a.velocity_m_s[0];
  const bool forward = velocity >= 0.0;
  const double share = (forward ? a.bristle_N[0] : -a.bristle_N[0]) * a.per_level_1_N[0];
  const bool sliding = !at_rest && share > kSlidingShare;
  // Of this period and the ones ahead, by what is known before this one teaches more.
  const double sigma2 = model.sigma2_Ns_m() + viscous.extra_Ns_m();
  if (sliding) {
    const double level_share = forward ? x[kLevelPlus] / f.Fc_plus_N : x[kLevelMinus] / f.Fc_minus_N;
    viscous.Learn(friction_lacks_N, reference[0].velocity_m_s, reference[0].acceleration_m_s2, level_share);
  }
  LevelCorrection::Terms terms;
  for (std::size_t i = 0; i < terms.size(); ++i) terms[i] = a.basis[i][0];
  correction.Learn(terms, forward, 1.0 - a.relaxation[0], friction_lacks_N * a.per_level_1_N[0],
                   velocity * period_s_, sliding);

  if (cascade_) lead_N_ += (at_rest ? rest_share_ : lead_share_) * (unexplained_N - lead_N_);
  const double node_extra_N = cascade_ ? lead_N_ : unexplained_N;
  const double mid_extra_N = cascade_ ? 0.0 : unexplained_N;
  const double half_extra_kg = cascade_ ? 0.0 : 0.5 * known.extra_kg;
  for (std::size_t j = 0; j < size; ++j) {
    out[j].node_N = a.node_N[j] + node_extra_N + sigma2 * a.node_velocity_m_s[j];
    out[j].mid_N = a.middle_N[j] + mid_extra_N + sigma2 * a.velocity_m_s[j] +
                   half_extra_kg * (reference[j].acceleration_m_s2 + After(reference, j).acceleration_m_s2);
    out[j].lead_m = 0.0;
  }
  if (!known.effects.neutral()) AddKnown(known, reference, a, out);
  if (known.map.in_use()) AddMap(known.map, reference, a, out);
  rolled_N_ = out[0].mid_N - mid_extra_N -
              half_extra_kg * (reference[0].acceleration_m_s2 + After(reference, 0).acceleration_m_s2);
}

}  // namespace contour
