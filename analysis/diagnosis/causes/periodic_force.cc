#include <cmath>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "analysis/diagnosis/causes/waves.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "periodic_force";

constexpr WaveSource kWave = {.wave = Wave::kForceOfTime, .has_order = AnyOrder, .free_order = true};

constexpr Specimen kSpecimen = {
    .needs = SpecimenNeeds{},
    .draw =
        [](const SpecimenMachine& m, double, const UniformNumbers& uniform) {
          return Drawn{.size = 0.05 * m.friction_Nm, .order = BetweenInLogarithm(7.0, 70.0, uniform)};
        },
    .effect =
        [](const Drawn& d, const SpecimenMachine&, const RecordedTime&) {
          return Assignments{SetEffect(
              kName, {{"amplitude_Nm", d.size}, {"frequency_Hz", d.order}, {"phase_rad", d.phase_rad}})};
        },
    .truth =
        [](const Drawn& d, const LogSpan&) {
          return NamedValues{{"amplitude_Nm", std::abs(d.size)}, {"frequency_Hz", d.order}};
        },
    .largest_size = kNoLargestSize,
    .size_at = SizeAsStated,
    .strength_in = StrengthIn::kTorque,
    .sizes = std::nullopt,
    .undecidable = nullptr};

}  // namespace

extern const CauseDefinition periodic_force;
constexpr CauseDefinition periodic_force = {
    .name = kName,
    .words = "a vibration from outside at a fixed frequency",
    .advice = "Find the machine, pump or fan that runs at that frequency.",
    .grid = nullptr,
    .wave = &kWave,
    .family = nullptr,
    .implausible = nullptr,
    .parameters =
        [](const FittedEffect& fitted) {
          return WaveParameters(fitted, "amplitude_Nm", "frequency_Hz", 1.0);
        },
    .main_parameter = "amplitude_Nm",
    .model_errors = kNoModelErrors,
    .shape = nullptr,
    .largest = [](const Problem& p) { return 0.7 * p.signals->ForceScale(); },
    .freed_terms = kFreesNothing,
    .extension = nullptr,
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
