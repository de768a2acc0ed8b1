#include "tools/improve/fitted_model.h"

#include <cmath>
#include <initializer_list>

#include "analysis/diagnosis/causes/extensions_of.h"

namespace contour::improve {
namespace {

/// A number is learnt where the fit knows it at least so much better than it was stated.
constexpr double kLearntShare = 0.5;
/// Of a stiffness for which nothing is stated, as diagnosis has it.
constexpr double kUsualUncertainty = 0.1;

}  // namespace

ModelConfig FittedModel(ModelConfig model, const diagnosis::Diagnosis& found, double first_temperature_degC) {
  // Numbers that the fit has by other names are products of the model's: the same factor.
  const auto scale = [&](const char* name, std::initializer_list<double*> values) {
    for (const diagnosis::BaseParameter& p : found.base)
      if (p.name == name && p.stated > 0.0 && p.fitted > 0.0 && std::isfinite(p.fitted))
        for (double* value : values) *value *= p.fitted / p.stated;
  };
  // Of the screw a record without a chirp says next to nothing; then what is stated stands.
  const auto learnt = [&](const char* name, const char* key) {
    const auto stated = model.uncertainty.find(key);
    const double known = stated == model.uncertainty.end() ? kUsualUncertainty : stated->second;
    for (const diagnosis::BaseParameter& p : found.base)
      if (p.name == name) return p.sigma < kLearntShare * known * p.stated;
    return false;
  };
  MechanicsConfig& m = model.mechanics;
  FrictionConfig& f = model.friction;
  scale("inertia", {&m.motor_inertia_kgm2});
  scale("load_inertia", {&m.table_mass_kg});
  if (learnt("stiffness", "screw_stiffness_N_um")) {
    scale("stiffness", {&m.screw_stiffness_N_um});
    scale("damping", {&m.screw_damping_Ns_m});
  }
  scale("Fc", {&f.Fc_plus_N, &f.Fc_minus_N, &f.Fc_plus_Nm, &f.Fc_minus_Nm});
  scale("Fs", {&f.Fs_plus_N, &f.Fs_minus_N, &f.Fs_plus_Nm, &f.Fs_minus_Nm});
  scale("vs", {&f.vs_mm_s, &f.vs_rad_s});
  scale("s0", {&f.sigma0_N_m, &f.sigma0_Nm_rad});
  scale("s1", {&f.sigma1_Ns_m, &f.sigma1_Nms_rad});
  scale("s2", {&f.sigma2_Ns_m, &f.sigma2_Nms_rad});
  diagnosis::AddCauses(found.causes, first_temperature_degC, model.extensions);
  return model;
}

}  // namespace contour::improve
