#pragma once

#include <cstddef>

#include "analysis/diagnosis/tuning/fit_effort.h"
#include "analysis/diagnosis/tuning/screening_tuning.h"

namespace contour::diagnosis {

/// Logs, rounds, and what a user may ask for.
struct RoundsTuning {
  /// [s] A shorter log says nothing. Source: reasoning; one stroke or two. 2026-11-21
  double shortest_s = 3.0;
  /// [probability] Default of the asked false-alarm rate. Source: custom. 2026-11-21
  double false_alarm_rate = 0.05;
  /// [causes] Default of how many are named at most. Source: archive. 2026-11-21
  int most_effects = 3;
  /// [chi^2] A hypothesis with a higher score is in the model next time around; what could be found of the
  /// others is asked then. Source: time. 2026-11-22
  double no_doubt_score = 1000.0;
  /// [share of its drop] In addition to a mean effect that the variance of jitter was about, less is left of
  /// it. Source: archive. 2026-11-22
  double jitter_left_share = 0.6;
};

/// Which hypotheses are fitted, and how far.
struct HypothesesTuning {
  /// [kinds] Fitted in one turn. Source: time. 2026-11-21
  std::size_t most_kinds = 4;
  /// [kinds] Looked at in one turn. Source: time. 2026-11-21
  std::size_t most_tried = 6;
  /// [turns] Where the best came to nothing, those behind have theirs. Source: time. 2026-11-22
  int most_turns = 3;
  /// [hypotheses] Kept. Source: time. 2026-11-22
  std::size_t most_kept = 6;
  /// [share of the largest drop] Kinds that are promised less wait, and scores below it are as good as
  /// nothing. Source: time. 2026-11-21
  double waits_share = 0.1;
  /// [share of the best score] Hypotheses below are given up at first. Source: time. 2026-11-22
  double given_up_share = 0.02;
  /// [share of the best score] No more than this is no reason for a further step. Source: time. 2026-11-22
  double all_the_same_share = 1e-3;
  /// [of the share above] The best itself is fitted so much better. Source: archive. 2026-11-22
  double best_fit_factor = 0.02;
  /// [share of the best score] The least that is tested at all. Source: archive. 2026-11-22
  double may_matter_share = 0.3;
  /// [share of the best score] The same before the last steps. Source: archive. 2026-11-22
  double may_win_share = 0.4;
  /// [chi^2] What new noise may add to a score. Source: archive. 2026-11-22
  double new_noise_score = 30.0;
  /// [share of the threshold] A score below is not worth learning the noise again. Source: time. 2026-11-22
  double near_threshold_share = 0.5;
  /// [share of what the score test promises] A hypothesis that has less is fitted anew. Source: archive.
  /// 2026-11-21
  double fitted_anew_share = 0.5;
  /// [chi^2] The same of a number of the base, below what the score test promises, which is exact there.
  /// Source: reasoning. 2026-11-21
  double fitted_anew_score = 1.0;
  /// [ratio of scores] A shape from outside the catalogue comes first only where it explains far more than
  /// the best cause. Source: archive. 2026-11-21
  double outside_factor = 1.3;
  /// [chi^2] The same, and what its score exceeds the threshold by. Source: archive. 2026-11-21
  double outside_score = 25.0;
  /// [share of the residual leakage] In addition to a large cause the score test falls short by as much: the
  /// noise that it was made under has the other one in it. Source: archive. 2026-11-22
  double short_by_leakage_share = 0.1;

