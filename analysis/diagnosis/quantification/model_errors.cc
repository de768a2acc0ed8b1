#include "analysis/diagnosis/quantification/model_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "analysis/diagnosis/causes/extensions_of.h"
#include "analysis/prediction_error/fitted_half.h"
#include "analysis/prediction_error/free_runs.h"
#include "config/number_text.h"

namespace contour::diagnosis {
namespace {

struct Sum {
  double squares = 0.0, rows = 0.0;
  void Add(double x) {
    squares += x * x;
    rows += 1.0;
  }
  [[nodiscard]] double Rms() const { return rows > 0.0 ? std::sqrt(squares / rows) : std::nan(""); }
};

struct Errors {
  Sum one_used, one_unseen, free_used, free_unseen;
};

/// Where the points of a forecast are among those of all.
struct PlacesOfOne {
  std::size_t all = 0;
  std::array<std::size_t, 2> half = {};
};

/// "12.3 um" or, of what turns, "12.3 mrad".
std::string LengthText(const Problem& p, double q) {
  return p.log.linear ? RoundedText(1e6 * q) + " um" : RoundedText(1e3 * q) + " mrad";
}

std::string ErrorText(const Problem& p, const Diagnosis& d) {
  std::string text = "On parts of the log that it was not fitted on, over " + RoundedText(d.free_run_s) +
                     " s on the recorded command alone, the model is off by (root mean square):";
  for (const ForecastError& e : d.model_errors)
    text += (&e == d.model_errors.data() ? " " : ", ") + e.model + " " + LengthText(p, e.free_run_unseen);
  return text + ".";
}

/// What runs with the causes found are worth the file is not, where it has no place for one of them.
std::string NoPlaceText(const std::vector<Cause>& causes) {
  std::string kinds;
  for (const Cause& c : causes)
    if (!CanExtend(c.kind)) kinds += (kinds.empty() ? "" : ", ") + c.kind;
  return kinds.empty() ? ""
                       : "No model file has a place for " + kinds +
                             ": what extended_model.yaml foresees is not as good as `extended`.";
}

}  // namespace

std::vector<ForecastError> ErrorsOf(const Problem& p, std::span<const Forecast> forecasts) {
  // All models side by side, so that their runs share the lanes.
  std::vector<Point> points;
  std::vector<PlacesOfOne> at;
  for (const Forecast& f : forecasts) {
    const std::size_t first = points.size();
    points.push_back(f.all);
    at.push_back({first, {first, first}});
    if (!f.halves) continue;
    at.back().half = {first + 1, first + 2};
    points.insert(points.end(), f.halves->begin(), f.halves->end());
  }
  std::vector<Errors> sums(forecasts.size());
  const auto raw = p.Raw(points);
  for (std::size_t part = 0; part < kHalfParts; ++part) {
    const std::size_t blind = 1 - part % 2;
    for (std::size_t k = PartBegin(p, part); k < PartBegin(p, part + 1); ++k) {
      if (p.counted[k] == 0) continue;
      for (std::size_t f = 0; f < forecasts.size(); ++f) {
        sums[f].one_used.Add(raw[at[f].all][k]);
        sums[f].one_unseen.Add(raw[at[f].half[blind]][k]);
      }
    }
  }
  for (const Parts parts : {Parts::kEven, Parts::kOdd}) {
    const std::size_t blind = parts == Parts::kEven ? 1 : 0;
    std::vector<AxisModel> models;
    for (const PlacesOfOne& of : at)
      for (const std::size_t i : {of.all, of.half[blind]}) models.push_back(p.Build(points[i]));
    const auto errors = FreeRuns(p, models, FreeRunWindows(p, parts));
    for (std::size_t f = 0; f < forecasts.size(); ++f) {
      for (const double e : errors[2 * f]) sums[f].free_used.Add(e);
      for (const double e : errors[2 * f + 1]) sums[f].free_unseen.Add(e);
    }
  }
  std::vector<ForecastError> out;
  for (std::size_t f = 0; f < forecasts.size(); ++f) {
    out.emplace_back();
    out.back().model = forecasts[f].model;
    out.back().one_step_used = sums[f].one_used.Rms();
    out.back().one_step_unseen = sums[f].one_unseen.Rms();
    out.back().free_run_used = sums[f].free_used.Rms();
    out.back().free_run_unseen = sums[f].free_unseen.Rms();
  }
  return out;
}

void DescribeModelErrors(const Problem& problem, const Fit& without, const Fit& with,
                         const std::array<Point, 2>& halves, Diagnosis& out) {
  Point stated = without.point;
  for (std::size_t i = 0; i < stated.base.size(); ++i)
    if (!problem.terms[i].nuisance) stated.base[i] = 0.0;
  stated.effects.clear();
  stated.amplitudes.clear();
  out.free_run_s = kFreeRun_s;
  const bool extended = !with.point.effects.empty();
  std::vector<Forecast> forecasts = {{"stated", stated, {}}};
  forecasts.push_back({"refitted", without.point, extended ? FitHalves(problem, without) : halves});
  if (extended) forecasts.push_back({"extended", with.point, halves});
  out.model_errors = ErrorsOf(problem, forecasts);
  // Too short for a window.
  if (!std::isfinite(out.model_errors.front().free_run_used)) out.model_errors.clear();
}

void TellModelErrors(const Problem& problem, Diagnosis& out) {
  if (out.model_errors.empty()) return;
  out.notes.push_back(ErrorText(problem, out));
  if (const std::string text = NoPlaceText(out.causes); !text.empty()) out.notes.push_back(text);
  const auto [low, high] =
      std::minmax_element(problem.signals->position.begin(), problem.signals->position.end());
  if (!out.causes.empty() || !(out.model_errors.back().free_run_unseen > *high - *low)) return;
  out.notes.push_back(
      "That is further than the axis went in the whole log (" + LengthText(problem, *high - *low) +
      "). Either next to nothing holds it against a force, or the recorded command is not what "
      "moved it: a motor at its limit, say, or rows that do not belong together.");
}

}  // namespace contour::diagnosis
