#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/effect_parts.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "analysis/diagnosis/causes/extension_parts.h"
#include "analysis/diagnosis/causes/stroke_shapes.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "pitch_error";

constexpr double kStep_m = 1e-7;
constexpr double kTurn = 2.0 * std::numbers::pi;

/// Along the stroke; and within each turn of the screw, once and twice.
void Grid(const Problem& p, std::vector<SharedEffect>& out) {
  if (!p.has_scale()) return;
  const Signals& s = *p.signals;
  out.push_back(LinearEffect({std::string(kName), "", 1}, Input::kScale, Cosines(s, 1, 8), kStep_m));
  const auto [low, high] = std::minmax_element(s.angle_rad.begin(), s.angle_rad.end());
  if (*high - *low < kTurn) return;
  std::vector<SharedSignal> turn;
  for (const double order : {1.0, 2.0}) {
    turn.push_back(Make(p.rows(), [&](std::size_t k) { return std::sin(order * s.angle_rad[k]); }));
    turn.push_back(Make(p.rows(), [&](std::size_t k) { return std::cos(order * s.angle_rad[k]); }));
  }
  out.push_back(
      WithOrder(LinearEffect({std::string(kName), "per turn", 1}, Input::kScale, turn, kStep_m), 1.0));
}

bool PerTurn(const Effect& e) { return e.order > 0.0; }

/// Half of highest minus lowest within a turn, and both of its waves.
NamedValues WithinATurn(const std::vector<double>& a) {
  constexpr int kPlaces = 360;
  double low = 0.0, high = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    const double x = kTurn * i / kPlaces;
    const double y =
        a[0] * std::sin(x) + a[1] * std::cos(x) + a[2] * std::sin(2.0 * x) + a[3] * std::cos(2.0 * x);
    low = std::min(low, y);
    high = std::max(high, y);
  }
  return {{"amplitude_um", 0.5e6 * (high - low)},
          {"amplitude_once_per_turn_um", 1e6 * std::hypot(a[0], a[1])},
          {"amplitude_twice_per_turn_um", 1e6 * std::hypot(a[2], a[3])}};
}

NamedValues Parameters(const FittedEffect& fitted) {
  if (PerTurn(fitted.effect())) return WithinATurn(fitted.amplitudes());
  return {{"amplitude_um", 1e6 * HalfRange(fitted)}};
}

constexpr StrokeShape kShape = {.ordinate = "error_um", .per_unit = 1e6, .basis = CosineAt};

// Less than this, a scale of a micrometre cannot tell.
constexpr double kUndecidable_um = 0.1;

void Extend(const Cause& cause, double, ExtensionsConfig& e) {
  const ShapeTable* shape = TableOverStroke(cause);
  if (shape == nullptr) return;
  PitchErrorExtension& table = Existing(e.pitch_error);
  AddTable(*shape, Joined::kSum, table.position_mm, table.error_um);
  table.amplitude_um = HalfRange(table.error_um);
}

constexpr ExtensionRule kExtension = {
    .add = Extend,
    .remove = RemoveExtension<&ExtensionsConfig::pitch_error>,
    .number_of_the_model = false,
    .simulation = [](const ModelConfig&, const ExtensionsConfig& all) -> Assignments {
      if (!all.pitch_error) return {};
      return {SetEffect("pitch_map", {{"position_mm", all.pitch_error->position_mm},
                                      {"error_um", all.pitch_error->error_um}})};
    }};

constexpr Specimen kSpecimen = {
    .needs = SpecimenNeeds{.scale = true},
    .draw =
        [](const SpecimenMachine& m, double, const UniformNumbers& uniform) {
          return Drawn{.size = 1.0, .order = WholePeriods(m, uniform)};
        },
    .effect =
        [](const Drawn& d, const SpecimenMachine&, const RecordedTime&) {
          return Assignments{SetEffect(
              kName,
              {{"amplitude_um", d.size}, {"periods_per_stroke", d.order}, {"phase_rad", d.phase_rad}})};
        },
    .truth =
        [](const Drawn& d, const LogSpan&) {
          return NamedValues{{"amplitude_um", std::abs(d.size)}};
        },
    .largest_size = kNoLargestSize,
    .size_at = SizeAsStated,
    .strength_in = StrengthIn::kScale,
    .sizes = std::nullopt,
    .undecidable = [](const Drawn& d, bool) { return std::abs(d.size) <= kUndecidable_um; }};

}  // namespace

extern const CauseDefinition pitch_error;
constexpr CauseDefinition pitch_error = {
    .name = kName,
    .words = "the screw's lead is not the same everywhere",
    .advice = "Use the table of pitch errors to correct positions.",
    .grid = Grid,
    .wave = nullptr,
    .family = [](const Effect& e) -> std::string_view { return PerTurn(e) ? " per turn" : ""; },
    .implausible = nullptr,
    .parameters = Parameters,
    .main_parameter = "amplitude_um",
    .model_errors = kNoModelErrors,
    .shape = &kShape,
    .largest = [](const Problem&) { return 1e-3; },
    .freed_terms = kFreesNothing,
    .extension = &kExtension,
    .experiment = FullStrokes,
    .shows_more_of = std::nullopt,
    .specimen = &kSpecimen,
    .common_factor = false,
    .in_scatter_only = false,
    .coupling = false,
    .takes_up_mismatch = false,
    .refuted_by_mismatch = false,
    .acts_at_reversals = false,
    .judged_at_scale = true,
    .about_timing = false,
    .same_in_sliding = ""};

}  // namespace contour::diagnosis::causes
