#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/effect_parts.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "analysis/diagnosis/causes/extension_parts.h"
#include "config/extended_model.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "compliance";

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kUsualDamping = 0.04;
// Logarithm of how far a coupling's damping ratio may be from the usual one.
constexpr double kDampingReach = 2.0;
// Damped as no coupling is and with little behind it, or with next to nothing behind it, it stands for
// something else: logarithm of the damping ratio over the usual one, shares of the inertia.
constexpr double kMostDamped = 1.0, kLeastShare = 0.1, kNothingBehind = 0.01;

/// A resonance far from where it is stated cannot be reached step by step: full-size initial guesses in both
/// directions.
void GridOfAScrew(std::vector<SharedEffect>& out) {
  for (const double start : {-0.5, 0.4})
    out.push_back(
        Custom({std::string(kName), start < 0.0 ? "softer" : "stiffer", 8},
               {.steps = {5e-4, 5e-3}, .start = {start, 0.0}, .low = {-4.0, -3.0}, .high = {3.0, 4.0}},
               [](const auto& a, AxisModel& m) {
                 m.stiffness *= std::exp(a[0]);
                 m.damping *= std::exp(a[1]);
               }));
}

void AddCoupling(double frequency_Hz, const std::vector<double>& a, AxisModel& m) {
  if (a[0] <= 1e-6) return;
  const double all = m.motor_inertia, share = std::min(a[0], 0.95);
  m.two_inertia = true;
  m.load_inertia = share * all;
  m.motor_inertia = (1.0 - share) * all;
  const double w = kTwoPi * frequency_Hz * std::exp(a[1]);
  m.stiffness = m.load_inertia * w * w;
  m.damping = 2.0 * kUsualDamping * std::exp(a[2]) * w * m.load_inertia;
  m.friction_on_load = false;
}

/// The stiffest are those of any screw, no fault of a model that is stated as rigid: they join the
/// others so that these do not have to stand for them.
void GridOfARigidAxis(std::vector<SharedEffect>& out) {
  for (const double f :
       {15.0, 25.0, 40.0, 65.0, 100.0, 140.0, 180.0, 220.0, 270.0, 340.0, 430.0, 560.0, 750.0, 1000.0})
    out.push_back(WithOrder(Custom({std::string(kName), std::to_string(f) + " Hz", 14},
                                   {.steps = {0.02, 0.02, 0.1},
                                    .start = {0.3, 0.0, 0.0},
                                    .low = {0.0, -0.7, -kDampingReach},
                                    .high = {0.9, 0.7, kDampingReach}},
                                   [f](const auto& a, AxisModel& m) { AddCoupling(f, a, m); }),
                            f));
}

NamedValues Parameters(const FittedEffect& fitted) {
  const AxisModel m = fitted.problem.Build(fitted.point);
  return {{"antiresonance_Hz", std::sqrt(m.stiffness / std::max(m.load_inertia, 1e-30)) / kTwoPi},
          {"stiffness_Nm_rad", m.stiffness},
          {"damping_ratio", 0.5 * m.damping *
                                std::sqrt((1.0 / m.motor_inertia + 1.0 / std::max(m.load_inertia, 1e-30)) /
                                          std::max(m.stiffness, 1e-30))}};
}

bool NoCoupling(const Problem& p, const Effect&, const std::vector<double>& a) {
  if (p.nominal.two_inertia) return false;
  return (a[2] > kMostDamped && a[0] < kLeastShare) || a[0] < kNothingBehind;
}

constexpr ModelError kErrors[] = {{"antiresonance_Hz", 0.015}, {"stiffness_Nm_rad", 0.05}};

constexpr std::string_view kFrees[] = {"stiffness", "damping"};

void Extend(const Cause& cause, double, ExtensionsConfig& e) {
  if (!(ValueOf(cause, "stiffness_Nm_rad") > 0.0)) return;
  e.compliance = {ValueOf(cause, "antiresonance_Hz"), ValueOf(cause, "stiffness_Nm_rad"),
                  std::clamp(ValueOf(cause, "damping_ratio"), 0.0, 2.0)};
}

/// The screw itself: the emulated machine's own.
Assignments Simulation(const ModelConfig& stated, const ExtensionsConfig& all) {
  if (!all.compliance) return {};
  ModelConfig with = stated;
  with.extensions.compliance = all.compliance;
  const MechanicsConfig screw = Extended(with).mechanics;
  return {SetKey("screw_stiffness_N_um", screw.screw_stiffness_N_um),
          SetKey("screw_damping_Ns_m", screw.screw_damping_Ns_m)};
}

constexpr ExtensionRule kExtension = {.add = Extend,
                                      .remove = RemoveExtension<&ExtensionsConfig::compliance>,
                                      .number_of_the_model = true,
                                      .simulation = Simulation};

constexpr Specimen kSpecimen = {
    .needs = SpecimenNeeds{.rigid = true},
    .draw =
        [](const SpecimenMachine&, double, const UniformNumbers& uniform) {
          return Drawn{.size = 1.0 / 300.0, .second = Between(0.02, 0.05, uniform)};
        },
    .effect =
        [](const Drawn& d, const SpecimenMachine&, const RecordedTime&) {
          return Assignments{
              SetEffect(kName, {{"antiresonance_Hz", 1.0 / d.size}, {"damping_ratio", d.second}})};
        },
    .truth =
        [](const Drawn& d, const LogSpan&) {
          return NamedValues{{"antiresonance_Hz", 1.0 / d.size}};
        },
    .largest_size = 1.0 / 60.0,
    .size_at = [](double factor, double antiresonance_Hz) { return factor / antiresonance_Hz; },
    .strength_in = StrengthIn::kScaleWhereFitted,
    .sizes = std::nullopt,
    .undecidable = nullptr};

}  // namespace

extern const CauseDefinition compliance;
constexpr CauseDefinition compliance = {
    .name = kName,
    .words = "the axis is softer than the model says: a resonance between motor and table",
    .advice = "Take over stiffness and damping; check coupling, nut and bearing for play and preload.",
    .grid =
        [](const Problem& p, std::vector<SharedEffect>& out) {
          p.nominal.two_inertia ? GridOfAScrew(out) : GridOfARigidAxis(out);
        },
    .wave = nullptr,
    .family = nullptr,
    .implausible = NoCoupling,
    .parameters = Parameters,
    .main_parameter = "antiresonance_Hz",
    .model_errors = kErrors,
    .shape = nullptr,
    .largest = [](const Problem&) { return 1.5; },
    .freed_terms = kFrees,
    .extension = &kExtension,
    .experiment = ChirpWhileCreeping,
    .shows_more_of = std::nullopt,
    .specimen = &kSpecimen,
    .common_factor = false,
    .in_scatter_only = false,
    .coupling = true,
    .takes_up_mismatch = false,
    .refuted_by_mismatch = false,
    .acts_at_reversals = true,
    .judged_at_scale = false,
    .about_timing = false,
    .same_in_sliding = ""};

}  // namespace contour::diagnosis::causes
