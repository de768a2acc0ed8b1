#pragma once

#include <array>
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
  /// [share of a column's square] A column of which the base leaves less is nearly the base's own. Source:
  /// reasoning. 2026-11-21
  double nearly_base_share = 1e-3;
  /// [of the prior's cost] What a column that is nearly the base's can win frees the base from its priors,
  /// and no more. Source: archive. 2026-11-21
  double nearly_base_prior_factor = 1.5;
  /// [chi^2] The same, where the priors cost nothing. Source: archive. 2026-11-21
  double nearly_base_score = 5.0;
  /// [share of the prior's variance] What the log leaves of a freed term is at most taken to be this, so that
  /// taking the prior away stays finite. Source: reasoning. 2026-11-21
  double most_left_of_prior_share = 0.9;
  /// [columns] Scored at a time. Source: time. 2026-11-21
  std::size_t columns_at_once = 24;
  /// [orders, or Hz] Waves of one kind that are further apart are two. Source: reasoning; whole orders are 1
  /// apart. 2026-11-22
  double waves_apart = 0.9;

  /// [Hz] A coupling above is one that every screw has. Source: archive; the emulated ball screws have their
  /// mode near 1 kHz. 2026-11-21
  double no_fault_Hz = 700.0;
  /// [of the effect's nominal size] Sizes in which every grid point is tried. Source: reasoning; a decade,
  /// each within a factor of two or so of the next. 2026-11-21
  std::array<double, 3> grid_sizes = {0.15, 0.5, 1.5};
  /// [of the score test's size] Small ones are tried at what the score test has and above, where it falls
  /// short. Source: reasoning. 2026-11-21
  std::array<double, 2> small_sizes = {1.0, 3.0};
  /// [grid points] Of a kind, that are tried in small sizes. Source: time. 2026-11-21
  std::size_t small_grid_points = 4;
  /// [share of the amplitude] Step of a derivative at full size; the score test's step is as large as what it
  /// looks for. Source: reasoning. 2026-11-21
  double fine_step_share = 0.05;
  /// [chi^2] Drop from which an excerpt ranks grid points: a difference of two costs scatters by twice its
  /// root over the excerpt's share of the log, so that the best one is hardly ever behind eight others.
  /// Source: reasoning. 2026-11-22
  double ranks_drop = 100.0;

  /// [steps and chi^2] Base model, on the excerpt, before the noise is known. Source: time. 2026-11-22
  FitEffort base_ahead = {.most_steps = 4, .most_refreshes = 2, .close_enough = 3.0, .covariance = false};
  /// [steps and chi^2] Base model. Source: archive. 2026-11-22
  FitEffort base = {.most_steps = 12, .most_refreshes = 4, .close_enough = 0.1};
};

/// Orders and frequencies by matched filters.
struct ScanTuning {
  /// [rows] That a pulse's response is followed for. Source: at 1 kHz a quarter of a second, in which the
  /// observer of 35 Hz has forgotten it. 2026-11-21
  std::size_t response_rows = 256;
  /// [rows] Of the transform that gives the response by frequency. Source: reasoning; 0.25 Hz at 1 kHz.
  /// 2026-11-21
  std::size_t transfer_rows = 4096;
  /// [share of the fastest speed] Slower motion is no slide in which to look for the response. Source:
  /// reasoning. 2026-11-21
  double slow_share = 0.02;
  /// [samples per period of the highest order] Of the gradient over the angle. Source: reasoning; twice what
  /// Nyquist asks for. 2026-11-21
  double samples_per_period = 4.0;
  /// [bins] Of the histogram of speeds. Source: reasoning. 2026-11-21
  std::size_t speed_bins = 200;
  /// [ratio of orders] The information is computed anew where the order has grown by as much. Source: time.
  /// 2026-11-21
  double renewed_at_ratio = 1.01;
  /// [orders] The same of low orders. Source: time. 2026-11-21
  double renewed_at_orders = 0.02;

  /// [turns of the motor] Of travel, from which waves of the angle are looked for: fewer are one shape along
  /// the stroke. Source: reasoning. 2026-11-21
  double fewest_turns = 1.5;
  /// [turns of the motor] Of travel, from which friction is looked for between whole orders. Source:
  /// reasoning. 2026-11-21
  double fewest_turns_between = 5.0;
  /// [turns of the motor] Of travel, from which errors of the reading are looked for. Source: reasoning;
  /// lines of an encoder are many a turn. 2026-11-21
  double fewest_turns_of_lines = 0.05;
  /// [periods over the travel] Fewer of friction are friction along the stroke, whose cosines cover them.
  /// Source: the cosines of position_friction. 2026-11-21
  double fewest_friction_periods = 4.5;
  /// [periods over the travel] An order is between whole ones where it is further from them. Source:
  /// reasoning; three quarters of what the travel resolves. 2026-11-21
  double off_whole_periods = 0.75;
  /// [orders] The highest of friction. Source: archive. 2026-11-21
  double highest_friction_order = 40.0;
  /// [orders] The highest of friction between whole orders. Source: archive. 2026-11-21
  double highest_order_between = 20.0;
  /// [orders] The highest of the motor's torque. Source: archive. 2026-11-21
  double highest_torque_order = 144.0;
  /// [orders] The lowest and the highest of an encoder's lines. Source: archive. 2026-11-21
  double lowest_line_order = 8.0, highest_line_order = 4096.0;
  /// [orders] Whole orders that are proposed of one scan are further apart. Source: reasoning; half of what
  /// whole orders are apart. 2026-11-21
  double whole_orders_apart = 0.5;
  /// [of a scan's grid] The best of a scan that are proposed; of a gain of the angle one. Source: time.
  /// 2026-11-21
  std::size_t proposed = 2;
  /// [periods over the log] Fewer of a force of time are drift. Source: reasoning. 2026-11-21
  double fewest_periods_of_time = 6.0;
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
  /// [passes] Of the fit, whose weights follow the variance. Source: archive. 2026-11-21
  int passes = 6;
  /// [of the median variance] A block is expected to have at least this: no weight without bound. Source:
  /// reasoning. 2026-11-21
  double least_expected_share = 0.2;
  /// [of the expected variance] A block with a shock in it counts as far as it may be chance. Source:
  /// reasoning; chance hardly ever makes twice the variance of 50 rows. 2026-11-21
  double most_seen_factor = 3.0;
  /// [blocks] That the test needs. Source: reasoning; ten per number fitted. 2026-11-21
  std::size_t fewest_blocks = 100;
  /// [share of the largest squared speed] The slowest block must be below, half the speed, for the test to
  /// see a slope. Source: reasoning. 2026-11-21
  double slow_enough_share = 0.25;
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
