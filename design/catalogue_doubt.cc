#include "design/catalogue_doubt.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>

namespace contour {
namespace {

constexpr double kDeviations = 2.0;
/// Nothing that is no measurement of the axis itself is known better.
constexpr double kLeast = 0.05;

/// The largest of these that is stated; none when one of them is not.
std::optional<double> Stated(const ModelConfig& model, std::initializer_list<const char*> keys) {
  double largest = kLeast;
  for (const char* key : keys) {
    const auto at = model.uncertainty.find(key);
    if (at == model.uncertainty.end()) return std::nullopt;
    largest = std::max(largest, kDeviations * at->second);
  }
  return largest;
}

}  // namespace

CatalogueDoubt DoubtOf(const ModelConfig& model) {
  CatalogueDoubt doubt;
  if (const auto masses = Stated(model, {"motor_inertia_kgm2", "table_mass_kg"}))
    doubt.masses_rel = std::min(doubt.masses_rel, *masses);
  if (const auto stiffness = Stated(model, {"screw_stiffness_N_um"}))
    doubt.stiffness_factor = std::min(doubt.stiffness_factor, std::exp(*stiffness));
  const bool on_table = model.friction.acts_on == FrictionSide::kTable;
  if (const auto friction = on_table ? Stated(model, {"Fc_plus_N", "Fc_minus_N", "sigma0_N_m"})
                                     : Stated(model, {"Fc_plus_Nm", "Fc_minus_Nm", "sigma0_Nm_rad"}))
    doubt.friction_factor = std::min(doubt.friction_factor, std::exp(*friction));
  return doubt;
}

void LeaveScrewOpen(ModelConfig& found, const ModelConfig& stated, bool stiffness_seen) {
  const CatalogueDoubt doubt = DoubtOf(stated);
  const auto open = [&](const char* key, double two_deviations) {
    double& deviation = found.uncertainty[key];
    deviation = std::max(deviation, two_deviations / kDeviations);
  };
  if (!stiffness_seen) open("screw_stiffness_N_um", std::log(doubt.stiffness_factor));
  open("motor_inertia_kgm2", doubt.masses_rel);
  open("table_mass_kg", doubt.masses_rel);
}

}  // namespace contour
