#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/effect_parts.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "analysis/diagnosis/tuning/prediction_tuning.h"
#include "analysis/prediction_error/forward_filter.h"
#include "analysis/prediction_error/signals.h"
#include "analysis/prediction_error/simd/lanes.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "torque_saturation";

double LargestAsked(const Problem& p) {
  double largest = 0.0;
  for (const double u : p.log.command) largest = std::max(largest, std::fabs(u));
  return largest;
}

/// Where the loss is told: rated torque, or the largest that the log asks for where none is stated.
double ToldAt(const Problem& p) { return p.stated.rated > 0.0 ? p.stated.rated : LargestAsked(p); }

constexpr std::string_view kLimit = "limit";

/// A limit is far from linear: none of what lies below it says anything of it.
bool IsLimit(const Effect& effect) { return !effect.start.empty(); }

/// The median.
double UsuallyAsked(const Problem& p) {
  std::vector<double> asked;
  for (const double u : p.log.command) asked.push_back(std::fabs(u));
  if (asked.empty()) return 0.0;
  const auto middle = asked.begin() + static_cast<std::ptrdiff_t>(asked.size() / 2);
  std::nth_element(asked.begin(), middle, asked.end());
  return *middle;
}

/// Levels between what is usually asked and the largest.
constexpr int kLevels = 2 * kLanes;

/// By how much the torque that the motion needs differs from what is asked, each smoothed alike, if no more
/// than a limit were given.
double Misfit(const Problem& p, double limit) {
  const double sigma = kRows.kinematic_smoothing_s / p.log.period_s;
  Signal given = p.log.command;
  for (double& u : given) u = std::clamp(u, -limit, limit);
  given = Smooth(given, std::hypot(sigma, std::max(1.0, kRows.acceleration_smoothing_share * sigma)));
  double squares = 0.0;
  for (std::size_t k = 0; k < given.size(); ++k)
    if (p.setup.valid[k] != 0) squares += std::pow(given[k] - p.signals->model_torque[k], 2);
  return squares;
}

/// Of levels from the lower on, each larger by a factor, the one above that of the least misfit: one that is
/// too low takes away what was given, in rows that count in full. None where none is below `least`.
std::optional<double> AboveBest(const Problem& p, double lower, double factor, double& least) {
  std::optional<double> found;
  double level = lower;
  for (int i = 0; i < kLevels; ++i, level *= factor) {
    const double misfit = Misfit(p, level);
    if (!(misfit < least)) continue;
    least = misfit;
    found = level * factor;
  }
  return found;
}

/// The limit that the motion has most likely had; none where it needed what was asked.
std::optional<double> LimitOf(const Problem& p) {
  const double largest = LargestAsked(p), usual = UsuallyAsked(p);
  if (!(usual > 0.0) || p.signals->model_torque.size() != p.rows()) return std::nullopt;
  double least = Misfit(p, largest);
  const double factor = std::pow(largest / usual, 1.0 / kLevels);
  const std::optional<double> coarse = AboveBest(p, usual, factor, least);
  if (!coarse) return std::nullopt;
  const std::optional<double> fine =
      AboveBest(p, *coarse / (factor * factor), std::pow(factor, 2.0 / kLevels), least);
  const double limit = fine.value_or(*coarse);
  // At the largest nothing is cut off.
  return limit < largest ? std::optional(limit) : std::nullopt;
}

/// What a limit takes from the torque that is delivered, two ends of every row.
SharedSignal TakenByLimit(const AxisLog& log, const AxisModel& m, double limit) {
  AxisLog beyond;
  beyond.period_s = log.period_s;
  for (const double u : log.command) beyond.command.push_back(std::clamp(u, -limit, limit) - u);
  Signal mean = DeliveredMeans(beyond, m.delay_s - m.lag_for_delay_s, m.lag_s + m.lag_for_delay_s, 1).mean;
  for (double& u : mean) u *= m.torque_gain;
  Signal ends = mean;
  ends.insert(ends.end(), mean.begin(), mean.end());
  return std::make_shared<const Signal>(std::move(ends));
}

/// Its amplitude is one over the limit: none is none.
void AddLimit(const Problem& p, std::vector<SharedEffect>& out) {
  const std::optional<double> limit = LimitOf(p);
  if (!limit) return;
  const double inverse = 1.0 / *limit;
  // As large as what is looked for: a smaller one cuts nothing off.
  const Amplitudes amplitudes = {
      .steps = {inverse}, .start = {inverse}, .low = {0.0}, .high = {2.0 * kLevels * inverse}};
  const auto apply = [&log = p.log](const auto& a, AxisModel& m) {
    if (a[0] > 0.0) Enter(m, Input::kMotorForce, {TakenByLimit(log, m, 1.0 / a[0])}, {1.0});
  };
  // Of what is commanded: a factor on all forces against the torque leaves it as it is.
  out.push_back(Custom({std::string(kName), std::string(kLimit), kLevels}, amplitudes, apply));
}

/// A torque that grows faster than the current, as no motor's does, or a limit that was never asked for.
bool Impossible(const Problem& p, const Effect& effect, const std::vector<double>& a) {
  if (IsLimit(effect)) return a[0] * LargestAsked(p) < 1.0;
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
          AddLimit(p, out);
        },
    .wave = nullptr,
    .family = [](const Effect& e) -> std::string_view { return IsLimit(e) ? " by a limit" : ""; },
    .implausible = Impossible,
    .parameters =
        [](const FittedEffect& fitted) {
          if (IsLimit(fitted.effect())) return NamedValues{{"limit_Nm", 1.0 / fitted.amplitudes()[0]}};
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
