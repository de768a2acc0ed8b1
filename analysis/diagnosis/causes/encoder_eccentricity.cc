#include <cmath>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "analysis/diagnosis/causes/waves.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "encoder_eccentricity";

constexpr WaveSource kWave = {.wave = Wave::kReadingOfAngle,
                              .has_order = [](double order) { return order == 1.0; },
                              .free_order = false};

// A disc whose centre is off by a tenth of its radius.
constexpr double kMostSlope = 0.1;

bool OffTheDisc(const Problem& p, const Effect& e, const std::vector<double>& a) {
  return ReadsWithMoreSlope(p, e, a, kMostSlope);
}

constexpr Specimen kSpecimen = {
    .needs = SpecimenNeeds{},
    .draw = [](const SpecimenMachine&, double, const UniformNumbers&) { return Drawn{.size = 1e-3}; },
    .effect =
        [](const Drawn& d, const SpecimenMachine&, const RecordedTime&) {
          return Assignments{SetEffect(kName, {{"amplitude_rad", d.size}, {"phase_rad", d.phase_rad}})};
        },
    .truth =
        [](const Drawn& d, const LogSpan&) {
          return NamedValues{{"amplitude_rad", std::abs(d.size)}};
        },
    .largest_size = 0.05,
    .size_at = SizeAsStated,
    .strength_in = StrengthIn::kTorque,
    .sizes = std::nullopt,
    .undecidable = nullptr};

}  // namespace

extern const CauseDefinition encoder_eccentricity;
constexpr CauseDefinition encoder_eccentricity = {
    .name = kName,
    .words = "the encoder's disc is off centre: one wave of angle error per turn",
    .advice = "Correct the angle with a table; have the encoder remounted.",
    .grid = [](const Problem& p,
               std::vector<SharedEffect>& out) { out.push_back(WaveEffect(p, *kWave.wave, 1.0, 1.0)); },
    .wave = &kWave,
    .family = nullptr,
    .implausible = OffTheDisc,
    .parameters =
        [](const FittedEffect& fitted) {
          return WaveParameters(fitted, "amplitude_rad", nullptr, fitted.signals().angle_per_q);
        },
    .main_parameter = "amplitude_rad",
    .model_errors = kNoModelErrors,
    .shape = nullptr,
    .largest = [](const Problem& p) { return 0.02 / p.signals->angle_per_q; },
    .freed_terms = kFreesNothing,
    .extension = nullptr,
    .experiment = SameStretchAtThreeSpeeds,
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
