#include <cmath>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "analysis/diagnosis/causes/waves.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "encoder_subdivision";

constexpr WaveSource kWave = {.wave = Wave::kReadingOfAngle,
                              .has_order = [](double order) { return order != 1.0; },
                              .free_order = false};

// At this slope the reading stands still once a line.
constexpr double kMostSlope = 1.0;

bool RunsBackwards(const Problem& p, const Effect& e, const std::vector<double>& a) {
  return ReadsWithMoreSlope(p, e, a, kMostSlope);
}

constexpr ModelError kErrors[] = {{"amplitude_rad", 0.001}};

constexpr Specimen kSpecimen = {
    .needs = SpecimenNeeds{},
    .draw =
        [](const SpecimenMachine&, double, const UniformNumbers& uniform) {
          const double orders[] = {32.0, 64.0, 128.0, 256.0};
          return Drawn{.size = 1e-5, .order = orders[static_cast<std::size_t>(4.0 * uniform())]};
        },
    .effect =
        [](const Drawn& d, const SpecimenMachine&, const RecordedTime&) {
          return Assignments{SetEffect(
              kName, {{"amplitude_rad", d.size}, {"order_per_rev", d.order}, {"phase_rad", d.phase_rad}})};
        },
    .truth =
        [](const Drawn& d, const LogSpan&) {
          return NamedValues{{"amplitude_rad", std::abs(d.size)}, {"order_per_rev", d.order}};
        },
    .largest_size = kNoLargestSize,
    .size_at = SizeAsStated,
    .strength_in = StrengthIn::kTorque,
    .sizes = std::nullopt,
    .undecidable = nullptr};

}  // namespace

extern const CauseDefinition encoder_subdivision;
constexpr CauseDefinition encoder_subdivision = {
    .name = kName,
    .words = "the encoder interpolates unevenly inside each line",
    .advice = "Correct the angle with a table; clean or align the encoder.",
    .grid = nullptr,
    .wave = &kWave,
    .family = nullptr,
    .implausible = RunsBackwards,
    .parameters =
        [](const FittedEffect& fitted) {
          return WaveParameters(fitted, "amplitude_rad", "order_per_rev", fitted.signals().angle_per_q);
        },
    .main_parameter = "amplitude_rad",
    .model_errors = kErrors,
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
