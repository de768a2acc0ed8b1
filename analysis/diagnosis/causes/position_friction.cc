#include <cmath>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/effect_parts.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "analysis/diagnosis/causes/extension_parts.h"
#include "analysis/diagnosis/causes/stroke_shapes.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "position_friction";

void Grid(const Problem& p, std::vector<SharedEffect>& out) {
  const Signals& s = *p.signals;
  const std::string kind(kName);
  out.push_back(WithShorter(LinearEffect({kind, "", 3}, Input::kLevel, Cosines(s, 1, 8), 5e-3),
                            LinearEffect({kind, "smooth", 3}, Input::kLevel, Cosines(s, 1, 3), 5e-3)));
}

constexpr StrokeShape kShape = {.ordinate = "friction_rel", .per_unit = 1.0, .basis = CosineAt};

constexpr ModelError kErrors[] = {{"amplitude_rel", 0.04}};

void Extend(const Cause& cause, double, ExtensionsConfig& e) {
  const ShapeTable* shape = TableOverStroke(cause);
  if (shape == nullptr) return;
  PositionFrictionExtension& table = Existing(e.position_friction);
  AddTable(*shape, Joined::kFactors, table.position_mm, table.friction_rel);
  table.amplitude_rel = HalfRange(table.friction_rel);
}

constexpr ExtensionRule kExtension = {
    .add = Extend,
    .remove = RemoveExtension<&ExtensionsConfig::position_friction>,
    .number_of_the_model = false,
    .simulation = [](const ModelConfig&, const ExtensionsConfig& all) -> Assignments {
      if (!all.position_friction) return {};
      return {SetEffect("friction_map", {{"position_mm", all.position_friction->position_mm},
                                         {"friction_rel", all.position_friction->friction_rel}})};
    }};

constexpr Specimen kSpecimen = {.needs = SpecimenNeeds{},
                                .draw =
                                    [](const SpecimenMachine& m, double, const UniformNumbers& uniform) {
                                      return Drawn{.size = 0.1, .order = WholePeriods(m, uniform)};
                                    },
                                .effect =
                                    [](const Drawn& d, const SpecimenMachine&, const RecordedTime&) {
                                      return Assignments{SetEffect(kName, {{"amplitude_rel", d.size},
                                                                           {"periods_per_stroke", d.order},
                                                                           {"phase_rad", d.phase_rad}})};
                                    },
                                .truth =
                                    [](const Drawn& d, const LogSpan&) {
                                      return NamedValues{{"amplitude_rel", std::abs(d.size)}};
                                    },
                                .largest_size = 0.8,
                                .size_at = SizeAsStated,
                                .strength_in = StrengthIn::kTorque,
                                .sizes = std::nullopt,
                                .undecidable = nullptr};

}  // namespace

extern const CauseDefinition position_friction;
constexpr CauseDefinition position_friction = {.name = kName,
                                               .words = "friction changes along the stroke",
                                               .advice =
                                                   "Feed the friction map forward; look for a bent screw, "
                                                   "misaligned guides or uneven preload where it is high.",
                                               .grid = Grid,
                                               .wave = nullptr,
                                               .family = nullptr,
                                               .implausible = nullptr,
                                               .parameters =
                                                   [](const FittedEffect& fitted) {
                                                     return NamedValues{{"amplitude_rel", HalfRange(fitted)}};
                                                   },
                                               .main_parameter = "amplitude_rel",
                                               .model_errors = kErrors,
                                               .shape = &kShape,
                                               .largest = [](const Problem&) { return 0.7; },
                                               .freed_terms = kFreesNothing,
                                               .extension = &kExtension,
                                               .experiment = FullStrokes,
                                               .shows_more_of = Quantity::kPosition,
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
