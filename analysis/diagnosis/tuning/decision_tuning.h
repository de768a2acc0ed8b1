#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "analysis/diagnosis/tuning/fit_effort.h"
#include "analysis/diagnosis/tuning/prediction_tuning.h"
#include "analysis/diagnosis/tuning/screening_tuning.h"

namespace contour::diagnosis {

/// What a user may ask for.
struct RoundsTuning {
  /// [probability] Default of the asked false-alarm rate. Source: custom. 2026-11-21
  double false_alarm_rate = 0.05;
  /// [causes] Default of how many are named at most. Source: archive. 2026-11-21
  int most_effects = 3;
};

/// Which hypotheses are fitted, and how far.
struct HypothesesTuning {
  /// [kinds] Fitted in one turn. Source: time. 2026-11-21
  std::size_t most_kinds = 4;
  /// [turns] Where the best came to nothing, those behind have theirs. Source: time. 2026-11-23
  int most_turns = 2;
  /// [share of the best score] Hypotheses below are given up at first. Source: time. 2026-11-22
  double given_up_share = 0.02;
  /// [share of the best score] The least that is tested at all. Source: archive. 2026-11-22
  double may_matter_share = 0.3;
  /// [chi^2] What new noise may add to a score. Source: archive. 2026-11-22
  double new_noise_score = 30.0;
  /// [share] Of a threshold, below which a score is not worth learning the noise again; of what the score
  /// test promises, below which a hypothesis is fitted anew. Source: time. 2026-11-22
  double half_share = 0.5;
  /// [chi^2] The same of a number of the base, below what the score test promises, which is exact there.
  /// Source: reasoning. 2026-11-21
  double fitted_anew_score = 1.0;
};

/// What a score must exceed.
struct ThresholdTuning {
  /// [draws] Of sign flips, and of a bootstrap of blocks. Source: reasoning; the quantile at 5 % rests on 75
  /// of them. 2026-11-21
  int flip_draws = 1500;
  /// [probability] A stated uncertainty is no normal distribution far out: what is less probable is no chance
  /// at any rate (3.1 deviations). Source: reasoning. 2026-11-21
  double beyond_stated_rate = 2e-3;
  /// [share of an amplitude] An extension that was found in another log may be off by as much. Source:
  /// reasoning. 2026-11-21
  double stated_off_share = 0.01;
  /// [share of its score] What an accepted cause may leave that looks like another one. Source: reasoning;
  /// sizes are right to three hundredths, and a drop goes with the square. 2026-11-23
  double leakage_share = 1e-3;
  /// [chi^2 per row] What the model's own errors add to a score on the average: integration, rows that differ
  /// from a held command. Source: reasoning; numerical errors are below 1 % of the noise power, and a
  /// five-hundredth of that may look like one cause. 2026-11-23
  double model_error_per_row = 1.8e-5;
};

/// Whether a hypothesis holds, and what it cannot be told from.
struct AcceptanceTuning {
  /// [sum of the drops in unseen blocks over the root of their sum of squares] More than one block carries
  /// it. Source: archive; it is 1 where one block carries all. 2026-11-21
  double consistency = 1.2;
  /// [chi^2] From here on chance is out of the question. Source: reasoning. 2026-11-21
  double no_chance_score = 100.0;
  /// [share of its drop] What is still there with another effect in the model is not explained by it. Source:
  /// archive. 2026-11-22
  double still_there_share = 0.6;
  /// [s] Deviation of the Gaussian that the residual torque is smoothed by: some 100 Hz. Source: reasoning.
  /// 2026-11-21
  double residual_smoothing_s = 1.3e-3;
  /// [share of the best score] Scores that are alike. Source: archive. 2026-11-22
  double alike_share = 0.03;
  /// [factor on a deviation] Most effects show in a few strokes only, whose scatter says the less of an
  /// interval. Source: Student's t of six over normal. 2026-11-21
  double few_strokes = 1.25;
};

inline constexpr RoundsTuning kRounds;
inline constexpr HypothesesTuning kHypotheses;
inline constexpr ThresholdTuning kThreshold;
inline constexpr AcceptanceTuning kAcceptance;

/// A log with fewer rows says nothing: its noise cannot be learnt in every block.
constexpr std::size_t FewestRows() { return kScreening.blocks * kNoise.whitener_order; }

/// Kinds that are looked at in one turn, and hypotheses that are kept.
constexpr std::size_t MostLookedAt() { return kHypotheses.most_kinds + 2; }

/// The residual torque's smoothing in rows: of slower logs than 1 kHz as many as there, for what goes to and
/// fro from row to row is noise of the reading.
inline double ResidualSmoothing(double period_s) {
  return kAcceptance.residual_smoothing_s / std::min(period_s, 1e-3);
}

/// Of small scores, what makes them alike: a likelihood ratio of one over the false-alarm rate for either.
inline double AlikeScore() { return -4.0 * std::log(kRounds.false_alarm_rate); }

/// What a scan's largest grid point loses: it has two amplitudes.
constexpr double ScanPenalty() { return 2 * kScreening.penalty_per_amplitude; }

/// Of what a stated extension explains, the share that is left where its amplitude is off.
constexpr double StatedOffDrop() { return kThreshold.stated_off_share * kThreshold.stated_off_share; }

/// The draw of the held-out bootstrap, in order of size, that has a probability below it.
constexpr std::size_t HeldOutDraw(double probability) {
  return static_cast<std::size_t>(probability * static_cast<double>(kThreshold.flip_draws));
}

}  // namespace contour::diagnosis
