#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/effect_parts.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "analysis/diagnosis/causes/extension_parts.h"
#include "analysis/diagnosis/causes/stroke_shapes.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "cable_spring";

void Grid(const Problem& p, std::vector<SharedEffect>& out) {
  const Signals& s = *p.signals;
  const std::string kind(kName);
  const double step = 0.01 * s.ForceScale();
  out.push_back(
      WithShorter(LinearEffect({kind, "", 3}, Input::kLoadForce, LegendrePolynomials(s, 4), step),
                  LinearEffect({kind, "linear", 3}, Input::kLoadForce, LegendrePolynomials(s, 1), step)));
}

NamedValues Parameters(const FittedEffect& fitted) {
  const StatedAxis& axis = fitted.problem.stated;
  const double half = fitted.signals().half_stroke_m;
  const Signal ends = OverStroke(fitted.signals(), fitted.amplitudes(), LegendreAt, {-half, half});
  const double stated = 0.5 * (axis.stroke_max_m - axis.stroke_min_m);
  return {{"torque_at_stroke_end_Nm", 0.5 * (ends[0] - ends[1]) * (stated > half ? stated / half : 1.0)}};
}

constexpr StrokeShape kShape = {.ordinate = "torque_Nm", .per_unit = 1.0, .basis = LegendreAt};

void Extend(const Cause& cause, double, ExtensionsConfig& e) {
  const ShapeTable* shape = TableOverStroke(cause);
  if (shape == nullptr) return;
  CableSpringExtension& table = Existing(e.cable_spring);
  AddTable(*shape, Joined::kSum, table.position_mm, table.torque_Nm);
  table.torque_at_stroke_end_Nm += ValueOf(cause, "torque_at_stroke_end_Nm");
}

constexpr ExtensionRule kExtension = {.add = Extend,
                                      .remove = RemoveExtension<&ExtensionsConfig::cable_spring>,
                                      .number_of_the_model = false,
                                      .simulation = nullptr};

constexpr Specimen kSpecimen = {
    .needs = SpecimenNeeds{},
    .draw = [](const SpecimenMachine& m, double,
               const UniformNumbers&) { return Drawn{.size = 0.1 * m.friction_Nm}; },
    .effect =
        [](const Drawn& d, const SpecimenMachine&, const RecordedTime&) {
          return Assignments{SetEffect(kName, {{"torque_at_stroke_end_Nm", d.size}})};
        },
    .truth =
        [](const Drawn& d, const LogSpan&) {
          return NamedValues{{"torque_at_stroke_end_Nm", d.size}};
        },
    .largest_size = kNoLargestSize,
    .size_at = SizeAsStated,
    .strength_in = StrengthIn::kTorque,
    .sizes = std::nullopt,
    .undecidable = nullptr};

}  // namespace

extern const CauseDefinition cable_spring;
constexpr CauseDefinition cable_spring = {
    .name = kName,
    .words = "a force that depends on the position, the same in both directions: a cable, hose or cover",
    .advice = "Feed the force forward; check the routing of cables and hoses and the bellows.",
    .grid = Grid,
    .wave = nullptr,
    .family = nullptr,
    .implausible = nullptr,
    .parameters = Parameters,
    .main_parameter = "torque_at_stroke_end_Nm",
    .model_errors = kNoModelErrors,
    .shape = &kShape,
    .largest = [](const Problem& p) { return 1.5 * p.signals->ForceScale(); },
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
    .judged_at_scale = false,
    .about_timing = false,
    .same_in_sliding = ""};

}  // namespace contour::diagnosis::causes
