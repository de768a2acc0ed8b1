#pragma once

#include <Eigen/Core>
#include <vector>

#include "analysis/diagnosis/tuning/fit_effort.h"
#include "analysis/prediction_error/problem.h"

namespace contour::diagnosis {

/// A maximum a posteriori point and the local picture there.
struct Fit {
  Point point;
  double cost = 0.0;  ///< |r|^2 + prior
  double prior = 0.0;
  std::vector<double> raw, residual;       ///< as Problem::Raw gives it; white
  Eigen::MatrixXd raw_jacobian, jacobian;  ///< of the same; base terms, then amplitudes
  Eigen::MatrixXd normal;                  ///< J' J of the white one, priors not included
  Eigen::MatrixXd covariance;              ///< of the parameters, noise of unit variance
  double promised = 0.0;  ///< what one more step would take off, as far as the last one kept it
  bool converged = false;
};

/// Where a fit begins.
struct InitialGuess {
  Point point;
  FitEffort effort;
  /// Of the same noise and rows: its sensitivities serve for the parameters that it has, first ones first;
  /// its residual too, where it has all of them. Columns are taken against that residual, so it has to be the
  /// one of this noise (RewhitenResidual).
  const Fit* known = nullptr;
  /// The same, of all its parameters, and given up for this fit: two of them at a time would take memory.
  Fit* continued = nullptr;
  /// Whose weights count, where not all fits see the same rows: the same log, model and noise otherwise.
  const Problem* seen = nullptr;
};

/// Gauss-Newton with the sensitivities kept while they serve. Noise is the problem's, held. All fits go step
/// by step together, so that their runs share the lanes. On an excerpt of the log: what is known of it is of
/// the excerpt, too.
std::vector<Fit> FitPoints(const Problem& problem, std::vector<InitialGuess> guesses,
                           Extent extent = Extent::kWhole);
Fit FitPoint(const Problem& problem, Point start, const FitEffort& effort = {},
             Extent extent = Extent::kWhole);
/// The same from where a fit stands.
Fit FitOn(const Problem& problem, Fit fit, const FitEffort& effort);

/// What its deviations from the stated numbers add to the cost of a point.
double PriorOf(const Problem& problem, const Point& point);

/// Whether the stated numbers are off by no more than they may well be.
bool Plausible(const Problem& problem, const Point& point);

std::size_t ParameterCount(const Point& point);

/// Base terms first; amplitudes stay inside their effects' bounds.
Point Moved(Point point, const Eigen::VectorXd& by);

}  // namespace contour::diagnosis
