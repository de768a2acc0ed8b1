#include <cmath>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/effect_parts.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "analysis/diagnosis/causes/extension_parts.h"
#include "analysis/diagnosis/causes/stroke_shapes.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "pitch_error";

void Grid(const Problem& p, std::vector<SharedEffect>& out) {
  if (p.has_scale())
    out.push_back(LinearEffect({std::string(kName), "", 1}, Input::kScale, Cosines(*p.signals, 1, 8), 1e-7));
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
constexpr CauseDefinition pitch_error = {.name = kName,
                                         .words = "the screw's lead is not the same everywhere",
                                         .advice = "Use the table of pitch errors to correct positions.",
                                         .grid = Grid,
                                         .wave = nullptr,
                                         .family = nullptr,
                                         .implausible = nullptr,
                                         .parameters =
                                             [](const FittedEffect& fitted) {
                                               return NamedValues{{"amplitude_um", 1e6 * HalfRange(fitted)}};
                                             },
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
                                         .about_timing = false};

}  // namespace contour::diagnosis::causes
