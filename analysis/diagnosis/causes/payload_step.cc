#include <cmath>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/effect_parts.h"
#include "analysis/diagnosis/causes/experiments.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "payload_step";

void Grid(const Problem& p, std::vector<SharedEffect>& out) {
  const std::size_t n = p.rows();
  const double J = p.nominal.motor_inertia + p.nominal.load_inertia;
  for (int i = 1; i < 20; ++i) {
    const std::size_t row = n * static_cast<std::size_t>(i) / 20;
    // The instant moves with the rest, by rows, as far as the next one of the grid.
    const double reach_s = p.log.period_s * (static_cast<double>(n) / 20.0 - 1.0), period_s = p.log.period_s;
    auto step = std::make_shared<Effect>(*Custom(
        {std::string(kName), "row " + std::to_string(row), 20},
        {.steps = {2e-3, 0.05}, .low = {-0.8, -reach_s}, .high = {5.0, reach_s}},
        [J, row, period_s](const auto& a, AxisModel& m) {
          m.payload = a[0] * J;
          m.payload_row = static_cast<std::size_t>(static_cast<double>(row) + std::round(a[1] / period_s));
        }));
    step->tested = 1;
    step->force = {1, 0};
    step->as_term = p.nominal.two_inertia ? "load_inertia" : "inertia";
    step->from_row = row;
    step->order = p.log.period_s * static_cast<double>(row);
    out.push_back(step);
  }
}

/// The amplitude is a share of the stated inertia; what is told is one of the fitted.
NamedValues Parameters(const FittedEffect& fitted) {
  const AxisModel m = fitted.problem.Build(fitted.point);
  const AxisModel& stated = fitted.problem.nominal;
  const std::vector<double>& a = fitted.amplitudes();
  const double all = m.motor_inertia + (m.two_inertia ? m.load_inertia : 0.0);
  return {{"inertia_change_rel", a[0] * (stated.motor_inertia + stated.load_inertia) / all},
          {"time_s", fitted.effect().order + a[1]}};
}

constexpr ModelError kErrors[] = {{"inertia_change_rel", 0.01}};

constexpr Specimen kSpecimen = {
    .needs = SpecimenNeeds{},
    .draw =
        [](const SpecimenMachine&, double sign, const UniformNumbers& uniform) {
          return Drawn{.size = sign * 0.05, .second = Between(0.35, 0.65, uniform)};
        },
    .effect =
        [](const Drawn& d, const SpecimenMachine&, const RecordedTime& time) {
          return Assignments{SetEffect(kName, {{"inertia_change_rel", d.size},
                                               {"time_s", time.begin_s + d.second * time.duration_s}})};
        },
    .truth =
        [](const Drawn& d, const LogSpan&) {
          return NamedValues{{"inertia_change_rel", d.size}};
        },
    .largest_size = 0.3,
    .size_at = SizeAsStated,
    .strength_in = StrengthIn::kTorque,
    .sizes = std::nullopt,
    .undecidable = nullptr};

}  // namespace

extern const CauseDefinition payload_step;
constexpr CauseDefinition payload_step = {
    .name = kName,
    .words = "the moving mass changed during the log",
    .advice = "Identify with one payload; tell the controller when the payload changes.",
    .grid = Grid,
    .wave = nullptr,
    .family = nullptr,
    .implausible = AtItsBound,
    .parameters = Parameters,
    .main_parameter = "inertia_change_rel",
    .model_errors = kErrors,
    .shape = nullptr,
    .largest = [](const Problem&) { return 1.0; },
    .freed_terms = kFreesNothing,
    .extension = nullptr,
    .experiment = SameStrokesWarmAndCold,
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
