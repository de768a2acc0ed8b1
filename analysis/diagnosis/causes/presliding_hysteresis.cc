#include <algorithm>
#include <cmath>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/effect_parts.h"
#include "analysis/diagnosis/causes/experiments.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "presliding_hysteresis";

void Grid(const Problem&, std::vector<SharedEffect>& out) {
  for (const double ratio : {0.03, 0.1, 0.3})
    out.push_back(Custom({std::string(kName), "ratio " + std::to_string(ratio), 3},
                         {.steps = {0.03, 0.02}, .start = {0.1, 0.0}, .low = {0.0, -2.0}, .high = {0.9, 2.0}},
                         [ratio](const auto& a, AxisModel& m) {
                           m.soft_share = std::max(0.0, a[0]);
                           m.soft_ratio = ratio * std::exp(a[1]);
                         }));
}

NamedValues Parameters(const FittedEffect& fitted) {
  const AxisModel m = fitted.problem.Build(fitted.point);
  return {{"share_rel", m.soft_share}, {"stiffness_ratio", m.soft_ratio}};
}

constexpr ModelError kErrors[] = {{"share_rel", 0.02}};

constexpr Specimen kSpecimen = {
    .needs = SpecimenNeeds{},
    .draw =
        [](const SpecimenMachine&, double, const UniformNumbers& uniform) {
          return Drawn{.size = 0.1, .second = Between(0.05, 0.2, uniform)};
        },
    .effect =
        [](const Drawn& d, const SpecimenMachine&, const RecordedTime&) {
          return Assignments{SetEffect(kName, {{"share_rel", d.size}, {"stiffness_ratio", d.second}})};
        },
    .truth =
        [](const Drawn& d, const LogSpan&) {
          return NamedValues{{"share_rel", d.size}};
        },
    .largest_size = 0.8,
    .size_at = SizeAsStated,
    .strength_in = StrengthIn::kTorque,
    .sizes = std::nullopt,
    .undecidable = nullptr};

}  // namespace

extern const CauseDefinition presliding_hysteresis;
constexpr CauseDefinition presliding_hysteresis = {
    .name = kName,
    .words = "a second, softer friction element acts before the axis slides",
    .advice =
        "Expect larger tracking errors right after reversals; a model with several elements describes it.",
    .grid = Grid,
    .wave = nullptr,
    .family = nullptr,
    .implausible = nullptr,
    .parameters = Parameters,
    .main_parameter = "share_rel",
    .model_errors = kErrors,
    .shape = nullptr,
    .largest = [](const Problem&) { return 0.7; },
    .freed_terms = kFreesNothing,
    .extension = nullptr,
    .experiment = GrowingReversalsOrNone,
    .shows_more_of = std::nullopt,
    .specimen = &kSpecimen,
    .common_factor = false,
    .in_scatter_only = false,
    .coupling = false,
    .takes_up_mismatch = true,
    .refuted_by_mismatch = false,
    .acts_at_reversals = true,
    .judged_at_scale = false,
    .about_timing = false,
    .same_in_sliding = ""};

}  // namespace contour::diagnosis::causes
