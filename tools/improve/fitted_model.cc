#include "tools/improve/fitted_model.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "analysis/axis_model/fitted_config.h"
#include "analysis/axis_model/scale_parameter.h"
#include "analysis/diagnosis/causes/extensions_of.h"
#include "analysis/prediction_error/base_terms.h"
#include "config/yaml_writer.h"

namespace contour::improve {
namespace {

using diagnosis::Diagnosis;
using diagnosis::StatedAxis;

/// A number is learnt where the log says more of it than what is stated: the fit holds both, so that it knows
/// it 1 / sqrt(2) times as well where they say as much; half stands for a log that says three times as much.
constexpr double kLearntShare = 0.5;

/// The stated axis with the factors that one-step errors ask for.
StatedAxis ByOneStepErrors(StatedAxis axis, const Diagnosis& found) {
  for (const diagnosis::BaseParameter& p : found.base) {
    if (!(p.stated > 0.0) || !(p.fitted > 0.0) || !std::isfinite(p.fitted)) continue;
    if (diagnosis::ScaleParameter(axis, p.name, p.fitted / p.stated)) axis.sigma[p.name] = p.sigma / p.fitted;
  }
  return axis;
}

/// Free runs of a second show nothing of a screw that swings a hundred times in it; one-step errors do.
StatedAxis WithScrewOf(const StatedAxis& by_one_step, StatedAxis axis) {
  axis.stiffness = by_one_step.stiffness;
  axis.damping = by_one_step.damping;
  axis.sigma["stiffness"] = by_one_step.sigma.at("stiffness");
  return axis;
}

bool HasScrew(const Diagnosis& found) {
  return std::any_of(found.base.begin(), found.base.end(), [](const diagnosis::BaseParameter& p) {
    return p.name == "stiffness" && p.stated > 0.0 && p.fitted > 0.0 && std::isfinite(p.fitted);
  });
}

/// Of the screw a record without a chirp says next to nothing; then what is stated stands.
void KeepScrewUnlessLearnt(const StatedAxis& stated, StatedAxis& axis) {
  const auto sigma = axis.sigma.find("stiffness");
  const double known = diagnosis::StatedSigma(stated, "stiffness");
  if (sigma != axis.sigma.end() && sigma->second < kLearntShare * known) return;
  axis.stiffness = stated.stiffness;
  axis.damping = stated.damping;
}

ModelConfig Model(ModelConfig model, const StatedAxis& stated, StatedAxis axis,
                  const std::vector<diagnosis::Cause>& causes, double first_temperature_degC) {
  ExtensionsConfig& e = model.extensions;
  // Behind a torque constant of their own the numbers are not those of the model.
  if (!e.torque_constant) {
    KeepScrewUnlessLearnt(stated, axis);
    const auto uncertainty = model.uncertainty;
    diagnosis::IntoConfig(axis, model);
    model.uncertainty = uncertainty;
    // Where the record tells the two levels hardly apart, the fit may cross them, which no model may.
    FrictionConfig& f = model.friction;
    f.Fs_plus_N = std::max(f.Fs_plus_N, f.Fc_plus_N);
    f.Fs_minus_N = std::max(f.Fs_minus_N, f.Fc_minus_N);
    f.Fs_plus_Nm = std::max(f.Fs_plus_Nm, f.Fc_plus_Nm);
    f.Fs_minus_Nm = std::max(f.Fs_minus_Nm, f.Fc_minus_Nm);
    e.asymmetric_coulomb.reset();  // these three stand for numbers, and are in them now
    e.stribeck.reset();
    e.compliance.reset();
    if (e.constant_torque) e.constant_torque->torque_Nm = diagnosis::FiveDigits(axis.offset);
  }
  diagnosis::AddCauses(causes, first_temperature_degC, e);
  return model;
}

}  // namespace

std::vector<ModelConfig> FittedModels(const ModelConfig& model, const StatedAxis& stated,
                                      const Diagnosis& found, double first_temperature_degC) {
  if (!found.fitted) return {};
  std::vector<ModelConfig> out;
  std::set<std::string> known{WriteYaml(Model(model, stated, stated, {}, first_temperature_degC))};
  const auto add = [&](const StatedAxis& axis, const std::vector<diagnosis::Cause>& causes) {
    ModelConfig now = Model(model, stated, axis, causes, first_temperature_degC);
    if (known.insert(WriteYaml(now)).second) out.push_back(std::move(now));
  };
  const StatedAxis by_one_step = ByOneStepErrors(stated, found);
  add(HasScrew(found) ? WithScrewOf(by_one_step, *found.fitted) : *found.fitted, found.in_model);
  add(by_one_step, found.causes);
  return out;
}

}  // namespace contour::improve
