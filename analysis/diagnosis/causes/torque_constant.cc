#include <cmath>
#include <utility>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/effect_parts.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "analysis/diagnosis/causes/extension_parts.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "torque_constant";

/// Stated as a change of the ratio, or as the ratio itself.
double SizeAt(double factor, double stated) {
  return factor * std::abs(stated > 0.5 ? stated - 1.0 : stated);
}

constexpr ExtensionRule kExtension = {
    .add = [](const Cause& cause, double,
              ExtensionsConfig& e) { Existing(e.torque_constant).ratio *= ValueOf(cause, "ratio", 1.0); },
    .remove = RemoveExtension<&ExtensionsConfig::torque_constant>,
    .number_of_the_model = true,
    .simulation = [](const ModelConfig&, const ExtensionsConfig& all) -> Assignments {
      if (!all.torque_constant) return {};
      return {SetEffect(kName, {{"ratio", all.torque_constant->ratio}})};
    }};

constexpr Specimen kSpecimen = {
    .needs = SpecimenNeeds{},
    .draw = [](const SpecimenMachine&, double sign, const UniformNumbers&) { return Drawn{.size = sign}; },
    .effect =
        [](const Drawn& d, const SpecimenMachine&, const RecordedTime&) {
          return Assignments{SetEffect(kName, {{"ratio", 1.0 + d.size}})};
        },
    .truth =
        [](const Drawn& d, const LogSpan&) {
          return NamedValues{{"ratio", 1.0 + d.size}};
        },
    .largest_size = kNoLargestSize,
    .size_at = SizeAt,
    .strength_in = StrengthIn::kTorque,
    .sizes = std::array{0.25, 0.15, 0.09},
    .undecidable = [](const Drawn&, bool barely) { return barely; }};

}  // namespace

extern const CauseDefinition torque_constant;
constexpr CauseDefinition torque_constant = {
    .name = kName,
    .words = "the motor gives another torque than stated for the same command",
    .advice = "Correct the rated torque or the torque constant; check the motor's data in the drive.",
    .grid =
        [](const Problem&, std::vector<SharedEffect>& out) {
          auto e = std::make_shared<Effect>(
              *Custom({std::string(kName), "", 1}, {.steps = {1e-3}, .low = {-0.7}, .high = {2.0}},
                      [](const auto& a, AxisModel& m) { m.torque_gain *= 1.0 + a[0]; }));
          e->common_factor = true;
          out.push_back(std::move(e));
        },
    .wave = nullptr,
    .family = nullptr,
    .implausible = AtItsBound,
    .parameters =
        [](const FittedEffect& fitted) {
          return NamedValues{{"ratio", 1.0 + fitted.amplitudes()[0]}};
        },
    .main_parameter = "ratio",
    .model_errors = kNoModelErrors,
    .shape = nullptr,
    .largest = [](const Problem&) { return 0.35; },
    .freed_terms = kFreesNothing,
    .extension = &kExtension,
    .experiment = FiveSpeedsAndPulses,
    .shows_more_of = std::nullopt,
    .specimen = &kSpecimen,
    .common_factor = true,
    .in_scatter_only = false,
    .coupling = false,
    .takes_up_mismatch = false,
    .refuted_by_mismatch = false,
    .acts_at_reversals = false,
    .judged_at_scale = false,
    .about_timing = false,
    .same_in_sliding = ""};

}  // namespace contour::diagnosis::causes
