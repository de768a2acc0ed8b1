#include "analysis/diagnosis/quantification/withdraw.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/decision/base_there.h"
#include "analysis/diagnosis/tuning/decision_tuning.h"

namespace contour::diagnosis {
namespace {

bool HoldsZero(const Interval& i) { return i.low <= 0.0 && i.high >= 0.0; }

/// When something began says nothing of how large it is.
constexpr std::string_view kInstant = "time_s";

/// All of its numbers are zero within their intervals; or the one that says how large it is, of a cause that
/// chance may bring about. Where chance cannot, that interval is wide since other numbers of the cause do
/// nearly the same.
bool HoldsZero(const Cause& cause) {
  const auto main = cause.parameters.find(std::string(*CauseNamed(cause.kind).main_parameter));
  if (main == cause.parameters.end() || !HoldsZero(main->second)) return false;
  return 2.0 * cause.log_evidence_gain < kAcceptance.no_chance_score ||
         std::all_of(cause.parameters.begin(), cause.parameters.end(),
                     [](const auto& p) { return p.first == kInstant || HoldsZero(p.second); });
}

/// With all that was found in the model the fit went on to where the cause is not what its name says.
bool WentTooFar(const Problem& problem, const Fit& fit, std::size_t place) {
  const Effect& effect = *fit.point.effects[place];
  const CauseDefinition& cause = CauseNamed(effect.kind);
  return cause.implausible != nullptr && (*cause.implausible)(problem, effect, fit.point.amplitudes[place]);
}

void TakeOut(const Problem& problem, std::size_t in_fit, const char* why, Fit& fit, Accepted& accepted,
             Diagnosis& out) {
  fit = FitPoint(problem, Without(problem, fit.point, accepted.places[in_fit]));
  out.notes.push_back(TakeBack(in_fit, accepted, out).kind +
                      " was accepted in an earlier round and is withdrawn: with all that was found in the "
                      "model, " +
                      why);
}

}  // namespace

bool WithdrawIdle(const Problem& problem, Fit& fit, Accepted& accepted, Diagnosis& out) {
  // A shape that nobody knows takes over what known causes explain, which are still what comes nearest.
  if (std::any_of(out.causes.begin(), out.causes.end(), [](const Cause& c) { return Outside(c.kind); }))
    return false;
  std::size_t in_fit = 0;
  for (const Cause& cause : out.causes) {
    if (CauseNamed(cause.kind).in_scatter_only) continue;  // not in the fit
    if (WentTooFar(problem, fit, accepted.places[in_fit])) {
      TakeOut(problem, in_fit, "its size is more than such a cause can have.", fit, accepted, out);
      return true;
    }
    // A factor on all forces against the torque has its interval from what is stated.
    if (HoldsZero(cause) && !CauseNamed(cause.kind).common_factor) {
      TakeOut(problem, in_fit, "its size is zero within its interval.", fit, accepted, out);
      return true;
    }
    ++in_fit;
  }
  return false;
}

}  // namespace contour::diagnosis
