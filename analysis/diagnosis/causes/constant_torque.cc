#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/effect_parts.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "analysis/diagnosis/causes/extension_parts.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "constant_torque";

// Where a constant torque is stated.
constexpr std::string_view kFrees[] = {"offset"};

constexpr ExtensionRule kExtension = {
    .add = [](const Cause& cause, double,
              ExtensionsConfig& e) { Existing(e.constant_torque).torque_Nm += ValueOf(cause, "torque_Nm"); },
    .remove = RemoveExtension<&ExtensionsConfig::constant_torque>,
    .number_of_the_model = false,
    .simulation = [](const ModelConfig&, const ExtensionsConfig& all) -> Assignments {
      if (!all.constant_torque) return {};
      return {SetEffect(kName, {{"torque_Nm", all.constant_torque->torque_Nm}})};
    }};

constexpr Specimen kSpecimen = {
    .needs = SpecimenNeeds{},
    .draw = [](const SpecimenMachine& m, double sign,
               const UniformNumbers&) { return Drawn{.size = sign * 0.05 * m.friction_Nm}; },
    .effect =
        [](const Drawn& d, const SpecimenMachine&, const RecordedTime&) {
          return Assignments{SetEffect(kName, {{"torque_Nm", d.size}})};
        },
    .truth =
        [](const Drawn& d, const LogSpan&) {
          return NamedValues{{"torque_Nm", d.size}};
        },
    .largest_size = kNoLargestSize,
    .size_at = SizeAsStated,
    .strength_in = StrengthIn::kTorque,
    .sizes = std::nullopt,
    .undecidable = nullptr};

}  // namespace

extern const CauseDefinition constant_torque;
constexpr CauseDefinition constant_torque = {
    .name = kName,
    .words = "a torque that is always there: weight, or an offset of the current sensor",
    .advice = "State it as a constant torque; check the counterbalance and the drive's current offset.",
    .grid =
        [](const Problem& p, std::vector<SharedEffect>& out) {
          out.push_back(
              WithForce(Custom({std::string(kName), "", 1}, {.steps = {0.01 * p.signals->ForceScale()}},
                               [](const auto& a, AxisModel& m) { m.offset += a[0]; }),
                        {1}));
        },
    .wave = nullptr,
    .family = nullptr,
    .implausible = nullptr,
    .parameters =
        [](const FittedEffect& fitted) {
          return NamedValues{{"torque_Nm", fitted.amplitudes()[0]}};
        },
    .main_parameter = "torque_Nm",
    .model_errors = kNoModelErrors,
    .shape = nullptr,
    .largest = [](const Problem& p) { return 0.7 * p.signals->ForceScale(); },
    .freed_terms = kFrees,
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
