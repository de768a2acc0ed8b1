#include <algorithm>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/effect_parts.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "analysis/diagnosis/causes/extension_parts.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "current_lag";

constexpr std::string_view kFrees[] = {"lag"};

constexpr ExtensionRule kExtension = {
    .add =
        [](const Cause& cause, double, ExtensionsConfig& e) {
          Existing(e.current_lag).time_constant_us += ValueOf(cause, "time_constant_us");
        },
    .remove = RemoveExtension<&ExtensionsConfig::current_lag>,
    .number_of_the_model = true,
    .simulation = [](const ModelConfig&, const ExtensionsConfig& all) -> Assignments {
      if (!all.current_lag) return {};
      return {SetEffect(kName, {{"time_constant_us", std::max(0.0, all.current_lag->time_constant_us)}})};
    }};

constexpr Specimen kSpecimen = {
    .needs = SpecimenNeeds{},
    .draw = [](const SpecimenMachine&, double, const UniformNumbers&) { return Drawn{.size = 100.0}; },
    .effect =
        [](const Drawn& d, const SpecimenMachine&, const RecordedTime&) {
          return Assignments{SetEffect(kName, {{"time_constant_us", d.size}})};
        },
    .truth =
        [](const Drawn& d, const LogSpan&) {
          return NamedValues{{"time_constant_us", d.size}};
        },
    .largest_size = 2000.0,
    .size_at = SizeAsStated,
    .strength_in = StrengthIn::kTorque,
    .sizes = std::nullopt,
    .undecidable = nullptr};

}  // namespace

extern const CauseDefinition current_lag;
constexpr CauseDefinition current_lag = {
    .name = kName,
    .words = "the current loop is slower than stated",
    .advice = "State the lag; retune the current loop.",
    .grid =
        [](const Problem& p, std::vector<SharedEffect>& out) {
          // Below no lag at all nothing changes any more.
          out.push_back(Custom({std::string(kName), "", 1},
                               {.steps = {2e-6}, .low = {-p.nominal.lag_s}, .high = {kNoBound}},
                               [](const auto& a, AxisModel& m) { m.lag_s = std::max(0.0, m.lag_s + a[0]); }));
        },
    .wave = nullptr,
    .family = nullptr,
    .implausible = nullptr,
    .parameters =
        [](const FittedEffect& fitted) {
          return NamedValues{{"time_constant_us", fitted.amplitudes()[0] * 1e6}};
        },
    .main_parameter = "time_constant_us",
    .model_errors = kNoModelErrors,
    .shape = nullptr,
    .largest = [](const Problem& p) { return 3.0 * p.log.period_s; },
    .freed_terms = kFrees,
    .extension = &kExtension,
    .experiment = ChirpWhileCreeping,
    .shows_more_of = std::nullopt,
    .specimen = &kSpecimen,
    .common_factor = false,
    .in_scatter_only = false,
    .coupling = false,
    .takes_up_mismatch = false,
    .refuted_by_mismatch = false,
    .acts_at_reversals = false,
    .judged_at_scale = false,
    .about_timing = true,
    .same_in_sliding = ""};

}  // namespace contour::diagnosis::causes
