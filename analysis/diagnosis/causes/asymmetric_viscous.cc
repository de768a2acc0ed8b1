#include <string>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/effect_parts.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "analysis/diagnosis/causes/extension_parts.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "asymmetric_viscous";

/// Half the difference with the direction: 1 + d / 2 times the coefficient upwards, 1 - d / 2 downwards.
void Grid(const Problem& p, std::vector<SharedEffect>& out) {
  if (p.nominal.friction.s2 <= 0.0) return;
  const Signals& s = *p.signals;
  const auto half = Make(p.rows(), [&](std::size_t k) {
    return s.velocity[k] > 0.0 ? 0.5 : s.velocity[k] < 0.0 ? -0.5 : 0.0;
  });
  out.push_back(LinearEffect({std::string(kName), "", 1}, Input::kViscous, {half}, 2e-3));
}

Experiment StrokesAtThreeSpeeds(const Problem& problem, bool) {
  return {
      "The same strokes in both directions at a slow, a middle and the highest speed: a difference between "
      "the directions that is one of dry friction is the same at every speed, one of viscous friction grows "
      "with "
      "it.",
      SameStretchAtThreeSpeeds(problem, false).program};
}

/// Shares of one coefficient add up.
void Extend(const Cause& cause, double, ExtensionsConfig& e) {
  Existing(e.asymmetric_viscous).difference_rel += ValueOf(cause, "difference_rel");
}

constexpr ExtensionRule kExtension = {
    .add = Extend,
    .remove = RemoveExtension<&ExtensionsConfig::asymmetric_viscous>,
    .number_of_the_model = false,
    .simulation = [](const ModelConfig&, const ExtensionsConfig& all) -> Assignments {
      if (!all.asymmetric_viscous) return {};
      return {SetEffect(kName, {{"difference_rel", all.asymmetric_viscous->difference_rel}})};
    }};

constexpr Specimen kSpecimen = {.needs = SpecimenNeeds{},
                                .draw = [](const SpecimenMachine&, double sign,
                                           const UniformNumbers&) { return Drawn{.size = sign * 0.1}; },
                                .effect =
                                    [](const Drawn& d, const SpecimenMachine&, const RecordedTime&) {
                                      return Assignments{SetEffect(kName, {{"difference_rel", d.size}})};
                                    },
                                .truth =
                                    [](const Drawn& d, const LogSpan&) {
                                      return NamedValues{{"difference_rel", d.size}};
                                    },
                                .largest_size = 1.8,
                                .size_at = SizeAsStated,
                                .strength_in = StrengthIn::kTorque,
                                .sizes = std::nullopt,
                                .undecidable = nullptr};

}  // namespace

extern const CauseDefinition asymmetric_viscous;
constexpr CauseDefinition asymmetric_viscous = {
    .name = kName,
    .words = "viscous friction differs between the directions",
    .advice =
        "Give the model a viscous coefficient per direction; look for a wiper, cover or seal that drags in "
        "one "
        "direction, and at the lubrication.",
    .grid = Grid,
    .wave = nullptr,
    .family = nullptr,
    .implausible = nullptr,
    .parameters =
        [](const FittedEffect& fitted) {
          return NamedValues{{"difference_rel", fitted.amplitudes()[0]}};
        },
    .main_parameter = "difference_rel",
    .model_errors = kNoModelErrors,
    .shape = nullptr,
    .largest = [](const Problem&) { return 0.7; },
    .freed_terms = kFreesNothing,
    .extension = &kExtension,
    .experiment = StrokesAtThreeSpeeds,
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
