#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/axis_model/stated_axis.h"
#include "analysis/diagnosis/tuning/decision_tuning.h"
#include "analysis/recording/data_quality.h"

// What diagnosis says. The JSON file, the text and the report are written from this and nothing else.
namespace contour::diagnosis {

enum class Verdict { kCauseFound, kAmbiguous, kNothingFound, kUnexplained, kInsufficientData };

struct Interval {
  double value = 0.0;
  double low = 0.0, high = 0.0;  ///< 95 %
};

/// A shape over the stroke, an angle or time, for tables in the extended model and for pictures.
struct ShapeTable {
  std::string abscissa;  ///< position_mm, angle_rad, time_s, temperature_degC
  std::string ordinate;  ///< torque_Nm, friction_rel, error_um, ...
  std::vector<double> x, y, sigma;
};

struct Cause {
  std::string kind;
  std::map<std::string, Interval> parameters;  ///< by the names of the catalogue, physical units
  double log_evidence_gain = 0.0;              ///< nats
  double heldout_rms_before = 0.0, heldout_rms_after = 0.0;
  double heldout_gain = 0.0;                               ///< 1 - after / before
  double heldout_gain_low = 0.0, heldout_gain_high = 0.0;  ///< 95 %
  std::string unit;
  std::vector<std::string> indistinguishable_from;
  std::string deciding_experiment;  ///< for people
  std::string deciding_program;     ///< YAML of a program for `contour run`; empty when none decides
  std::vector<ShapeTable> shapes;
  /// Most of what there is to explain is something else (Verdict::kUnexplained): no name of the deviation.
  bool part_of_it = false;
  bool no_size = false;  ///< it ended at a bound, and the log says nothing of its size
};

/// One bar of the evidence chart.
struct Candidate {
  std::string kind;
  double score = 0.0;     ///< nats x 2, after penalties, first pass
  double refitted = 0.0;  ///< after a joint refit; NaN when not refitted
  bool accepted = false;
};

struct BaseParameter {
  std::string name;
  double stated = 0.0, fitted = 0.0, sigma = 0.0;  ///< sigma: 1 standard deviation of the fit
};

/// How far a model is off, root mean squares in units of q, on the log that it was fitted on and on parts of
/// it that it was not: every other part, by a model from the ones between.
struct ForecastError {
  std::string model;  ///< stated, refitted, extended
  double one_step_used = 0.0, one_step_unseen = 0.0;
  double free_run_used = 0.0, free_run_unseen = 0.0;
};

/// Signals for pictures, decimated by whoever fills them as little as needed.
struct Traces {
  std::vector<double> time_s, position, velocity, acceleration;
  std::vector<double> measured, simulated_before,
      simulated_after;                                  ///< u that the motion needs, and the models'
  std::vector<double> residual_before, residual_after;  ///< u
  std::vector<double> scale_before, scale_after;        ///< m; empty without a scale
  std::vector<double> temperature_degC;                 ///< empty without one
};

struct BlockGain {
  double start_s = 0.0, end_s = 0.0, gain = 0.0;
};

struct Diagnosis {
  Verdict verdict = Verdict::kInsufficientData;
  std::vector<Cause> causes;
  std::vector<std::string> not_excited;
  std::map<std::string, std::map<std::string, double>> smallest_detectable;
  double false_alarm_rate = kRounds.false_alarm_rate;
  double threshold = 0.0;  ///< score that the calibrated threshold asked for
  int bootstrap_runs = 0;  ///< that the intervals come from; 0: from the fit's covariance
  DataQuality data_quality;
  std::vector<Candidate> candidates;
  std::vector<BaseParameter> base;
  /// The stated model with its numbers as the log has them, fitted with the causes found, and their
  /// deviations.
  std::optional<StatedAxis> fitted;
  std::vector<Cause> in_model;  ///< causes that were fitted with it, whether the verdict names them or not
  std::vector<ForecastError> model_errors;  ///< none where the log is too short
  double free_run_s = 0.0;                  ///< length of the free runs
  std::vector<BlockGain> blocks;
  Traces traces;
  std::vector<std::string> notes;  ///< in plain words: what limits the answer
};

}  // namespace contour::diagnosis
