#include "analysis/diagnosis/quantification/model_errors.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "analysis/prediction_error/fitted_half.h"
#include "config/number_text.h"

namespace contour::diagnosis {
namespace {

constexpr double kFreeRun_s = 1.0;

struct Sum {
  double squares = 0.0, rows = 0.0;
  void Add(double x) {
    squares += x * x;
    rows += 1.0;
  }
  [[nodiscard]] double Rms() const { return rows > 0.0 ? std::sqrt(squares / rows) : std::nan(""); }
};

/// Windows back to back in [from, to) that hold no gap.
std::vector<Segment> WindowsOf(const Problem& p, std::size_t from, std::size_t to, double seconds) {
  const auto length = static_cast<std::size_t>(seconds / p.log.period_s + 0.5);
  const Signals& s = *p.signals;
  std::vector<Segment> out;
  const auto whole = [&](std::size_t at) {
    for (std::size_t k = at; k < at + length; ++k)
      if (p.setup.valid[k] == 0 || p.counted[at] == 0) return k + 1;
    return at;
  };
  for (std::size_t at = from; at + length <= to;) {
    const std::size_t next = whole(at);
    if (next != at) {
      at = next;
      continue;
    }
    out.push_back({at, length, out.size() * length, s.position[at], s.velocity[at]});
    at += length;
  }
  return out;
}

void FreeRuns(const Problem& p, const AxisModel& model, std::size_t from, std::size_t to, double seconds,
              Sum& sum) {
  const std::vector<Segment> windows = WindowsOf(p, from, to, seconds);
  if (windows.empty()) return;
  FilterSetup free = p.setup;
  free.gain = {};
  free.gain_two = {};
  free.full = false;
  free.segments = windows;
  // The run's row k holds where the model is at row k: nothing corrects it, so that is how far it is off.
  const std::vector<FilterRun> runs = RunFilter(free, std::span(&model, 1), 1);
  for (const double e : runs[0].innovation) sum.Add(e);
}

/// Of one model on all parts, and of two others each on the parts that it has not seen.
ForecastError ErrorsOf(const Problem& p, const char* name, const Point& all, const Point& even_only,
                       const Point& odd_only) {
  ForecastError out;
  out.model = name;
  const Point points[] = {all, even_only, odd_only};
  const auto raw = p.Raw(points);
  const AxisModel models[] = {p.Build(all), p.Build(even_only), p.Build(odd_only)};
  Sum one_used, one_unseen, free_used, free_unseen;
  for (std::size_t part = 0; part < kHalfParts; ++part) {
    const std::size_t blind = part % 2 == 0 ? 2 : 1;
    for (std::size_t k = PartBegin(p, part); k < PartBegin(p, part + 1); ++k) {
      if (p.counted[k] == 0) continue;
      one_used.Add(raw[0][k]);
      one_unseen.Add(raw[blind][k]);
    }
    FreeRuns(p, models[0], PartBegin(p, part), PartBegin(p, part + 1), kFreeRun_s, free_used);
    FreeRuns(p, models[blind], PartBegin(p, part), PartBegin(p, part + 1), kFreeRun_s, free_unseen);
  }
  out.one_step_used = one_used.Rms();
  out.one_step_unseen = one_unseen.Rms();
  out.free_run_used = free_used.Rms();
  out.free_run_unseen = free_unseen.Rms();
  return out;
}

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

double FreeRunError(const Problem& problem, const AxisModel& model, double seconds, std::size_t from,
                    std::size_t to) {
  Sum sum;
  FreeRuns(problem, model, from, to, seconds, sum);
  return sum.Rms();
}

void DescribeModelErrors(const Problem& problem, const Fit& without, const Fit& with,
                         const std::array<Point, 2>& halves, Diagnosis& out) {
  Point stated = without.point;
  for (std::size_t i = 0; i < stated.base.size(); ++i)
    if (!problem.terms[i].nuisance) stated.base[i] = 0.0;
  stated.effects.clear();
  stated.amplitudes.clear();
  out.free_run_s = kFreeRun_s;
  out.model_errors = {ErrorsOf(problem, "stated", stated, stated, stated)};
  const bool extended = !with.point.effects.empty();
  const std::array<Point, 2> base = extended ? FitHalves(problem, without) : halves;
  out.model_errors.push_back(ErrorsOf(problem, "refitted", without.point, base[0], base[1]));
  if (extended) out.model_errors.push_back(ErrorsOf(problem, "extended", with.point, halves[0], halves[1]));
  // Too short for a window.
  if (std::isfinite(out.model_errors.front().free_run_used))
    out.notes.push_back(ErrorText(problem, out));
  else
    out.model_errors.clear();
}

}  // namespace contour::diagnosis
