#include "estimator/friction_preview.h"

namespace contour {

void FrictionRoll::Run(const SevenStateModel& model, const StateVector<kSevenStates>& x,
                       const FrictionRipple& ripple, bool at_rest, const AxisHorizon& reference,
                       FrictionPreview& out) noexcept {
  if (at_rest) bristle_N_ = x[kBristle];
  const Friction& f = model.friction();
  const double sigma0 = f.sigma0_N_m * Exp(x[kLogSigma0]);
  const double sigma2 = model.sigma2_Ns_m();
  const double d = x[kDisturbance];
  out.resize(reference.size());
  double bristle_N = bristle_N_;
  double offset_N = 0.0;
  StateVector<kSevenStates> along = x;
  for (std::size_t j = 0; j < reference.size(); ++j) {
    const ReferencePoint& now = reference[j];
    const double next_velocity = j + 1 < reference.size() ? reference[j + 1].velocity_m_s : now.velocity_m_s;
    const double velocity = 0.5 * (now.velocity_m_s + next_velocity);
    along[kVelocity] = velocity;
    const double factor = ripple.Factor(ripple.Basis(now.position_m), velocity >= 0.0);
    const SevenStateInput input{{}, factor, factor};
    const double level_N = model.Level(along, input);
    const double next_N = BristleAfter(bristle_N, velocity, sigma0, level_N, period_s_);
    const double middle_N = 0.5 * (bristle_N + next_N);
    const double node_N = bristle_N + BristleDamping(f, bristle_N, now.velocity_m_s, level_N);
    if (j == 0) {
      offset_N = x[kBristle] - bristle_N;
      bristle_N_ = next_N;
    }
    out[j].node_N = node_N + offset_N + d + sigma2 * now.velocity_m_s;
    out[j].mid_N =
        middle_N + BristleDamping(f, middle_N, velocity, level_N) + offset_N + d + sigma2 * velocity;
    bristle_N = next_N;
  }
}

}  // namespace contour
