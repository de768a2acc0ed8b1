#pragma once

#include <cstddef>

#include "analysis/diagnosis/tuning/fit_effort.h"

// What decides a diagnosis below it: the priors of the base model, the rows that count, and the noise. Steps
// of derivatives and of integration are numerics, and stand where they are used.
namespace contour::diagnosis {

/// Deviations of the base model's numbers, where the model file states none.
struct PriorTuning {
  /// [share] Of an inertia. Source: reasoning; what a careful data sheet is worth, as all below it.
  /// 2026-11-21
  double inertia_rel = 0.05;
  /// [share] Of the inertia behind a coupling. Source: reasoning. 2026-11-21
  double load_inertia_rel = 0.05;
  /// [share] Of a coupling's stiffness. Source: reasoning. 2026-11-21
  double stiffness_rel = 0.10;
  /// [share] Of a coupling's damping. Source: reasoning. 2026-11-21
  double damping_rel = 0.5;
  /// [share] Of the Coulomb level. Source: reasoning. 2026-11-21
  double Fc_rel = 0.10;
  /// [share] Of the break-away level. Source: reasoning. 2026-11-21
  double Fs_rel = 0.10;
  /// [share] Of the Stribeck speed. Source: reasoning. 2026-11-21
  double vs_rel = 0.20;
  /// [share] Of the bristle's stiffness. Source: reasoning. 2026-11-21
  double s0_rel = 0.20;
  /// [share] Of the bristle's damping. Source: reasoning. 2026-11-21
  double s1_rel = 0.50;
  /// [share] Of viscous friction. Source: reasoning. 2026-11-21
  double s2_rel = 0.10;
  /// [share] Of the drive's delay. Source: reasoning. 2026-11-21
  double delay_rel = 0.01;
  /// [share] Of the drive's lag. Source: reasoning. 2026-11-21
  double lag_rel = 0.05;
  /// [share] Of the torque constant: held. Source: reasoning. 2026-11-21
  double torque_constant_rel = 0.0;
  /// [s] Of lag in exchange for delay, which is how a coupling of 1 kHz looks from below; softer ones are for
  /// `compliance` to find. Source: reasoning. 2026-11-21
  double lag_for_delay_s = 25e-6;
  /// [share of the Stribeck speed] Its square is the deviation of `rough`, a mean square of speed that no row
  /// shows. Source: archive. 2026-11-21
  double rough_speed_share = 0.05;
  /// [deviations] Where `rough` starts. Source: archive. 2026-11-21
  double rough_start_deviations = 0.04;
  /// [lengths of the bristle] Deviation of where the bristle begins. Source: reasoning; within one length.
  /// 2026-11-21
  double start_bristle_lengths = 0.7;
};

/// Which rows count, by how much, and when an axis slides.
struct RowsTuning {
  /// [s] At the beginning that do not count. Source: the observer of 35 Hz has forgotten where it began.
  /// 2026-11-21
  double settling_s = 0.3;
  /// [s] Deviation of the Gaussian that gives speed from position: half power at 45 Hz. Source: archive.
  /// 2026-11-21
  double kinematic_smoothing_s = 3e-3;
  /// [of that deviation] Of the one that gives acceleration from speed. Source: archive. 2026-11-21
  double acceleration_smoothing_share = 0.7;
  /// [s] Deviation of the Gaussian over the temperature. Source: reasoning. 2026-11-21
  double temperature_smoothing_s = 0.25;
  /// [share of the Coulomb level] Friction beyond it follows the motion. Source: archive. 2026-11-22
  double follows_motion_share = 0.8;
  /// [counts of the encoder per row] A reading that is repeated at a higher speed is stale. Source:
  /// reasoning. 2026-11-21
  double stale_counts_per_row = 4.0;
  /// [rows] Of either side, with which an outlier is compared. Source: reasoning; 0.15 s at 1 kHz. 2026-11-21
  std::size_t outlier_reach_rows = 150;
  /// [deviations of the whole log] Below, a row is no outlier. Source: archive. 2026-11-21
  double outlier_deviations = 10.0;
  /// [deviations of its neighbourhood] The same. Source: archive. 2026-11-21
  double outlier_near_deviations = 15.0;
  /// [counts of the encoder] In addition to both. Source: reasoning. 2026-11-21
  double outlier_counts = 6.0;
  /// [share of the outlier] Where the row before or the third after has more, it is a shock, which goes on.
  /// Source: archive. 2026-11-21
  double shock_share = 0.3;
  /// [rows] Over which the slow part of the noise is averaged. Source: archive. 2026-11-21
  std::size_t slow_rows = 20;
  /// [rows] Of either side of the short, the longer and the slow window of the noise's level. Source:
  /// archive. 2026-11-21
  std::size_t short_window_rows = 15, long_window_rows = 150, slow_window_rows = 400;
  /// [mean squares of white noise] That the windows reach by chance: rows that stand out beyond count less.
  /// Source: archive. 2026-11-21
  double short_by_chance = 2.0, long_by_chance = 1.25, slow_by_chance = 2.0;
  /// [counts of the scale per row] A scale at rest counts at least as much. Source: reasoning. 2026-11-21
  double least_counts_per_row = 1e-3;
};

/// Observer, noise filter and whitening.
struct NoiseTuning {
  /// [Hz] Of the observer that corrects the model. Source: archive. 2026-11-21
  double observer_bandwidth_Hz = 35.0;
  /// [rows] At the beginning of a segment that let the filter's variance settle. Source: archive. 2026-11-21
  std::size_t settling_rows = 150;
  /// [segments] That the ratio of the noises is estimated from. Source: time. 2026-11-21
  std::size_t segments = 12;
  /// [rows] Of such a segment, at least. Source: time. 2026-11-21
  std::size_t segment_rows = 1200;
  /// [segments] The log has this many, where they are longer. Source: time. 2026-11-21
  std::size_t segments_of_log = 60;
  /// [rows] Of a segment of the spectrum. Source: reasoning; 0.25 Hz at 1 kHz. 2026-11-21
  std::size_t spectrum_rows = 4096;
  /// [taps] Of the autoregressive filter. Source: archive. 2026-11-21
  std::size_t whitener_order = 48;
  /// [bins] Of either side, over which the spectrum is smoothed. Source: archive. 2026-11-21
  int smooth_bins = 8;
  /// [bins] Of either side, over which the median takes out lines. Source: archive. 2026-11-21
  std::size_t line_bins = 12;
  /// [cosines] Over the stroke, that the scale's noise is learnt without. Source: as many as pitch_error has.
  /// 2026-11-22
  static constexpr int scale_cosines = 8;
};

/// The part of a log that stands for it where a fit looks for its basin.
struct ExcerptTuning {
  /// [share of the log] That counts. Source: time. 2026-11-22
  double share = 0.25;
  /// [s] Of each segment, at its beginning, that do not count: observer and bristle forget where they began.
  /// Source: reasoning. 2026-11-22
  double settling_s = 0.2;
  /// [s] Of each segment, the settling included. Source: time. 2026-11-22
  double segment_s = 0.8;
  /// [segments] Fewer are no excerpt. Source: reasoning. 2026-11-22
  std::size_t fewest = 20;
  /// [lengths of the bristle] Of travel while a segment settles. Source: reasoning. 2026-11-22
  double settling_lengths = 4.0;
};

/// When a fit goes on, and when it begins once more.
struct FitTuning {
  /// [steps and chi^2] To see in which basin a point lies. Source: time. 2026-11-22
  FitEffort to_the_basin = {.most_steps = 12, .most_refreshes = 4, .close_enough = 1.0, .covariance = false};
  /// [chi^2 per term] Prior from which the stated numbers would have to be off as they hardly ever are.
  /// Source: reasoning. 2026-11-22
  double hardly_ever = 2.0;
  /// [stated deviations] A number that is further off goes back to where it is stated. Source: reasoning.
  /// 2026-11-22
  double far_off_deviations = 2.0;
  /// [chi^2] By which the other basin has to be lower on the excerpt. Source: reasoning. 2026-11-22
  double lower = 2.0;
  /// [chi^2] A step that promises less is not worth smaller ones. Source: time. 2026-11-21
  double worth_while = 3.0;
  /// [share of the promise] Small steps that keep less lead nowhere. Source: archive. 2026-11-21
  double kept_share = 0.1;
  /// [share of the promise] Where a step keeps less, sensitivities are renewed. Source: time. 2026-11-21
  double stale_share = 0.6;
};

/// The bootstrap by strokes.
struct BootstrapTuning {
  /// [s] Of a stroke, at least. Source: reasoning. 2026-11-21
  double shortest_s = 0.25;
  /// [blocks] Of the log, at least: longer strokes are cut. Source: archive. 2026-11-21
  std::size_t fewest_blocks = 40;
  /// [share of the travel] What comes back less far is dither and no turn. Source: reasoning. 2026-11-21
  double turn_share = 1e-4;
  /// [counts of the encoder] The same. Source: reasoning. 2026-11-21
  double turn_counts = 4.0;
  /// [factor] No stroke's gradient is made larger by more, for what the fit took of it. Source: archive.
  /// 2026-11-21
  double most_taken = 5.0;
};

inline constexpr PriorTuning kPriors;
inline constexpr RowsTuning kRows;
inline constexpr NoiseTuning kNoise;
inline constexpr ExcerptTuning kExcerpts;
inline constexpr FitTuning kFits;
inline constexpr BootstrapTuning kBootstrap;

}  // namespace contour::diagnosis
