#include <algorithm>
#include <cmath>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/drift.h"
#include "analysis/diagnosis/causes/experiments.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "friction_drift";

/// Share of a drift that is done at a time of the machine.
double Done(const Drawn& d, const LogSpan& span, double time_s) {
  return d.second > 0.0 ? 1.0 - std::exp(-time_s / d.second) : std::min(1.0, time_s / span.planned_end_s);
}

constexpr ModelError kErrors[] = {{"change_rel", 0.03}};

constexpr Specimen kSpecimen = {
    .needs = SpecimenNeeds{},
    .draw =
        [](const SpecimenMachine&, double sign, const UniformNumbers& uniform) {
          const bool linear = uniform() < 0.5;
          return Drawn{.size = sign * 0.1, .second = linear ? 0.0 : Between(10.0, 30.0, uniform)};
        },
    .effect =
        [](const Drawn& d, const SpecimenMachine&, const RecordedTime& time) {
          return Assignments{SetEffect(kName, {{"change_rel", d.size},
                                               {"over_s", time.begin_s + time.duration_s},
                                               {"time_constant_s", d.second}})};
        },
    .truth =
        [](const Drawn& d, const LogSpan& span) {
          const double first = 1.0 + d.size * Done(d, span, span.begin_s);
          const double last = 1.0 + d.size * Done(d, span, span.end_s);
          return NamedValues{{"change_rel", last / first - 1.0}};
        },
    .largest_size = 0.8,
    .size_at = SizeAsStated,
    .strength_in = StrengthIn::kTorque,
    .sizes = std::nullopt,
    .undecidable = nullptr};

}  // namespace

extern const CauseDefinition friction_drift;
constexpr CauseDefinition friction_drift = {
    .name = kName,
    .words = "dry friction changes over the time of the log",
    .advice = "Warm up or run in longer before identifying; let the estimator follow the level.",
    .grid = [](const Problem& p, std::vector<SharedEffect>& out) { Drifts(p, kName, Input::kLevel, out); },
    .wave = nullptr,
    .family = nullptr,
    .implausible = nullptr,
    .parameters = ChangeOverLog,
    .main_parameter = "change_rel",
    .model_errors = kErrors,
    .shape = nullptr,
    .largest = [](const Problem&) { return 0.7; },
    .freed_terms = kFreesNothing,
    .extension = nullptr,
    .experiment = SameStrokesWarmAndCold,
    .shows_more_of = Quantity::kTime,
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
