#include "analysis/diagnosis/quantification/model_errors.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

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

}  // namespace

ForecastError ErrorsOf(const Problem& p, const char* name, const Point& all,
                       const std::array<Point, 2>& halves) {
  ForecastError out;
  out.model = name;
  const Point points[] = {all, halves[0], halves[1]};
  const auto raw = p.Raw(points);
  Sum one_used, one_unseen, free_used, free_unseen;
  for (std::size_t part = 0; part < kHalfParts; ++part) {
    const std::size_t blind = part % 2 == 0 ? 2 : 1;
    for (std::size_t k = PartBegin(p, part); k < PartBegin(p, part + 1); ++k) {
      if (p.counted[k] == 0) continue;
      one_used.Add(raw[0][k]);
      one_unseen.Add(raw[blind][k]);
    }
  }
  for (const Parts parts : {Parts::kEven, Parts::kOdd}) {
    const AxisModel models[] = {p.Build(all), p.Build(halves[parts == Parts::kEven ? 1 : 0])};
    const auto errors = FreeRuns(p, models, FreeRunWindows(p, parts));
    for (const double e : errors[0]) free_used.Add(e);
    for (const double e : errors[1]) free_unseen.Add(e);
  }
  out.one_step_used = one_used.Rms();
  out.one_step_unseen = one_unseen.Rms();
  out.free_run_used = free_used.Rms();
  out.free_run_unseen = free_unseen.Rms();
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
  out.model_errors = {ErrorsOf(problem, "stated", stated, {stated, stated})};
  const bool extended = !with.point.effects.empty();
  const std::array<Point, 2> base = extended ? FitHalves(problem, without) : halves;
  out.model_errors.push_back(ErrorsOf(problem, "refitted", without.point, base));
  if (extended) out.model_errors.push_back(ErrorsOf(problem, "extended", with.point, halves));
  // Too short for a window.
  if (!std::isfinite(out.model_errors.front().free_run_used)) out.model_errors.clear();
}

void TellModelErrors(const Problem& problem, Diagnosis& out) {
  if (!out.model_errors.empty()) out.notes.push_back(ErrorText(problem, out));
}

}  // namespace contour::diagnosis
