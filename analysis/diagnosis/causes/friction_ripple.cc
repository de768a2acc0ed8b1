#include <cmath>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "analysis/diagnosis/causes/extension_parts.h"
#include "analysis/diagnosis/causes/waves.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "friction_ripple";

constexpr WaveSource kWave = {.wave = Wave::kFrictionOfAngle, .has_order = IsWholeOrder, .free_order = false};

constexpr ModelError kErrors[] = {{"amplitude_rel", 0.01}};

constexpr ExtensionRule kExtension = {
    .add = [](const Cause& cause, double, ExtensionsConfig& e) { AddRipple(cause, e.friction_ripple); },
    .remove = RemoveExtension<&ExtensionsConfig::friction_ripple>,
    .number_of_the_model = false,
    .simulation = [](const ModelConfig&,
                     const ExtensionsConfig& all) { return RippleInSimulation(kName, all.friction_ripple); }};

constexpr Specimen kSpecimen = {
    .needs = SpecimenNeeds{},
    .draw =
        [](const SpecimenMachine&, double, const UniformNumbers& uniform) {
          return Drawn{.size = 0.05, .order = 1.0 + std::floor(4.0 * uniform())};
        },
    .effect = [](const Drawn& d, const SpecimenMachine&,
                 const RecordedTime&) { return DrawnRipple(kName, d); },
    .truth =
        [](const Drawn& d, const LogSpan&) {
          return NamedValues{{"amplitude_rel", std::abs(d.size)}, {"order_per_rev", d.order}};
        },
    .largest_size = 0.8,
    .size_at = SizeAsStated,
    .strength_in = StrengthIn::kTorque,
    .sizes = std::nullopt,
    .undecidable = nullptr};

}  // namespace

extern const CauseDefinition friction_ripple;
constexpr CauseDefinition friction_ripple = {
    .name = kName,
    .words = "friction changes a whole number of times per motor turn",
    .advice = "Feed the ripple forward; look at coupling alignment and the screw's run-out.",
    .grid = nullptr,
    .wave = &kWave,
    .family = nullptr,
    .implausible = nullptr,
    .parameters =
        [](const FittedEffect& fitted) {
          return WaveParameters(fitted, "amplitude_rel", "order_per_rev", 1.0);
        },
    .main_parameter = "amplitude_rel",
    .model_errors = kErrors,
    .shape = nullptr,
    .largest = [](const Problem&) { return 0.7; },
    .freed_terms = kFreesNothing,
    .extension = &kExtension,
    .experiment = SameStretchAtThreeSpeeds,
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
