#include <algorithm>
#include <cmath>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/effect_parts.h"
#include "analysis/diagnosis/causes/experiments.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "friction_drift";

void Grid(const Problem& p, std::vector<SharedEffect>& out) {
  const std::size_t n = p.rows();
  const std::string kind(kName);
  const auto part = [n](std::size_t k) { return static_cast<double>(k) / static_cast<double>(n); };
  out.push_back(LinearEffect({kind, "linear", 3}, Input::kLevel,
                             {Make(n, [&](std::size_t k) { return part(k) - 0.5; })}, 5e-3));
  for (const double tau : {0.08, 0.25})
    out.push_back(WithOrder(
        ShapedEffect(
            p, {kind, "exponential " + std::to_string(tau), 3}, Input::kLevel, 5e-3, {-1.2, 1.0},
            [part, tau](std::size_t k, double x) { return 0.5 - std::exp(-part(k) / (tau * std::exp(x))); }),
        tau));
}

NamedValues Parameters(const FittedEffect& fitted) {
  const Problem& p = fitted.problem;
  const Effect& e = fitted.effect();
  const std::vector<double>& a = fitted.amplitudes();
  const double seconds = p.log.period_s * static_cast<double>(p.rows());
  if (e.order <= 0.0) return {{"change_rel", a[0] / (1.0 - 0.5 * a[0])}};
  const double tau = e.order * std::exp(a[1]);
  return {{"change_rel", a[0] * (1.0 - std::exp(-1.0 / tau)) / (1.0 - 0.5 * a[0])},
          {"time_constant_s", tau * seconds}};
}

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
    .words = "friction changes over the time of the log",
    .advice = "Warm up or run in longer before identifying; let the estimator follow the level.",
    .grid = Grid,
    .wave = nullptr,
    .family = nullptr,
    .implausible = nullptr,
    .parameters = Parameters,
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
