#include "analysis/diagnosis/causes/effect_parts.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "analysis/diagnosis/causes/extension_parts.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "asymmetric_coulomb";

void ScaleLevels(double difference, AxisModel& m) {
  m.friction.Fc_plus *= 1.0 + 0.5 * difference;
  m.friction.Fs_plus *= 1.0 + 0.5 * difference;
  m.friction.Fc_minus *= 1.0 - 0.5 * difference;
  m.friction.Fs_minus *= 1.0 - 0.5 * difference;
}

void Grid(const Problem&, std::vector<SharedEffect>& out) {
  out.push_back(Custom({std::string(kName), "", 1}, {.steps = {2e-3}, .low = {-1.8}, .high = {1.8}},
                       [](const auto& a, AxisModel& m) { ScaleLevels(a[0], m); }));
}

constexpr ModelError kErrors[] = {{"difference_rel", 0.02}};

/// Factors 1 + d / 2 and 1 - d / 2, twice: the difference of the products over their mean.
void Extend(const Cause& cause, double, ExtensionsConfig& e) {
  double& d = Existing(e.asymmetric_coulomb).difference_rel;
  const double by = ValueOf(cause, "difference_rel");
  d = (d + by) / (1.0 + 0.25 * d * by);
}

constexpr ExtensionRule kExtension = {
    .add = Extend,
    .remove = RemoveExtension<&ExtensionsConfig::asymmetric_coulomb>,
    .number_of_the_model = true,
    .simulation = [](const ModelConfig&, const ExtensionsConfig& all) -> Assignments {
      if (!all.asymmetric_coulomb) return {};
      return {SetEffect(kName, {{"difference_rel", all.asymmetric_coulomb->difference_rel}})};
    }};

constexpr Specimen kSpecimen = {.needs = SpecimenNeeds{},
                                .draw = [](const SpecimenMachine&, double sign,
                                           const UniformNumbers&) { return Drawn{.size = sign * 0.05}; },
                                .effect =
                                    [](const Drawn& d, const SpecimenMachine&, const RecordedTime&) {
                                      return Assignments{SetEffect(kName, {{"difference_rel", d.size}})};
                                    },
                                .truth =
                                    [](const Drawn& d, const LogSpan&) {
                                      return NamedValues{{"difference_rel", d.size}};
                                    },
                                .largest_size = 0.8,
                                .size_at = SizeAsStated,
                                .strength_in = StrengthIn::kTorque,
                                .sizes = std::nullopt,
                                .undecidable = nullptr};

}  // namespace

extern const CauseDefinition asymmetric_coulomb;
constexpr CauseDefinition asymmetric_coulomb = {
    .name = kName,
    .words = "dry friction differs between the directions",
    .advice =
        "Give the model a Coulomb level per direction; look for a preloaded cover or wiper that drags in "
        "one direction.",
    .grid = Grid,
    .wave = nullptr,
    .family = nullptr,
    .implausible = nullptr,
    .parameters =
        [](const FittedEffect& fitted) {
          return NamedValues{{"difference_rel", fitted.amplitudes()[0]}};
        },
    .main_parameter = "difference_rel",
    .model_errors = kErrors,
    .shape = nullptr,
    .largest = [](const Problem&) { return 0.7; },
    .freed_terms = kFreesNothing,
    .extension = &kExtension,
    .experiment = TorqueStepsFromRest,
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
    .same_in_sliding = "levels of either direction"};

}  // namespace contour::diagnosis::causes
