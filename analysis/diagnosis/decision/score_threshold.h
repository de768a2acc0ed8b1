#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "analysis/diagnosis/screening/score.h"
#include "analysis/diagnosis/tuning/decision_tuning.h"

namespace contour::diagnosis {

/// What a score must exceed for its kind to be named.
struct ScoreThreshold {
  double flips = 0.0;                      ///< as SignFlips has it, at the asked rate
  double calibrated = 0.0;                 ///< the same at the rate of the calibration
  double rate = kRounds.false_alarm_rate;  ///< of false alarms
  int accepted = 0;                        ///< causes that are accepted already
  double leakage = 0.0;                    ///< what of their scores may look like other causes
  /// The same, as another cause of a kind that is among them: harmonics, neighbouring orders.
  std::map<std::string, double> leakage_of_kind = {};

  bool model_error = true;  ///< for the model's own errors

  [[nodiscard]] double LeakageAs(const std::string& kind) const;
};

/// By chance alone, but for numbers of the base: no model-error allowance, and nothing left of accepted
/// causes. What the allowances are read off is measured against it.
ScoreThreshold ByChanceAlone(ScoreThreshold threshold);

/// How residual leakage shows in a kind's score.
struct ScoreScale {
  double overdispersion = 1.0;  ///< of chance, which scores are divided by
  /// Of a number of the base: the variance that the log leaves it, over its stated variance. Residual leakage
  /// moves the number by so much, and only there lies the evidence.
  double variance_ratio = 1.0;
};

ScoreScale ScoreScaleOf(const Problem& problem, const Scored& scored);
/// Of the last effect of a fit.
ScoreScale ScoreScaleOf(const Problem& problem, const Fit& fit);

/// The score that the best of all candidates exceeds by chance with a given probability: residual blocks
/// with random signs against the fixed columns, waves found by a scan as the largest of their grid; beyond
/// kThreshold.tail_rate along a Gumbel fit. `more` is added to it.
ScoreThreshold SignFlips(std::span<const Scored> scored, double false_alarm_rate, std::uint64_t seed,
                         double more);

double Threshold(const Problem& problem, const ScoreThreshold& threshold, const Effect& effect,
                 const ScoreScale& score_scale);
/// The same of a kind without a number in the base.
double Threshold(const Problem& problem, const ScoreThreshold& threshold);

}  // namespace contour::diagnosis
