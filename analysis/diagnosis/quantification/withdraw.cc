#include "analysis/diagnosis/quantification/withdraw.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/screening/score.h"
#include "analysis/diagnosis/tuning/fit_effort.h"

namespace contour::diagnosis {
namespace {

bool HoldsZero(const Cause& cause) {
  return !cause.parameters.empty() &&
         std::all_of(cause.parameters.begin(), cause.parameters.end(),
                     [](const auto& p) { return p.second.low <= 0.0 && p.second.high >= 0.0; });
}

template <class T>
void EraseAt(std::vector<T>& of, std::size_t at) {
  of.erase(of.begin() + static_cast<std::ptrdiff_t>(at));
}

/// The cause that stands at `at` in `out` and is so-and-so-manyth (`idle`) in the fit.
void TakeOut(std::size_t at, std::size_t idle, Point& point, Accepted& accepted, Diagnosis& out) {
  const std::size_t place = accepted.places[idle];
  EraseAt(point.effects, place);
  EraseAt(point.amplitudes, place);
  EraseAt(accepted.places, idle);
  EraseAt(accepted.scatter, idle);
  for (std::size_t& p : accepted.places)
    if (p > place) --p;
  const std::string kind = out.causes[at].kind;
  EraseAt(out.causes, at);
  if (at == 0) out.blocks.clear();  // were of the first
  for (Candidate& c : out.candidates)
    if (c.kind == kind) c.accepted = false;
  out.notes.push_back(kind +
                      " was accepted on the way and withdrawn: with all that was found in the model, its "
                      "size is zero within its interval.");
}

}  // namespace

bool WithdrawIdle(const Problem& problem, Fit& fit, Accepted& accepted, Diagnosis& out) {
  std::size_t in_fit = 0;
  for (std::size_t at = 0; at < out.causes.size(); ++at) {
    const Cause& cause = out.causes[at];
    if (CauseNamed(cause.kind).in_scatter_only) continue;  // not in the fit
    if (HoldsZero(cause) && !InBase(problem, cause.kind)) {
      Point left = fit.point;
      TakeOut(at, in_fit, left, accepted, out);
      fit = FitPoint(problem, std::move(left), FitEffort{});
      return true;
    }
    ++in_fit;
  }
  return false;
}

}  // namespace contour::diagnosis
