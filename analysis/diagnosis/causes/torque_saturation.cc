#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/effect_parts.h"
#include "analysis/diagnosis/causes/experiments.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "torque_saturation";

/// Where the loss is told: rated torque, or the largest that the log asks for where none is stated.
double ToldAt(const Problem& p) {
  if (p.stated.rated > 0.0) return p.stated.rated;
  double largest = 0.0;
  for (const double u : p.log.command) largest = std::max(largest, std::fabs(u));
  return largest;
}

/// A torque that grows faster than the current, as no motor's does.
bool GrowsWithCurrent(const Problem& p, const Effect& /*effect*/, const std::vector<double>& a) {
  const double rated = ToldAt(p);
  return p.nominal.saturation * rated * rated + a[0] < 0.0;
}

constexpr ModelError kErrors[] = {{"loss_at_rated_rel", 0.01}};

constexpr Specimen kSpecimen = {
    .needs = SpecimenNeeds{},
    .draw = [](const SpecimenMachine&, double, const UniformNumbers&) { return Drawn{.size = 0.02}; },
    .effect =
        [](const Drawn& d, const SpecimenMachine&, const RecordedTime&) {
          return Assignments{SetEffect(kName, {{"loss_at_rated_rel", d.size}})};
        },
    .truth =
        [](const Drawn& d, const LogSpan&) {
          return NamedValues{{"loss_at_rated_rel", d.size}};
        },
    .largest_size = 0.3,
    .size_at = SizeAsStated,
    .strength_in = StrengthIn::kTorque,
    .sizes = std::nullopt,
    .undecidable = nullptr};

}  // namespace

extern const CauseDefinition torque_saturation;
constexpr CauseDefinition torque_saturation = {
    .name = kName,
    .words = "torque falls short at high current",
    .advice = "Lower the torque limit or the accelerations, or state the saturation.",
    .grid =
        [](const Problem& p, std::vector<SharedEffect>& out) {
          const double rated = ToldAt(p);
          if (!(rated > 0.0)) return;
          out.push_back(WithForce(
              Custom({std::string(kName), "", 1}, {.steps = {5e-3}, .low = {-0.3}, .high = {0.5}},
                     [rated](const auto& a, AxisModel& m) { m.saturation += a[0] / (rated * rated); }),
              {1}));
        },
    .wave = nullptr,
    .family = nullptr,
    .implausible = GrowsWithCurrent,
    .parameters =
        [](const FittedEffect& fitted) {
          return NamedValues{{"loss_at_rated_rel", fitted.amplitudes()[0]}};
        },
    .main_parameter = "loss_at_rated_rel",
    .model_errors = kErrors,
    .shape = nullptr,
    .largest = [](const Problem&) { return 0.3; },
    .freed_terms = kFreesNothing,
    .extension = nullptr,
    .experiment = FiveSpeedsAndPulses,
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
