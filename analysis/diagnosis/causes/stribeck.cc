#include <algorithm>
#include <cmath>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/effect_parts.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "analysis/diagnosis/causes/extension_parts.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "stribeck";

void Grid(const Problem& p, std::vector<SharedEffect>& out) {
  const std::string kind(kName);
  if (p.nominal.friction.BreaksAwayHigher()) {
    out.push_back(Custom({kind, "", 1}, {.steps = {2e-3, 5e-3}, .low = {-0.4, -1.5}, .high = {1.0, 1.5}},
                         [](const auto& a, AxisModel& m) {
                           m.friction.Fs_plus *= std::exp(a[0]);
                           m.friction.Fs_minus *= std::exp(a[0]);
                           m.friction.vs *= std::exp(a[1]);
                         }));
    return;
  }
  for (const double part : {0.003, 0.012, 0.05}) {
    const double vs = part * p.signals->max_speed;
    out.push_back(
        Custom({kind, "vs " + std::to_string(vs), 3},
               {.steps = {5e-3, 1e-2}, .start = {0.1, 0.0}, .low = {-0.8, -2.5}, .high = {4.0, 2.5}},
               [vs](const auto& a, AxisModel& m) {
                 m.friction.Fs_plus = m.friction.Fc_plus * (1.0 + a[0]);
                 m.friction.Fs_minus = m.friction.Fc_minus * (1.0 + a[0]);
                 m.friction.vs = vs * std::exp(a[1]);
               }));
  }
}

NamedValues Parameters(const FittedEffect& fitted) {
  const AxisModel m = fitted.problem.Build(fitted.point);
  return {{"Fs_over_Fc", m.friction.Fs_plus / m.friction.Fc_plus}, {"vs_rad_s", m.friction.vs}};
}

/// The ratio itself, or how far it lies above one.
double SizeAt(double factor, double ratio) { return factor * (ratio > 1.0 ? ratio - 1.0 : ratio); }

constexpr ModelError kErrors[] = {{"Fs_over_Fc", 0.01}, {"vs_rad_s", 0.1}};

constexpr std::string_view kFrees[] = {"Fs", "vs"};

constexpr ExtensionRule kExtension = {
    .add =
        [](const Cause& cause, double, ExtensionsConfig& e) {
          e.stribeck = {std::max(1.0, ValueOf(cause, "Fs_over_Fc", 1.0)), ValueOf(cause, "vs_rad_s", 1.0)};
        },
    .remove = RemoveExtension<&ExtensionsConfig::stribeck>,
    .number_of_the_model = true,
    .simulation = [](const ModelConfig&, const ExtensionsConfig& all) -> Assignments {
      if (!all.stribeck) return {};
      return {
          SetEffect(kName, {{"Fs_over_Fc", all.stribeck->Fs_over_Fc}, {"vs_rad_s", all.stribeck->vs_rad_s}})};
    }};

constexpr Specimen kSpecimen = {
    .needs = SpecimenNeeds{.no_stribeck = true},
    .draw = [](const SpecimenMachine& m, double,
               const UniformNumbers&) { return Drawn{.size = 0.2, .second = m.vs_rad_s}; },
    .effect =
        [](const Drawn& d, const SpecimenMachine&, const RecordedTime&) {
          return Assignments{SetEffect(kName, {{"Fs_over_Fc", 1.0 + d.size}, {"vs_rad_s", d.second}})};
        },
    .truth =
        [](const Drawn& d, const LogSpan&) {
          return NamedValues{{"Fs_over_Fc", 1.0 + d.size}, {"vs_rad_s", d.second}};
        },
    .largest_size = 2.0,
    .size_at = SizeAt,
    .strength_in = StrengthIn::kTorque,
    .sizes = std::nullopt,
    .undecidable = nullptr};

}  // namespace

extern const CauseDefinition stribeck;
constexpr CauseDefinition stribeck = {
    .name = kName,
    .words = "friction rises more, or at another speed, towards standstill than the model says",
    .advice = "Take over break-away level and Stribeck velocity; check the lubrication.",
    .grid = Grid,
    .wave = nullptr,
    .family = nullptr,
    .implausible = nullptr,
    .parameters = Parameters,
    .main_parameter = "Fs_over_Fc",
    .model_errors = kErrors,
    .shape = nullptr,
    .largest = [](const Problem&) { return 1.5; },
    .freed_terms = kFrees,
    .extension = &kExtension,
    .experiment = GrowingReversalsOrNone,
    .shows_more_of = Quantity::kTravelSinceReversal,
    .specimen = &kSpecimen,
    .common_factor = false,
    .in_scatter_only = false,
    .coupling = false,
    .takes_up_mismatch = false,
    .refuted_by_mismatch = true,
    .acts_at_reversals = false,
    .judged_at_scale = false,
    .about_timing = false,
    .same_in_sliding = ""};

}  // namespace contour::diagnosis::causes
