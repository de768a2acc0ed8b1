#include "analysis/circle_test/circle_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "config/extended_model.h"
#include "core/mechanics.h"

namespace contour {
namespace {

// Standard deviations below which a wave is none.
constexpr double kSigmas = 3.0;
constexpr double kMostShare = 0.9;
// Relative, where none is stated: as loop_limits.uncertainty.
constexpr double kStiffnessStd = 0.1;

double Rounded(double value, double step) { return step * std::round(value / step); }

}  // namespace

CircleAxis CircleAxisOf(const std::string& name, const ModelConfig& model) {
  const Mechanics m = ToSi(Extended(model).mechanics);
  return {name, m.stiffness_N_m, m.table_mass_kg, m.mass_kg, 2.0 * std::numbers::pi * m.radius_m_rad};
}

void IntoModel(const CircleAxisFound& found, ModelConfig& model) {
  model.friction.motor_share_rel = Rounded(std::clamp(found.motor_share.value, 0.0, kMostShare), 1e-3);
  // The wind-up is what was seen: what K may be off by is in the share.
  const auto stiffness = model.uncertainty.find("screw_stiffness_N_um");
  const double stiffness_std = stiffness == model.uncertainty.end() ? kStiffnessStd : stiffness->second;
  const double share_std =
      std::hypot(found.motor_share.std, (1.0 - model.friction.motor_share_rel) * stiffness_std);
  model.uncertainty["motor_share_rel"] = std::max(Rounded(share_std, 1e-3), 1e-3);
  if (!found.wobble_seen) return;
  model.extensions.lead_wobble.reset();
  const double sine = found.wobble_sine.value, cosine = found.wobble_cosine.value;
  const double size = std::hypot(sine, cosine);
  if (!(size > kSigmas * std::hypot(found.wobble_sine.std, found.wobble_cosine.std))) return;
  LeadWobbleExtension wobble;
  wobble.amplitude_um = Rounded(1e6 * size, 1e-4);
  wobble.order_per_rev = 1.0;
  wobble.phase_rad = Rounded(std::atan2(cosine, sine), 1e-4);
  model.extensions.lead_wobble = wobble;
}

}  // namespace contour
