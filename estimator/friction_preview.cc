#include "estimator/friction_preview.h"

namespace contour {
namespace {

// From this share of its level on the bristle counts as sliding.
constexpr double kSlidingShare = 0.85;

}  // namespace

void FrictionRoll::Run(const SevenStateModel& model, const StateVector<kSevenStates>& x,
                       LevelCorrection& correction, RigidCorrection& rigid, const KnownNow& known,
                       bool at_rest, const AxisHorizon& reference, FrictionPreview& out) noexcept {
  if (at_rest) {
    bristle_N_ = x[kBristle];
    correction.Pause();
  }
  const Friction& f = model.friction();
  const double sigma0 = f.sigma0_N_m * Exp(x[kLogSigma0]);
  const double sigma2 = model.sigma2_Ns_m() + rigid.extra_Ns_m();
  const double d = x[kDisturbance];
  out.resize(reference.size());
  double bristle_N = bristle_N_;
  double offset_N = 0.0;
  StateVector<kSevenStates> along = x;
  for (std::size_t j = 0; j < reference.size(); ++j) {
    const ReferencePoint& now = reference[j];
    const ReferencePoint& next = j + 1 < reference.size() ? reference[j + 1] : now;
    const double velocity = 0.5 * (now.velocity_m_s + next.velocity_m_s);
    along[kVelocity] = velocity;
    const auto basis = correction.Basis(now.position_m, velocity);
    const double factor =
        correction.Factor(basis, velocity >= 0.0) * known.effects.LevelFactor(now.position_m);
    const double level_N = model.Level(along, {{}, factor, factor});
    // The level may have come down since, by more than the bristle can follow.
    bristle_N = level_N * ShareOfLevel(bristle_N, level_N);
    const double relaxation = BristleRelaxation(sigma0, std::abs(velocity), level_N, period_s_);
    const double next_N = bristle_N + (std::copysign(level_N, velocity) - bristle_N) * relaxation;
    const double middle_N = 0.5 * (bristle_N + next_N);
    const double node_N = bristle_N + BristleDamping(f, bristle_N, now.velocity_m_s, level_N);
    if (j == 0) {
      offset_N = x[kBristle] - bristle_N;
      bristle_N_ = next_N;
      const double share = (velocity >= 0.0 ? bristle_N : -bristle_N) / level_N;
      const bool sliding = !at_rest && share > kSlidingShare;
      if (sliding) {
        const double level_share =
            velocity >= 0.0 ? x[kLevelPlus] / f.Fc_plus_N : x[kLevelMinus] / f.Fc_minus_N;
        rigid.Learn(offset_N + d, now.velocity_m_s, now.acceleration_m_s2, level_share);
      }
      correction.Learn(basis, velocity >= 0.0, 1.0 - relaxation, (offset_N + d) / level_N,
                       velocity * period_s_, sliding);
    }
    out[j].node_N = node_N + offset_N + d + sigma2 * now.velocity_m_s +
                    known.effects.Viscous_N(now.velocity_m_s, known.temperature_degC);
    out[j].mid_N = middle_N + BristleDamping(f, middle_N, velocity, level_N) + offset_N + d +
                   sigma2 * velocity + known.effects.Viscous_N(velocity, known.temperature_degC) -
                   known.effects.Force_N(0.5 * (now.position_m + next.position_m)) +
                   rigid.extra_kg() * 0.5 * (now.acceleration_m_s2 + next.acceleration_m_s2);
    out[j].lead_m = known.effects.Lead_m(now.position_m);
    bristle_N = next_N;
  }
}

}  // namespace contour
