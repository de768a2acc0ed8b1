#pragma once

#include <cstddef>

#include "analysis/diagnosis/tuning/fit_effort.h"

// How an entry is written: tests/architecture/diagnosis_thresholds.py reads these files.
namespace contour::diagnosis {

/// Scores, the fit of the nominal model, and grid points at full size.
struct ScreeningTuning {
  /// [blocks] Of the log, for sign flips and for drops that a fit has not seen: three fast strokes are
  /// several blocks, one slip out of stiction is one. Source: reasoning, on logs of 100 s. 2026-11-21
  int blocks = 60;
  /// [chi^2 per amplitude] Penalty: what a free amplitude wins by chance, and more. Source: reasoning; chance
  /// wins 1 on the average, and more than 3 in one of twelve cases. 2026-11-21
  double penalty_per_amplitude = 3.0;
  /// [ratio of variances] An effect that is there makes its own score scatter from block to block, too:
  /// beyond this, scatter says no more about chance. Source: archive. 2026-11-22
  double most_overdispersion = 3.0;
  /// [share] As good as nothing: what the base leaves of a column that is nearly its own, a gain of a further
  /// step against the best score. Source: reasoning. 2026-11-23
  double negligible_share = 1e-3;
  /// [share] Little of the whole: kinds that are promised less of the largest drop wait, what residual
  /// leakage does to a score test, what an element in presliding leaves on a friction-model mismatch, what a
  /// cause by its right name leaves; the log says at least as much about a freed term, so that taking its
  /// prior away stays finite. Source: archive; right names leave less than a hundredth. 2026-11-23
  double little_share = 0.1;
  /// [bins] Of what a residual may depend on: position, speed, travel since a reversal, angle, temperature;
  /// of a histogram of speeds. An order's information is computed anew where it has grown by one part in as
  /// many. Source: reasoning; orders of an angle up to half of it. 2026-11-23
  static constexpr int bins = 48;
  /// [share of the amplitude] Step of a derivative at full size; the score test's step is as large as what it
  /// looks for. Source: reasoning. 2026-11-21
  double fine_step_share = 0.05;
  /// [sizes] In which every grid point is tried, from the nominal one, each a quarter of the one before.
  /// Source: reasoning; within a factor of two of what is there. 2026-11-23
  int grid_sizes = 2;
};

/// Orders and frequencies by matched filters.
struct ScanTuning {
  /// [rows] That a pulse's response is followed for. Source: at 1 kHz an eighth of a second, in which the
  /// observer of 35 Hz has forgotten it. 2026-11-23
  std::size_t response_rows = 128;
  /// [periods] Over the travel, or the time, fewer are a shape along the stroke, or drift. Source: the
  /// cosines of position_friction. 2026-11-21
  double fewest_periods = 4.5;
  /// [orders] The highest of friction. Source: archive. 2026-11-21
  double highest_friction_order = 40.0;
  /// [orders] The highest of the motor's torque. Source: archive. 2026-11-21
  double highest_torque_order = 144.0;
  /// [orders] The lowest and the highest of an encoder's lines. Source: archive. 2026-11-21
  double lowest_line_order = 8.0, highest_line_order = 4096.0;
  /// [orders, or Hz] Waves of one kind that are further apart are two. Source: reasoning; whole orders are 1
  /// apart. 2026-11-22
  double waves_apart = 0.9;
  /// [of a scan's grid] The best of a scan that are proposed; of a gain of the angle one. Source: time.
  /// 2026-11-21
  std::size_t proposed = 2;
  /// [cycles per row] A force held over a row hardly moves anything near half the rate: nothing divided by
  /// nothing. Source: archive, with forces of known frequency. 2026-11-21
  double highest_per_row = 0.4;
};

/// Readings at uncertain instants.
struct JitterTuning {
  /// [parts of the log] Each may have a level of noise of its own. Source: archive. 2026-11-22
  static constexpr int parts = 8;
  /// [rows] Of a block whose variance is one datum. Source: at 1 kHz 50 ms, in which the speed hardly
  /// changes. 2026-11-21
  std::size_t block_rows = 50;
  /// [counts of the encoder per row] Slower, quantisation is no noise of constant variance. Source:
  /// reasoning. 2026-11-22
  double slowest_counts_per_row = 2.0;
};

/// Friction of a law that is not the model's.
struct MismatchTuning {
  /// [lengths of the bristle] Behind a reversal; further on any law calls it a slide. Source: Maxwell-slip
  /// elements of real axes break away within some ten lengths of the bristle that fits best. 2026-11-22
  double gross_sliding_lengths = 20.0;
  /// [stated deviations] Of the mean square `rough`: with friction of the law and a soft element it ends
  /// above zero, on Maxwell-slip friction well below. Source: archive, with LuGre and Maxwell-slip friction.
  /// 2026-11-22
  double below_zero_deviations = 0.5;
};

inline constexpr ScreeningTuning kScreening;
inline constexpr ScanTuning kScan;
inline constexpr JitterTuning kJitter;
inline constexpr MismatchTuning kMismatch;

}  // namespace contour::diagnosis
