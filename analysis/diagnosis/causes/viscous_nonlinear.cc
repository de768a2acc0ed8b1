#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/effect_parts.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "analysis/diagnosis/causes/extension_parts.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "viscous_nonlinear";

// As if so many places had been looked at.
constexpr double kKneeShows = 300.0;
// Power of the speed: bent as no drag is, it stands for what happens at the highest speed.
constexpr double kMostBent = 4.0;

bool IsKnee(const Effect& e) { return e.order > 0.0 && e.order <= 1.0; }

void Grid(const Problem& p, std::vector<SharedEffect>& out) {
  const Signals& s = *p.signals;
  const std::string kind(kName);
  const double top = std::max(s.max_speed, 1e-12), step = 0.02 * s.ForceScale();
  const auto speed = std::make_shared<const Signal>(s.velocity);
  const Input drag = p.nominal.friction_on_load ? Input::kLoadForce : Input::kMotorForce;
  for (const double power : {1.5, 2.0, 3.0})
    out.push_back(
        WithOrder(ShapedEffect(p, {kind, "power " + std::to_string(power), 3}, drag, step, {-0.45, 0.4},
                               [speed, top, power](std::size_t k, double x) {
                                 const double y = (*speed)[k] / top;
                                 return -std::copysign(std::pow(std::fabs(y), power * std::exp(x)), y);
                               }),
                  power));
  // Drag that yields beyond a knee; what grows faster than the speed bends with a power, and so does what
  // the log cannot tell from it: a knee must show for itself, since its torque is reported with another
  // linear term.
  for (const double knee : {0.1, 0.3}) {
    auto shape = std::make_shared<Effect>(
        *ShapedEffect(p, {kind, "knee " + std::to_string(knee), kKneeShows}, drag, step, {-1.0, 1.0},
                      [speed, top, knee](std::size_t k, double x) {
                        const double y = (*speed)[k] / top, bend = knee * std::exp(x);
                        return -y * (1.0 + bend) / (std::fabs(y) + bend);
                      }));
    shape->low[0] = 0.0;
    out.push_back(WithOrder(std::move(shape), knee));
  }
}

NamedValues Parameters(const FittedEffect& fitted) {
  const Effect& e = fitted.effect();
  const std::vector<double>& a = fitted.amplitudes();
  const double top = fitted.signals().max_speed;
  NamedValues v{{"torque_at_max_speed_Nm", a[0]}, {"max_speed_rad_s", top}};
  if (e.order > 1.0) v["exponent"] = e.order * std::exp(a[1]);
  if (IsKnee(e)) v["knee_rad_s"] = e.order * std::exp(a[1]) * top;
  return v;
}

constexpr ModelError kErrors[] = {{"torque_at_max_speed_Nm", 0.07}};

void Extend(const Cause& cause, double, ExtensionsConfig& e) {
  const ViscousCurve curve = {ValueOf(cause, "torque_at_max_speed_Nm"),
                              ValueOf(cause, "max_speed_rad_s", 1.0), ValueOf(cause, "exponent", 2.0),
                              ValueOf(cause, "knee_rad_s")};
  if (e.viscous_nonlinear)
    e.viscous_nonlinear->further.push_back(curve);
  else
    static_cast<ViscousCurve&>(e.viscous_nonlinear.emplace()) = curve;
}

double PowerInSimulation(const ViscousCurve& c) { return std::clamp(c.exponent, 1.0, 4.0); }

Assignments Simulation(const ModelConfig&, const ExtensionsConfig& all) {
  if (!all.viscous_nonlinear) return {};
  const ViscousNonlinearExtension& e = *all.viscous_nonlinear;
  std::vector<std::string> further;
  for (const ViscousCurve& c : e.further)
    further.push_back(MapText({{"torque_at_max_speed_Nm", c.torque_at_max_speed_Nm},
                               {"max_speed_rad_s", c.max_speed_rad_s},
                               {"exponent", PowerInSimulation(c)},
                               {"knee_rad_s", c.knee_rad_s}}));
  return {SetEffect(kName, {{"torque_at_max_speed_Nm", e.torque_at_max_speed_Nm},
                            {"max_speed_rad_s", e.max_speed_rad_s},
                            {"exponent", PowerInSimulation(e)},
                            {"knee_rad_s", e.knee_rad_s},
                            {"further", further}})};
}

constexpr ExtensionRule kExtension = {.add = Extend,
                                      .remove = RemoveExtension<&ExtensionsConfig::viscous_nonlinear>,
                                      .number_of_the_model = false,
                                      .simulation = Simulation};

constexpr Specimen kSpecimen = {
    .needs = SpecimenNeeds{},
    .draw =
        [](const SpecimenMachine& m, double sign, const UniformNumbers& uniform) {
          return Drawn{.size = sign * 0.1 * m.friction_Nm, .order = Between(1.7, 2.3, uniform)};
        },
    .effect =
        [](const Drawn& d, const SpecimenMachine& m, const RecordedTime&) {
          return Assignments{SetEffect(kName, {{"torque_at_max_speed_Nm", d.size},
                                               {"max_speed_rad_s", m.speed_limit_rad_s},
                                               {"exponent", d.order}})};
        },
    .truth =
        [](const Drawn& d, const LogSpan& span) {
          return NamedValues{{"torque_at_max_speed_Nm",
                              d.size * std::pow(span.largest_speed_rad_s / span.speed_limit_rad_s, d.order)}};
        },
    .largest_size = kNoLargestSize,
    .size_at = SizeAsStated,
    .strength_in = StrengthIn::kTorque,
    .sizes = std::nullopt,
    .undecidable = nullptr};

}  // namespace

extern const CauseDefinition viscous_nonlinear;
constexpr CauseDefinition viscous_nonlinear = {
    .name = kName,
    .words = "viscous friction is not proportional to speed",
    .advice = "Take over the curve; at high speed expect less or more torque than the model says.",
    .grid = Grid,
    .wave = nullptr,
    .family = [](const Effect& e) -> std::string_view { return e.order < 1.0 ? " with a knee" : ""; },
    .implausible = [](const Problem&, const Effect& e,
                      const std::vector<double>& a) { return e.order * std::exp(a[1]) > kMostBent; },
    .parameters = Parameters,
    .main_parameter = "torque_at_max_speed_Nm",
    .model_errors = kErrors,
    .shape = nullptr,
    .largest = [](const Problem& p) { return 1.5 * p.signals->ForceScale(); },
    .freed_terms = kFreesNothing,
    .extension = &kExtension,
    .experiment = FiveSpeedsAndPulses,
    .shows_more_of = Quantity::kSpeed,
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
