#include <algorithm>
#include <cmath>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/effect_parts.h"
#include "analysis/diagnosis/causes/experiments.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "cross_coupling";

void Grid(const Problem& p, std::vector<SharedEffect>& out) {
  const Signals& s = *p.signals;
  if (s.axis2_m_s2.empty()) return;
  out.push_back(LinearEffect({std::string(kName), "", 1}, Input::kLoadForce,
                             {std::make_shared<const Signal>(s.axis2_m_s2)}, 0.01 * s.ForceScale()));
}

/// As much as friction, at the other axis's highest acceleration.
double Largest(const Problem& p) {
  double top = 0.0;
  for (const double a : p.signals->axis2_m_s2) top = std::max(top, std::fabs(a));
  return top > 0.01 ? p.signals->ForceScale() / top : 0.0;
}

constexpr ModelError kErrors[] = {{"torque_per_acceleration_Nms2_m", 0.02}};

constexpr Specimen kSpecimen = {
    .needs = SpecimenNeeds{.second_axis = true},
    .draw = [](const SpecimenMachine&, double sign,
               const UniformNumbers&) { return Drawn{.size = sign * 1e-3}; },
    .effect =
        [](const Drawn& d, const SpecimenMachine& m, const RecordedTime&) {
          return Assignments{
              SetEffect(kName, {{"axis", m.other_axis}, {"torque_per_acceleration_Nms2_m", d.size}})};
        },
    .truth =
        [](const Drawn& d, const LogSpan&) {
          return NamedValues{{"torque_per_acceleration_Nms2_m", d.size}};
        },
    .largest_size = kNoLargestSize,
    .size_at = SizeAsStated,
    .strength_in = StrengthIn::kTorque,
    .sizes = std::nullopt,
    .undecidable = nullptr};

}  // namespace

extern const CauseDefinition cross_coupling;
constexpr CauseDefinition cross_coupling = {
    .name = kName,
    .words = "the other axis pushes this one when it accelerates",
    .advice = "Feed the other axis's acceleration forward.",
    .grid = Grid,
    .wave = nullptr,
    .family = nullptr,
    .implausible = nullptr,
    .parameters =
        [](const FittedEffect& fitted) {
          return NamedValues{{"torque_per_acceleration_Nms2_m", fitted.amplitudes()[0]}};
        },
    .main_parameter = "torque_per_acceleration_Nms2_m",
    .model_errors = kErrors,
    .shape = nullptr,
    .largest = Largest,
    .freed_terms = kFreesNothing,
    .extension = nullptr,
    .experiment = OtherAxisMoves,
    .shows_more_of = std::nullopt,
    .specimen = &kSpecimen,
    .common_factor = false,
    .in_scatter_only = false,
    .coupling = false,
    .takes_up_mismatch = false,
    .refuted_by_mismatch = false,
    .acts_at_reversals = false,
    .judged_at_scale = false,
    .about_timing = false,
    .same_in_sliding = ""};

}  // namespace contour::diagnosis::causes