  /// [steps and chi^2] From the linear estimate. Source: time. 2026-11-22
  FitEffort near = {.most_steps = 3, .most_refreshes = 1, .close_enough = 1.0, .covariance = false};
  /// [steps and chi^2] From a grid point at full size, and once more from the stated numbers. Source: time.
  /// 2026-11-22
  FitEffort far = {.most_steps = 8, .most_refreshes = 3, .close_enough = 1.0, .covariance = false};
  /// [steps and chi^2] Base model under new noise. Source: time. 2026-11-22
  FitEffort base_again = {.most_steps = 10, .most_refreshes = 3, .close_enough = 0.1};
  /// [steps and chi^2] The best under new noise. Source: time. 2026-11-22
  FitEffort best_again = {.most_steps = 10, .most_refreshes = 4, .close_enough = 0.1};
  /// [steps and chi^2] The others under new noise. Source: time. 2026-11-22
  FitEffort others_again = {.most_steps = 5, .most_refreshes = 1, .close_enough = 0.3, .covariance = false};
  /// [steps and chi^2] Begun anew under new noise. Source: time. 2026-11-22
  FitEffort anew = {.most_steps = 5, .most_refreshes = 2, .close_enough = 0.3};
  /// [steps] One that has become the first. Source: time. 2026-11-22
  FitEffort became_first = {.most_steps = 3, .most_refreshes = 2};
  /// [steps] One that is chosen though others scored more. Source: time. 2026-11-22
  FitEffort chosen = {.most_steps = 4, .most_refreshes = 2};
};

/// What a score must exceed.
struct ThresholdTuning {
  /// [probability] Rate of false alarms at which model-error allowances were read off clean logs. Source:
  /// custom; belongs to model_error_table.inc. 2026-11-21
  double calibrated_rate = 0.05;
  /// [draws] Of sign flips. Source: reasoning; the quantile at 2 % rests on 30 of them. 2026-11-21
  int flip_draws = 1500;
  /// [scans] Whose largest grid point by chance takes part in each draw. Source: the scans over orders and
  /// frequencies. 2026-11-21
  int scans = 6;
  /// [grid points] Waves of a grid that is larger come from a scan. Source: reasoning. 2026-11-21
  double scanned_grid = 12.0;
  /// [probability] From here on the tail of a Gumbel distribution stands for the draws. Source: reasoning; 30
  /// draws are beyond. 2026-11-21
  double tail_rate = 0.02;
  /// [probability] Where that distribution is fitted as well. Source: reasoning; the upper fifth. 2026-11-22
  double fitted_quantile = 0.80;
  /// [chi^2 per row] Of numbers of the base in addition to accepted causes, whose residual leakage they may
  /// take up. Source: one clear cause a log, emulated. 2026-11-22
  double leakage_per_row = 3e-5;
  /// [share of the false alarms] Of each kind that is a number of the base. Source: reasoning. 2026-11-21
  double share_in_base = 0.2;
  /// [probability] A stated uncertainty is no normal distribution far out: what is less probable is no chance
  /// at any rate (3.1 deviations). Source: reasoning. 2026-11-21
  double beyond_stated_rate = 2e-3;
  /// [chi^2] Drops below may be a cost that is a little rough: tested at their own place as well. Source:
  /// archive. 2026-11-22
  double beyond_chance_drop = 300.0;
  /// [chi^2] Score tests below count themselves. Source: archive. 2026-11-22
  double small_drop = 60.0;
  /// [share of an amplitude] An extension that was found in another log may be off by as much. Source:
  /// reasoning. 2026-11-21
  double stated_off_share = 0.01;
  /// [share of its score] An element in presliding stands for a friction-model mismatch, and leaves more than
  /// a right name does. Source: archive, with Maxwell-slip friction. 2026-11-22
  double leakage_on_mismatch_share = 0.05;
};

/// Whether a hypothesis holds, and what it cannot be told from.
struct AcceptanceTuning {
  /// [sum of the drops in unseen blocks over the root of their sum of squares] More than one block carries
  /// it. Source: archive; it is 1 where one block carries all. 2026-11-21
  double consistency = 1.2;
  /// [the same, in blocks that the fit has seen] Where chance is out of the question. Source: archive.
  /// 2026-11-21
  double seen_consistency = 1.5;
  /// [chi^2] From here on chance is out of the question. Source: reasoning. 2026-11-21
  double no_chance_score = 100.0;
  /// [share of its drop] What is still there with another effect in the model is not explained by it. Source:
  /// archive. 2026-11-22
  double still_there_share = 0.6;
  /// [blocks] Of the two folds of the held-out gain. Source: reasoning; twelve a fold. 2026-11-21
  std::size_t held_out_blocks = 24;
  /// [draws] Of the bootstrap of those blocks. Source: reasoning; 12 lie outside of either end of its
  /// interval. 2026-11-21
  std::size_t held_out_draws = 500;
  /// [s] Deviation of the Gaussian that the residual torque is smoothed by: some 100 Hz. Source: reasoning.
  /// 2026-11-21
  double residual_smoothing_s = 1.3e-3;
  /// [share of the best score] Scores that are alike. Source: archive. 2026-11-22
  double alike_share = 0.03;
  /// [share of the best score] The same on a friction-model mismatch: what is wrong with the model takes part
  /// in the difference, and constant torque and asymmetry differ at reversals only, which do not count.
  /// Source: archive, with Maxwell-slip friction. 2026-11-22
  double alike_on_mismatch_share = 0.1;
  /// [chi^2] The same of small scores: a likelihood ratio of 400. Source: reasoning. 2026-11-21
  double alike_score = 12.0;
  /// [factor on a deviation] Most effects show in a few strokes only, whose scatter says the less of an
  /// interval. Source: Student's t of six over normal. 2026-11-21
  double few_strokes = 1.25;
  /// [share of what there is to explain] Causes by their right names leave less than a hundredth, others a
  /// tenth and more. Source: archive; effects in and outside the catalogue. 2026-11-22
  double large_share = 0.04;
  /// [share of what there is to explain] A torque that is left says little about an error of the lead, which
  /// shows on the scale alone. Source: archive, with pitch errors. 2026-11-22
  double large_with_scale_error_share = 0.3;
};

inline constexpr RoundsTuning kRounds;
inline constexpr HypothesesTuning kHypotheses;
inline constexpr ThresholdTuning kThreshold;
inline constexpr AcceptanceTuning kAcceptance;

/// What a scan's largest grid point loses: it has two amplitudes.
constexpr double ScanPenalty() { return 2 * kScreening.penalty_per_amplitude; }

/// Of the draws of sign flips, where the fitted tail begins.
constexpr double TailQuantile() { return 1.0 - kThreshold.tail_rate; }

/// Of what a stated extension explains, the share that is left where its amplitude is off.
constexpr double StatedOffDrop() { return kThreshold.stated_off_share * kThreshold.stated_off_share; }

/// The draw of the held-out bootstrap, in order of size, that has a probability below it.
constexpr std::size_t HeldOutDraw(double probability) {
  return static_cast<std::size_t>(probability * static_cast<double>(kAcceptance.held_out_draws));
}

}  // namespace contour::diagnosis
