#include "analysis/diagnosis/diagnose.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "analysis/diagnosis/adequacy/remaining_structure.h"
#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/decision/evidence.h"
#include "analysis/diagnosis/decision/hypothesis.h"
#include "analysis/diagnosis/decision/verdict.h"
#include "analysis/diagnosis/quantification/column_lag.h"
#include "analysis/diagnosis/quantification/displacements.h"
#include "analysis/diagnosis/quantification/follow_play.h"
#include "analysis/diagnosis/quantification/quantify.h"
#include "analysis/diagnosis/quantification/slow_torque.h"
#include "analysis/diagnosis/quantification/written_model.h"
#include "analysis/diagnosis/rounds.h"
#include "analysis/diagnosis/screening/nominal.h"
#include "analysis/diagnosis/tuning/decision_tuning.h"
#include "analysis/diagnosis/tuning/prediction_tuning.h"

namespace contour::diagnosis {
namespace {

void CheckInput(const AxisLog& log, const StatedAxis& stated) {
  const std::size_t n = log.size();
  const auto same = [&](const std::vector<double>& v, bool optional) {
    return v.size() == n || (optional && v.empty());
  };
  if (!same(log.position, false) || !same(log.table_position_m, true) || !same(log.temperature_degC, true) ||
      !same(log.axis2_position_m, true) || !same(log.reference_position, true) || log.present.size() != n)
    throw std::invalid_argument(log.source + ": columns of different length");
  if (!(log.period_s > 0.0)) throw std::invalid_argument(log.source + ": period is not positive");
  if (!(stated.motor_inertia > 0.0)) throw std::invalid_argument(stated.source + ": inertia is not positive");
}

/// So many that every segment of the noise settles.
constexpr std::size_t FewestRowsThere() {
  return std::max(FewestRows(), kNoise.segments * kNoise.settling_rows);
}

std::size_t RowsThere(const AxisLog& log) {
  return static_cast<std::size_t>(std::count(log.present.begin(), log.present.end(), std::uint8_t{1}));
}

/// What goes with a stroke is no cause where there is none. Nor is a torque constant off that nobody stated:
/// it was taken from this log, by the stated inertia; nor where the inertia alone is stated, and nothing says
/// whether it is the one that is off. A velocity that was filtered looks like a coupling or a play; of what
/// the axis itself does at such frequencies a log without a position says nothing.
DiagnoseOptions WithoutWhatCannotBe(const AxisLog& log, const StatedAxis& stated, DiagnoseOptions options) {
  const bool inertia_alone = stated.open.contains("Fc") && stated.open.contains("s2");
  const bool any_constant = stated.open.contains("ampere") || inertia_alone;
  for (const CauseDefinition* c : AllCauses())
    if ((stated.endless && c->shape != nullptr) || (any_constant && c->common_factor) ||
        (log.from_velocity && c->acts_at_reversals))
      options.exclude.emplace_back(*c->name);
  return options;
}

Diagnosis TooShort(const AxisLog& log, const DiagnoseOptions& options) {
  Diagnosis out;
  out.false_alarm_rate = options.false_alarm_rate;
  out.data_quality.rows = log.rows;
  out.data_quality.missing = log.missing;
  out.notes.push_back("The log has fewer than " + std::to_string(FewestRowsThere()) + " rows of motion.");
  return out;
}

/// Where something known is missing, what was fitted may be wrong with it: it has to foresee better than what
/// was stated.
void KeepStatedWhereBetter(const StatedAxis& stated, Diagnosis& out) {
  if (out.verdict != Verdict::kUnexplained || out.model_errors.empty()) return;
  if (!(out.model_errors.back().free_run_unseen >= out.model_errors.front().free_run_unseen)) return;
  out.fitted = stated;
  out.in_model.clear();
  out.notes.push_back(
      "What was fitted foresees parts of the log that it has not seen no better than the stated model does: "
      "the model file keeps the stated numbers.");
}

}  // namespace

Diagnosis Diagnose(const AxisLog& log, const StatedAxis& stated, const DiagnoseOptions& asked) {
  CheckInput(log, stated);
  const DiagnoseOptions options = WithoutWhatCannotBe(log, stated, asked);
  if (RowsThere(log) < FewestRowsThere()) return TooShort(log, options);
  Diagnosis out;
  out.false_alarm_rate = options.false_alarm_rate;
  Problem problem(log, stated, options.threads);
  // 1. The stated model, its numbers fitted to the log.
  Say(options, "base model", 0.0);
  Nominal nominal = FitNominal(problem);
  // 2. Screening and 3. decision, in turn: what would explain more than chance, and whether it holds.
  RoundsResult rounds = AcceptInRounds(problem, nominal, options, out);
  // 4. Quantification: how large it is, by one fit of all of it.
  FollowPlay(problem, rounds.accepted, nominal.fit);
  const Fit fit = Quantify(problem, nominal.fit, rounds.accepted, options, out);
  // 5. Adequacy: whether something is left that none of it explains.
  const std::vector<RemainingStructure> left = FindStructure(problem, fit, options.false_alarm_rate);
  std::erase_if(out.candidates, [](const Candidate& c) { return Outside(c.kind); });
  TellStructure(rounds.accepted, left, options);
  Say(options, "errors of the models", 1.0);
  DescribeModel(problem, nominal.fit, fit, rounds.accepted, left[0].score > left[0].asked, out);
  Conclude(problem, left, out);
  TellDisplacements(problem, nominal.fit.point, out);
  TellSlowTorque(problem, out);
  TellColumnLag(problem, fit.point, out);
  KeepStatedWhereBetter(stated, out);
  if (out.verdict == Verdict::kUnexplained && out.causes.empty()) out.causes = std::move(rounds.leading);
  if (rounds.stopped && out.verdict == Verdict::kUnexplained)
    out.notes.push_back("No more than " + std::to_string(options.most_effects) +
                        " causes were looked for: several known ones together may be behind it.");
  Say(options, "done", 1.0);
  return out;
}

}  // namespace contour::diagnosis
