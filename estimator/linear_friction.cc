#include "estimator/linear_friction.h"

#include <algorithm>
#include <cmath>

#include "core/wide_vectors.h"
#include "estimator/exponential.h"
#include "estimator/turn.h"

namespace contour {
namespace {

// In presliding lengths: a bristle's knee is spread over about a decade, so four of each bracket it.
constexpr std::array<double, 4> kDahlLengths{0.19, 0.45, 1.0, 2.5};
constexpr std::array<double, 4> kStopLengths{0.11, 0.40, 1.3, 3.3};
constexpr std::size_t kNominalDahl = 2;  // the one as long as the presliding length
constexpr std::size_t kWideStop = 2;
// In Stribeck velocities: the commissioned one may be wrong by a factor of two.
constexpr std::array<double, 2> kStribeckSpeeds{0.6, 2.0};

}  // namespace

FrictionScale ScaleOf(const Friction& f, double lead_m, double position_min_m,
                      double position_max_m) noexcept {
  const double level_N = 0.5 * (f.Fc_plus_N + f.Fc_minus_N);
  return {level_N,
          level_N / f.sigma0_N_m,
          f.vs_m_s,
          f.sigma1_decay_m_s,
          lead_m,
          0.5 * (position_min_m + position_max_m),
          0.5 * (position_max_m - position_min_m)};
}

LinearFriction::LinearFriction(const FrictionScale& scale) noexcept
    : scale_(scale), per_turn_1_m_(1.0 / scale.lead_m) {
  for (std::size_t i = 0; i < 4; ++i) {
    per_dahl_1_m_[i] = 1.0 / (kDahlLengths[i] * scale.presliding_m);
    per_stop_1_m_[i] = 1.0 / (kStopLengths[i] * scale.presliding_m);
  }
}

std::array<double, 3> LinearFriction::StribeckAt(double speed) noexcept {
  return {ExpOfNegative(-speed / kStribeckSpeeds[0]), ExpOfNegative(-speed / kStribeckSpeeds[1]),
          ExpOfNegative(-speed)};
}

CONTOUR_WIDE_VECTORS
void LinearFriction::Follow(double step_m, double position_m, double velocity_m_s, double acceleration_m_s2,
                            FrictionTermsState& memory, FrictionTerms& terms) const noexcept {
  using namespace friction_term;  // NOLINT(google-build-using-namespace): names of terms only
  const double speed_m_s = std::abs(velocity_m_s);
  const bool shaken = shake_m_ > 0.0;
  const double travel_m = shaken ? std::sqrt(step_m * step_m + shake_m_ * shake_m_) : std::abs(step_m);
  const double fading = velocity_m_s / scale_.sigma1_decay_m_s, speed = speed_m_s / scale_.vs_m_s;
  // Eight exponentials side by side: what the bristles keep, then what speed leaves.
  std::array<double, 8> kept{-travel_m * per_dahl_1_m_[0],
                             -travel_m * per_dahl_1_m_[1],
                             -travel_m * per_dahl_1_m_[2],
                             -travel_m * per_dahl_1_m_[3],
                             -speed / kStribeckSpeeds[0],
                             -speed / kStribeckSpeeds[1],
                             -speed,
                             -fading * fading};
  for (double& k : kept) k = ExpOfNegative(k);
  const double sign = shaken ? step_m / travel_m : step_m > 0.0 ? 1.0 : step_m < 0.0 ? -1.0 : 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    memory.dahl[i] = sign + (memory.dahl[i] - sign) * kept[i];
    memory.stop[i] = std::min(std::max(memory.stop[i] + step_m * per_stop_1_m_[i], -1.0), 1.0);
  }
  const CosSin turn = Turn((position_m - scale_.centre_m) * per_turn_1_m_);
  const double along = (position_m - scale_.centre_m) / scale_.half_stroke_m;
  const std::array<double, 8> towards{sign * kept[4],
                                      sign * kept[5],
                                      kept[6],
                                      sign * along,
                                      sign * turn.cos,
                                      sign * turn.sin,
                                      sign * (turn.cos * turn.cos - turn.sin * turn.sin),
                                      sign * 2.0 * turn.cos * turn.sin};
  for (std::size_t i = 0; i < 8; ++i)
    memory.relaxed[i] = towards[i] + (memory.relaxed[i] - towards[i]) * kept[kNominalDahl];
  for (std::size_t i = 0; i < 4; ++i) {
    terms[kDahl + i] = memory.dahl[i];
    terms[kStop + i] = memory.stop[i];
  }
  const double bristle = memory.dahl[kNominalDahl];
  terms[kConstant] = 1.0;
  terms[kStribeck] = memory.relaxed[0];
  terms[kStribeck + 1] = memory.relaxed[1];
  terms[kEvenStribeck] = memory.relaxed[2];
  terms[kSlowBristle] = memory.stop[kWideStop] * kept[6];
  terms[kDamping] = kept[7] * (velocity_m_s - speed_m_s * bristle) / scale_.vs_m_s;
  for (std::size_t i = 0; i < 4; ++i) terms[kTurn + i] = memory.relaxed[4 + i];
  terms[kEvenTurn] = turn.cos;
  terms[kEvenTurn + 1] = turn.sin;
  terms[kStroke] = memory.relaxed[3];
  terms[kViscous] = velocity_m_s / (kViscousSpeeds * scale_.vs_m_s);
  terms[kMass] = acceleration_m_s2;
  terms[kUsed] = 0.0;
}

}  // namespace contour
