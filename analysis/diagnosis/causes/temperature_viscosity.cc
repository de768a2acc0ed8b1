#include <algorithm>
#include <cmath>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/effect_parts.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "analysis/diagnosis/causes/extension_parts.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "temperature_viscosity";

constexpr double kLeastWarming_K = 0.1;

/// A thermometer that stands still, to its own resolution, tells nothing.
bool Varies(const Signal& temperature_K) {
  if (temperature_K.empty()) return false;
  const auto [low, high] = std::minmax_element(temperature_K.begin(), temperature_K.end());
  return *high - *low > kLeastWarming_K;
}

void Grid(const Problem& p, std::vector<SharedEffect>& out) {
  if (!Varies(p.signals->temperature_K)) return;
  const std::string kind(kName);
  const auto T = std::make_shared<const Signal>(p.signals->temperature_K);
  out.push_back(WithShorter(AsSignals(Custom({kind, "and level", 2}, {.steps = {2e-3, 1e-3}},
                                             [T](const auto& a, AxisModel& m) {
                                               m.viscous = Add(m.viscous, {T}, {a[0]});
                                               Enter(m, Input::kLevel, {T}, {a[1]});
                                             })),
                            LinearEffect({kind, "", 2}, Input::kViscous, {T}, 2e-3)));
}

/// The model's coefficient is that of the mean temperature, the rate is stated of the first.
NamedValues Parameters(const FittedEffect& fitted) {
  const double rate = fitted.amplitudes()[0];
  return {{"rate_1_K", rate / std::max(0.05, 1.0 + rate * fitted.signals().temperature_K.front())}};
}

constexpr ModelError kErrors[] = {{"rate_1_K", 0.03}};

/// Both rates about one temperature: r (T - T0) = r1 (T - T1) + r2 (T - T2).
void Extend(const Cause& cause, double first_temperature_degC, ExtensionsConfig& e) {
  const double rate_1_K = ValueOf(cause, "rate_1_K");
  auto& to = e.temperature_viscosity;
  if (!to) to = TemperatureViscosityExtension{0.0, first_temperature_degC};
  const double sum_1_K = to->rate_1_K + rate_1_K;
  if (std::abs(sum_1_K) > 1e-6)
    to->reference_degC = std::clamp(
        (to->rate_1_K * to->reference_degC + rate_1_K * first_temperature_degC) / sum_1_K, -50.0, 150.0);
  to->rate_1_K = sum_1_K;
}

Assignments Simulation(const ModelConfig&, const ExtensionsConfig& all) {
  if (!all.temperature_viscosity) return {};
  return {SetEffect(kName, {{"rate_1_K", all.temperature_viscosity->rate_1_K}}),
          SetKey("temperature.reference_degC", all.temperature_viscosity->reference_degC)};
}

constexpr ExtensionRule kExtension = {.add = Extend,
                                      .remove = RemoveExtension<&ExtensionsConfig::temperature_viscosity>,
                                      .number_of_the_model = false,
                                      .simulation = Simulation};

constexpr Specimen kSpecimen = {
    .needs = SpecimenNeeds{.temperature = true},
    .draw = [](const SpecimenMachine&, double, const UniformNumbers&) { return Drawn{.size = -0.01}; },
    .effect =
        [](const Drawn& d, const SpecimenMachine&, const RecordedTime&) {
          return Assignments{SetEffect(kName, {{"rate_1_K", d.size}})};
        },
    .truth =
        [](const Drawn& d, const LogSpan&) {
          return NamedValues{{"rate_1_K", d.size}};
        },
    .largest_size = 0.09,
    .size_at = SizeAsStated,
    .strength_in = StrengthIn::kTorque,
    .sizes = std::nullopt,
    .undecidable = nullptr};

}  // namespace

extern const CauseDefinition temperature_viscosity;
constexpr CauseDefinition temperature_viscosity = {
    .name = kName,
    .words = "viscous friction changes with temperature",
    .advice = "Let the model use the temperature; warm the axis up before precise work.",
    .grid = Grid,
    .wave = nullptr,
    .family = nullptr,
    .implausible = nullptr,
    .parameters = Parameters,
    .main_parameter = "rate_1_K",
    .model_errors = kErrors,
    .shape = nullptr,
    .largest = [](const Problem&) { return 0.15; },
    .freed_terms = kFreesNothing,
    .extension = &kExtension,
    .experiment = SameStrokesWarmAndCold,
    .shows_more_of = Quantity::kTemperature,
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
