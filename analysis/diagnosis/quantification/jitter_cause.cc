#include "analysis/diagnosis/quantification/jitter_cause.h"

#include <algorithm>
#include <utility>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "analysis/diagnosis/quantification/widen.h"
#include "analysis/diagnosis/tuning/screening_tuning.h"
#include "analysis/diagnosis/tuning/statistics.h"

namespace contour::diagnosis {
double ScoreOf(const Jitter& jitter) { return jitter.drop - kScreening.penalty_per_amplitude; }

void AcceptJitter(const Problem& problem, const Fit& nominal, const Jitter& jitter, Diagnosis& out) {
  Cause cause;
  cause.kind = *CauseInScatter().name;
  cause.log_evidence_gain = 0.5 * ScoreOf(jitter);
  cause.parameters[std::string(*CauseInScatter().main_parameter)] = {
      1e6 * jitter.rms_s, 1e6 * std::max(0.0, jitter.rms_s - kNormal95 * jitter.sigma_s),
      1e6 * (jitter.rms_s + kNormal95 * jitter.sigma_s)};
  WidenIntervals(problem, nominal.point, cause);
  cause.unit = problem.log.linear ? "N" : "Nm";
  cause.deciding_experiment = DecidingExperiment(problem, cause.kind, {}).text;
  for (Candidate& c : out.candidates)
    if (c.kind == cause.kind) c.accepted = true;
  out.causes.push_back(std::move(cause));
}

}  // namespace contour::diagnosis
