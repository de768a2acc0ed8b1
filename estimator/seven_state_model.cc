#include "estimator/seven_state_model.h"

#include "core/wide_vectors.h"

namespace contour {

SevenStateModel::SevenStateModel(const Friction& friction, double mass_kg, double period_s,
                                 double disturbance_decay_s, double compliance_m_N) noexcept
    : friction_(friction), sigma2_(friction.sigma2_Ns_m), step_s_(period_s / static_cast<double>(kSubsteps)) {
  const double rate = sigma2_ / mass_kg;
  velocity_decay_ = Exp(-rate * step_s_);
  velocity_gain_ = sigma2_ > 0.0 ? -Expm1(-rate * step_s_) / sigma2_ : step_s_ / mass_kg;
  compliance_m_N_ = compliance_m_N;
  leak_ = Exp(-step_s_ / disturbance_decay_s);
  ratio_plus_ = friction.Fs_plus_N / friction.Fc_plus_N;
  ratio_minus_ = friction.Fs_minus_N / friction.Fc_minus_N;
}

// Whole rows at a time, without branches, so that the loops vectorise. `low_speed`: of the Stribeck curve.
template <class Row>
inline void SevenStateModel::Substep(Row& p, Row& v, Row& f, Row& d, const Row& gp, const Row& gm,
                                     const Row& s0, const Row& low_speed, double force_N,
                                     const SevenStateInput& in) const noexcept {
  // Copies: for all that the compiler knows, a row might lie where these members do.
  const std::size_t n = std::tuple_size_v<Row>;
  const double per_plus = in.ripple_plus;
  const double per_minus = in.ripple_minus;
  const double more_plus = (ratio_plus_ - 1.0) * per_plus;
  const double more_minus = (ratio_minus_ - 1.0) * per_minus;
  const double compliance_m_N = compliance_m_N_, minus_step_s = -step_s_, half_step_s = 0.5 * step_s_;
  const double sigma1 = in.sigma1_Ns_m, decay = velocity_decay_, gain = velocity_gain_;
  const double lasting_N = in.lasting_N, leak = in.at_rest ? 1.0 : leak_;
  for (std::size_t k = 0; k < n; ++k) {
    const double level_plus = gp[k] * (per_plus + more_plus * low_speed[k]);
    const double level_minus = gm[k] * (per_minus + more_minus * low_speed[k]);
    const double level = std::max(v[k] >= 0.0 ? level_plus : level_minus, kLeastLevel_N);
    const double sign = std::copysign(1.0, v[k] + 0.0);  // of -0.0 as well
    const double speed = std::abs(v[k]);
    const double gap = sign * level - f[k];
    // Beyond its level the bristle lets go at once: the unwinding screw only helps.
    const double missing = std::max(sign * gap, 0.0);
    const double trailing = level + s0[k] * compliance_m_N * missing;
    f[k] -= gap * Expm1OfNegative(s0[k] * speed * minus_step_s / trailing);
    // As ShareOfLevel has it: what held at a level that is hardly there any more damps no more than twice.
    const double held = std::clamp(speed / level * f[k], -kMostLevels * speed, kMostLevels * speed);
    const double damping = sigma1 * (v[k] - held);
    const double next = decay * v[k] + gain * (force_N - f[k] - damping - d[k]);
    p[k] += half_step_s * (v[k] + next);
    v[k] = next;
    d[k] = lasting_N + (d[k] - lasting_N) * leak;
  }
}

// As they are drawn, only the first two points either way have another velocity than the mean: S is lower
// triangular. And the stiffness either way is the mean's times a factor and divided by it.
CONTOUR_WIDE_VECTORS
void SevenStateModel::Propagate(SigmaPoints<kSevenStates>& points, const SevenStateInput& in,
                                double low_speed) const noexcept {
  using Points = SigmaPoints<kSevenStates>;
  constexpr std::size_t kHalf = Points::kHalf;
  static_assert(Points::kCentre < kHalf);
  auto& r = points.row;
  alignas(32) Points::Row s0, low_speeds;
  for (std::size_t k = 0; k < kHalf; ++k) s0[k] = friction_.sigma0_N_m * Exp(r[kLogSigma0][k]);
  const double square = s0[Points::kCentre] * s0[Points::kCentre];
  for (std::size_t k = 0; k < kHalf; ++k) s0[kHalf + k] = square / s0[k];
  alignas(32) std::array<double, 4> few{r[kVelocity][0], r[kVelocity][1], r[kVelocity][kHalf],
                                        r[kVelocity][kHalf + 1]};
  LowSpeeds(few, few.size(), few);
  low_speeds = {few[0], few[1], low_speed, low_speed, low_speed, low_speed, low_speed, low_speed,
                few[2], few[3], low_speed, low_speed, low_speed, low_speed, low_speed, low_speed};
  for (std::size_t i = 0; i < kSubsteps; ++i) {
    if (i > 0) LowSpeeds(r[kVelocity], low_speeds.size(), low_speeds);
    Substep(r[kPosition], r[kVelocity], r[kBristle], r[kDisturbance], r[kLevelPlus], r[kLevelMinus], s0,
            low_speeds, in.force_N[i], in);
  }
}

CONTOUR_WIDE_VECTORS
void SevenStateModel::Propagate(StateVector<kSevenStates>& x, const SevenStateInput& in, double low_speed,
                                double sigma0_N_m) const noexcept {
  using One = std::array<double, 1>;
  One p{x[kPosition]}, v{x[kVelocity]}, f{x[kBristle]}, d{x[kDisturbance]}, low_speeds{low_speed};
  const One gp{x[kLevelPlus]}, gm{x[kLevelMinus]}, s0{sigma0_N_m};
  for (std::size_t i = 0; i < kSubsteps; ++i) {
    if (i > 0) LowSpeeds(v, 1, low_speeds);
    Substep(p, v, f, d, gp, gm, s0, low_speeds, in.force_N[i], in);
  }
  x[kPosition] = p[0];
  x[kVelocity] = v[0];
  x[kBristle] = f[0];
  x[kDisturbance] = d[0];
}

CONTOUR_WIDE_VECTORS
SpeedTerms SevenStateModel::TermsAt(double velocity_m_s) const noexcept {
  const double u = velocity_m_s / friction_.sigma1_decay_m_s;
  const double power = StribeckPower(std::abs(velocity_m_s), friction_.vs_m_s, friction_.stribeck_exponent);
  const wide::Pair e = ExpOfNegative(wide::Pair{-power, -u * u});
  return {e[0], friction_.sigma1_Ns_m * e[1]};
}

// Here, not in the header: a function that is translated twice may not be used before it is defined.
void SevenStateModel::Propagate(StateVector<kSevenStates>& x, const SevenStateInput& in) const noexcept {
  Propagate(x, in, TermsAt(x[kVelocity]).low_speed, Sigma0_N_m(x));
}

void SevenStateModel::PropagateTangent(StateVector<kSevenStates>& x, SquareMatrix<kSevenStates>& t,
                                       const SevenStateInput& in) const noexcept {
  const double s0 = friction_.sigma0_N_m * Exp(x[kLogSigma0]);
  const double h = step_s_;
  for (const double force_N : in.force_N) {
    const bool forward = x[kVelocity] >= 0.0;
    const double sign = forward ? 1.0 : -1.0;
    const double speed = std::abs(x[kVelocity]);
    const double ratio = forward ? ratio_plus_ : ratio_minus_;
    const double ripple = forward ? in.ripple_plus : in.ripple_minus;
    const double n = friction_.stribeck_exponent;
    const double per_g = ripple * StribeckFactor(ratio, speed, friction_.vs_m_s, n);
    const double g = forward ? x[kLevelPlus] : x[kLevelMinus];
    const double level = std::max(g * per_g, kLeastLevel_N);
    // dG/dv through the Stribeck curve.
    const double u = speed / friction_.vs_m_s;
    const double slope = n == 1.0 ? 1.0 : n * std::pow(u, n - 1.0);
    const double level_v = -sign * g * ripple * (per_g / ripple - 1.0) * slope / friction_.vs_m_s;

    const double gap = sign * level - x[kBristle];
    // a = b / D; b = sigma0 |v| / G, D = 1 + sigma0 C missing / G.
    const double stiff = s0 * compliance_m_N_ / level;
    const double missing = std::max(sign * gap, 0.0);
    const double toward = missing > 0.0 ? sign : 0.0;
    const double big_d = 1.0 + stiff * missing;
    const double b = s0 * speed / level;
    const double a = b / big_d;
    const double relaxed = -Expm1(-a * h);
    const double by_a = gap * h * (1.0 - relaxed);  // dF+/da
    const double a_f = a / big_d * stiff * toward;
    const double a_level = -a / level - a / big_d * stiff * (toward * sign - missing / level);
    const double f_f = 1.0 - relaxed + by_a * a_f;
    const double f_v = sign * level_v * relaxed + by_a * (s0 * sign / (level * big_d) + a_level * level_v);
    const double f_g = (sign * relaxed + by_a * a_level) * per_g;
    const double f_l = by_a * a / big_d;

    x[kBristle] += gap * relaxed;
    // Damping c = sigma1 (v - |v| F+ / G).
    const double share = ShareOfLevel(x[kBristle], level);
    const bool within = share == x[kBristle] / level;
    const double per_level = within ? speed / level : 0.0;
    const double c_f = -in.sigma1_Ns_m * per_level;
    const double c_v = in.sigma1_Ns_m * (1.0 - sign * share + per_level * share * level_v);
    const double c_g = in.sigma1_Ns_m * per_level * share * per_g;
    const double held = within ? per_level * x[kBristle] : share * speed;
    const double damping = in.sigma1_Ns_m * (x[kVelocity] - held);
    const double next =
        velocity_decay_ * x[kVelocity] + velocity_gain_ * (force_N - x[kBristle] - damping - x[kDisturbance]);
    x[kPosition] += 0.5 * h * (x[kVelocity] + next);
    x[kVelocity] = next;
    const double leak = in.at_rest ? 1.0 : leak_;
    x[kDisturbance] = in.lasting_N + (x[kDisturbance] - in.lasting_N) * leak;

    const auto& active = t[forward ? kLevelPlus : kLevelMinus];
    for (std::size_t k = 0; k < kSevenStates; ++k) {
      const double f =
          f_f * t[kBristle][k] + f_v * t[kVelocity][k] + f_g * active[k] + f_l * t[kLogSigma0][k];
      const double c = c_f * f + c_v * t[kVelocity][k] + c_g * active[k];
      const double v = velocity_decay_ * t[kVelocity][k] - velocity_gain_ * (f + c + t[kDisturbance][k]);
      t[kPosition][k] += 0.5 * h * (t[kVelocity][k] + v);
      t[kVelocity][k] = v;
      t[kBristle][k] = f;
      t[kDisturbance][k] *= leak;
    }
  }
}

}  // namespace contour
