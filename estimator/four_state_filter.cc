#include "estimator/four_state_filter.h"

#include <algorithm>
#include <cmath>

#include "core/wide_vectors.h"

namespace contour {
namespace {

constexpr std::size_t kP = 0;
constexpr std::size_t kV = 1;
constexpr std::size_t kZ = 2;
constexpr std::size_t kG = 3;

}  // namespace

FourStateFilter::FourStateFilter(const FilterSetup& setup) noexcept
    : setup_(setup),
      lag_(setup.period_s, setup.lag_s),
      gate_({setup.config.innovation_gate_sigma, setup.config.innovation_gate_um * 1e-6}, setup.Sudden_m()) {
  const Friction& f = setup.friction;
  const auto& c = setup.config;
  const double mass_kg = setup.mechanics.mass_kg;
  const double rate = f.sigma2_Ns_m / mass_kg;
  velocity_decay_ = Exp(-rate * setup.period_s);
  velocity_gain_ = rate > 0.0 ? -Expm1(-rate * setup.period_s) / (rate * mass_kg) : setup.period_s / mass_kg;
  level_N_ = 0.25 * (f.Fc_plus_N + f.Fc_minus_N + f.Fs_plus_N + f.Fs_minus_N);
  noise_ = {setup.PerPeriod(c.position_noise_um * 1e-6), setup.PerPeriod(c.velocity_noise_mm_s * 1e-3),
            setup.PerPeriod(c.bristle_noise_rel * setup.Coulomb_N()) / f.sigma0_N_m,
            setup.PerPeriod(c.four_state_level_noise_N)};
  initial_std_ = {setup.measurement_std_m, 1e-4, 0.5 * level_N_ / f.sigma0_N_m,
                  c.initial_level_std * level_N_};
  Reset(0.0);
}

void FourStateFilter::Reset(double position_m) noexcept {
  core_.x[kG] = level_N_;
  core_.s[kG][kG] = initial_std_[kG];
  Follow(position_m);
}

void FourStateFilter::Follow(double position_m) noexcept {
  const double g = core_.x[kG];
  const double g_std = std::sqrt(core_.Variance(kG));
  core_.x = {position_m, 0.0, 0.0, g};
  core_.s = {};
  for (std::size_t i = 0; i < kG; ++i) core_.s[i][i] = initial_std_[i];
  core_.s[kG][kG] = g_std;
  lag_.Reset();
  gated_in_a_row_ = 0;
  gate_.Reset();
  following_ = true;
}

// Eq. 9, corrected: z relaxes exactly over the period (f21 by expm1), and the new z drives the velocity.
template <class Row>
void FourStateFilter::Propagate(Row& p, Row& v, Row& z, const Row& g, double force_N) const noexcept {
  const Friction& f = setup_.friction;
  const std::size_t n = std::tuple_size_v<Row>;
  const double h = setup_.period_s;
  const double inverse_decay = 1.0 / f.sigma1_decay_m_s;
  Row damping;
  for (std::size_t k = 0; k < n; ++k) {
    const double u = v[k] * inverse_decay;
    damping[k] = f.sigma1_Ns_m * ExpOfNegative(-u * u);
  }
  for (std::size_t k = 0; k < n; ++k) {
    const double level = std::max(g[k], kLeastLevel_N);
    const double speed = std::abs(v[k]);
    const double target = (v[k] >= 0.0 ? level : -level) / f.sigma0_N_m;
    z[k] -= (target - z[k]) * Expm1OfNegative(-f.sigma0_N_m * speed * h / level);
    // Eq. 10: F = sigma0 z + sigma1 (v - sigma0 |v| z / g).
    const double friction = f.sigma0_N_m * z[k] + damping[k] * (v[k] - f.sigma0_N_m * speed * z[k] / level);
    const double next = velocity_decay_ * v[k] + velocity_gain_ * (force_N - friction);
    p[k] += 0.5 * h * (v[k] + next);
    v[k] = next;
  }
}

void FourStateFilter::Propagate(X& x, double force_N) const noexcept {
  using One = std::array<double, 1>;
  One p{x[kP]}, v{x[kV]}, z{x[kZ]};
  const One g{x[kG]};
  Propagate(p, v, z, g, force_N);
  x = {p[0], v[0], z[0], x[kG]};
}

// Eq. 10: sigma0 z + sigma1 z'.
double FourStateFilter::Bristle_N(const X& x) const noexcept {
  const Friction& f = setup_.friction;
  const double bristle = f.sigma0_N_m * x[kZ];
  return bristle + BristleDamping(f, bristle, x[kV], std::max(x[kG], kLeastLevel_N));
}

CONTOUR_WIDE_VECTORS
AxisEstimate FourStateFilter::Update(const AxisEstimatorInput& in) noexcept {
  AxisEstimate out;
  const auto& c = setup_.config;
  if (!in.enabled) {
    if (in.fresh) Follow(in.position_m);
  } else {
    const bool adapted = !in.at_rest && c.adapt;
    if (!following_) {
      X noise = noise_;
      const double moving = std::min(1.0, std::abs(core_.x[kV]) / (c.motion_gate_mm_s * 1e-3));
      noise[kG] *= adapted ? moving : 0.0;
      const double force_N = lag_.Step(in.force_N[1])[0];
      core_.Predict<kG>(
          [&](Points& points) noexcept {
            auto& r = points.row;
            Propagate(r[kP], r[kV], r[kZ], r[kG], force_N);
          },
          noise);
    }
    following_ = false;
    if (in.fresh) {
      Innovation innovation;
      const auto result = core_.UpdateState0(in.position_m, setup_.measurement_std_m, gate_.gate(),
                                             {true, true, true, adapted}, innovation);
      gate_.After(innovation.value, innovation.std);
      gated_in_a_row_ = result == UpdateResult::kGated ? gated_in_a_row_ + 1 : 0;
      if (result == UpdateResult::kGated) out.limit = Reason::kInnovationGated;
      if (gated_in_a_row_ != 0 && StartsAgain(gated_in_a_row_, setup_.period_s)) Follow(in.position_m);
      out.innovation_m = innovation.value;
      out.innovation_std_m = innovation.std;
    }
    const double bounded = std::clamp(core_.x[kG], level_N_ / c.level_range, level_N_ * c.level_range);
    if (bounded != core_.x[kG] && out.limit == Reason::kNone) out.limit = Reason::kParameterBound;
    core_.x[kG] = bounded;
  }
  const double sigma0 = setup_.friction.sigma0_N_m;
  const double sigma2 = setup_.friction.sigma2_Ns_m;
  X predicted = core_.x;
  Propagate(predicted, lag_.Look(in.force_N[0])[0]);
  X after = predicted;
  Propagate(after, in.force_N[0]);
  friction_ahead_N_ =
      0.5 * (Bristle_N(predicted) + Bristle_N(after)) + 0.5 * sigma2 * (predicted[kV] + after[kV]);

  out.position_m = core_.x[kP];
  out.velocity_m_s = core_.x[kV];
  out.predicted_position_m = predicted[kP];
  out.predicted_velocity_m_s = predicted[kV];
  out.bristle_N = sigma0 * core_.x[kZ];
  out.friction_N = Bristle_N(core_.x) + sigma2 * core_.x[kV];
  out.friction_std_N = core_.Std({0.0, sigma2, sigma0, 0.0});
  out.g_plus_N = out.g_minus_N = core_.x[kG];
  out.sigma0_N_m = sigma0;
  out.diverged = !square_root::Sound(core_.x, core_.s, {1.0, 100.0, 1.0, 1e5});
  return out;
}

}  // namespace contour
