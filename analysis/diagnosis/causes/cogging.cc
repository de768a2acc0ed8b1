#include <cmath>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "analysis/diagnosis/causes/extension_parts.h"
#include "analysis/diagnosis/causes/waves.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "cogging";

constexpr WaveSource kWave = {.wave = Wave::kTorqueOfAngle, .has_order = AnyOrder, .free_order = false};

void Extend(const Cause& cause, double, ExtensionsConfig& e) {
  AddWave(e.cogging, &CoggingWave::amplitude_Nm,
          CoggingWave{ValueOf(cause, "amplitude_Nm"), ValueOf(cause, "order_per_rev", 1.0),
                      ValueOf(cause, "phase_rad")});
}

Assignments Simulation(const ModelConfig&, const ExtensionsConfig& all) {
  if (!all.cogging) return {};
  std::vector<std::string> further;
  for (const CoggingWave& w : all.cogging->further)
    further.push_back(MapText(
        {{"amplitude_Nm", w.amplitude_Nm}, {"order_per_rev", w.order_per_rev}, {"phase_rad", w.phase_rad}}));
  return {SetEffect(kName, {{"amplitude_Nm", all.cogging->amplitude_Nm},
                            {"order_per_rev", all.cogging->order_per_rev},
                            {"phase_rad", all.cogging->phase_rad},
                            {"further", further}})};
}

constexpr ExtensionRule kExtension = {.add = Extend,
                                      .remove = RemoveExtension<&ExtensionsConfig::cogging>,
                                      .number_of_the_model = false,
                                      .simulation = Simulation};

constexpr Specimen kSpecimen = {
    .needs = SpecimenNeeds{},
    .draw =
        [](const SpecimenMachine& m, double, const UniformNumbers& uniform) {
          const double orders[] = {4.0, 6.0, 8.0, 12.0, 24.0};
          return Drawn{.size = 0.05 * m.friction_Nm,
                       .order = orders[static_cast<std::size_t>(5.0 * uniform())]};
        },
    .effect =
        [](const Drawn& d, const SpecimenMachine&, const RecordedTime&) {
          return Assignments{SetEffect(
              kName, {{"amplitude_Nm", d.size}, {"order_per_rev", d.order}, {"phase_rad", d.phase_rad}})};
        },
    .truth =
        [](const Drawn& d, const LogSpan&) {
          return NamedValues{{"amplitude_Nm", std::abs(d.size)}, {"order_per_rev", d.order}};
        },
    .largest_size = kNoLargestSize,
    .size_at = SizeAsStated,
    .strength_in = StrengthIn::kTorque,
    .sizes = std::nullopt,
    .undecidable = nullptr};

}  // namespace

extern const CauseDefinition cogging;
constexpr CauseDefinition cogging = {
    .name = kName,
    .words =
        "a torque that repeats with the motor angle, the same in both directions: detent torque of the motor",
    .advice = "Feed the torque forward.",
    .grid = nullptr,
    .wave = &kWave,
    .family = nullptr,
    .implausible = nullptr,
    .parameters =
        [](const FittedEffect& fitted) {
          return WaveParameters(fitted, "amplitude_Nm", "order_per_rev", 1.0);
        },
    .main_parameter = "amplitude_Nm",
    .model_errors = kNoModelErrors,
    .shape = nullptr,
    .largest = [](const Problem& p) { return 0.7 * p.signals->ForceScale(); },
    .freed_terms = kFreesNothing,
    .extension = &kExtension,
    .experiment = SameStretchAtThreeSpeeds,
    .shows_more_of = Quantity::kAngle,
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
