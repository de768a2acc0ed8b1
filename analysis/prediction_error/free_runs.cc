#include "analysis/prediction_error/free_runs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/prediction_error/fitted_half.h"

namespace contour::diagnosis {
namespace {

/// Rows [from, to).
struct RowRange {
  std::size_t from = 0, to = 0;
};

std::vector<Segment> WindowsOf(const Problem& problem, RowRange rows, double seconds, double apart = 1.0) {
  const auto length = static_cast<std::size_t>(seconds / problem.log.period_s + 0.5);
  const auto step = std::max<std::size_t>(1, static_cast<std::size_t>(apart * static_cast<double>(length)));
  const Signals& s = *problem.signals;
  std::vector<Segment> out;
  const auto whole = [&](std::size_t at) {
    for (std::size_t k = at; k < at + length; ++k)
      if (problem.setup.valid[k] == 0 || problem.counted[at] == 0) return k + 1;
    return at;
  };
  for (std::size_t at = rows.from; at + length <= rows.to;) {
    const std::size_t next = whole(at);
    if (next != at) {
      at = next;
      continue;
    }
    out.push_back({at, length, out.size() * length, s.position[at], s.velocity[at]});
    at += step;
  }
  return out;
}

}  // namespace

std::vector<Segment> FreeRunWindows(const Problem& problem, Parts parts) {
  if (parts == Parts::kAll) return WindowsOf(problem, {0, problem.rows()}, kFreeRun_s, kFreeRunsApart);
  std::vector<Segment> out;
  for (std::size_t part = parts == Parts::kEven ? 0 : 1; part < kHalfParts; part += 2)
    for (Segment w : WindowsOf(problem, {PartBegin(problem, part), PartBegin(problem, part + 1)}, kFreeRun_s,
                               kFreeRunsApart)) {
      w.at = out.size() * w.rows;
      out.push_back(w);
    }
  return out;
}

std::vector<std::vector<double>> FreeRuns(const Problem& problem, std::span<const AxisModel> models,
                                          const std::vector<Segment>& windows) {
  std::vector<std::vector<double>> out(models.size());
  if (windows.empty()) return out;
  FilterSetup free = problem.setup;
  free.gain = {};
  free.gain_two = {};
  free.full = false;
  free.segments = windows;
  // The run's row k holds where the model is at row k: nothing corrects it, so that is how far it is off.
  std::vector<FilterRun> runs = RunFilter(free, models, problem.threads);
  for (std::size_t i = 0; i < runs.size(); ++i) out[i] = std::move(runs[i].innovation);
  return out;
}

double FreeRunError(const Problem& problem, const AxisModel& model, double seconds, std::size_t from,
                    std::size_t to) {
  const auto errors = FreeRuns(problem, std::span(&model, 1), WindowsOf(problem, {from, to}, seconds))[0];
  double squares = 0.0;
  for (const double e : errors) squares += e * e;
  return errors.empty() ? std::nan("") : std::sqrt(squares / static_cast<double>(errors.size()));
}

}  // namespace contour::diagnosis
