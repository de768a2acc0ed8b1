#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "analysis/identification/simulation.h"
#include "analysis/identification/table_axis.h"

namespace contour::identify {

/// A number of the model that the fit may move.
struct FreeParameter {
  std::string key;            ///< of the model's uncertainty, or a name of its own
  double* (*at)(TableAxis&);  ///< where it is; null: see index
  bool logarithmic = true;    ///< moves by a factor
  double prior = 1.0;         ///< standard deviation about the start, in the parameter's own step
  double step = 1e-3;         ///< for derivatives
};

struct FitOptions {
  bool screw = true;      ///< motor and table are free, damping, delay and lag too; else only the whole mass
  bool stiffness = true;  ///< of the screw is free
  double stiffness_prior = 1.0;   ///< relative: how well the start is known
  std::vector<std::string> only;  ///< keys that move; empty: all
  std::vector<std::string> hold;  ///< keys that do not
  int rounds = 3;                 ///< weights and whitening are worked out anew in each
  bool refine = false;            ///< the start is good: whitened from the first round
  int iterations = 12;            ///< of a round, at most
  double block_s = 1.0;           ///< for weights and for the spread
  bool spread = true;             ///< standard deviations are wanted
  int threads = 1;
  std::function<void(double share)> progress;
};

struct FittedParameter {
  std::string key;
  double value = 0.0;
  double sigma = 0.0;  ///< relative for logarithmic ones, else absolute
  bool relative = true;
  /// How far slow and quick forces disagree about it, in standard deviations of that (Disagreement).
  double halves_apart = 0.0;
  double halves_distance = 0.0;  ///< the same, in the unit of `sigma`
};

/// Standard deviation of a parameter; 0: it was not moved.
double Sigma(const std::vector<FittedParameter>& parameters, const std::string& key);

struct JointFit {
  TableAxis axis;
  std::vector<FittedParameter> parameters;
  Eigen::MatrixXd covariance;  ///< in steps of the parameters
  double error_rms_m = 0.0;    ///< of the prediction
  double error_rms_before_m = 0.0;
  double error_typical_m = 0.0;  ///< rms of the middle block of time
  double unsettled = 0.0;        ///< standard deviations to the least of the cost, of the worst parameter
  int evaluations = 0;
};

/// Fits the model to all records at once: least squares of whitened prediction errors, by Levenberg and
/// Marquardt with finite differences. Standard deviations come from the scatter of the gradient over blocks
/// of time of several lengths (a sandwich estimate), so they hold what the model leaves unexplained, not only
/// noise.
JointFit FitJointly(const TableAxis& start, const std::vector<Measured>& records, const FitOptions& options);

}  // namespace contour::identify
