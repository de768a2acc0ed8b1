#include "analysis/diagnosis/screening/stated_deviation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "analysis/diagnosis/screening/overdispersion.h"
#include "analysis/diagnosis/screening/score.h"
#include "analysis/prediction_error/products.h"

namespace contour::diagnosis {
namespace {

/// A relative uncertainty is of the number that is stated, or of the logarithm of the number: far below, the
/// first is the smaller deviation, far above the second. Only what neither of them explains is off.
double Relative(double log_ratio) { return log_ratio < 0.0 ? std::expm1(log_ratio) : log_ratio; }

}  // namespace

double StatedDeviation(const Problem& problem, const Fit& fit) {
  const std::vector<std::size_t> terms = FreedTerms(problem, fit.point.effects.back()->kind);
  const std::vector<double>& amplitudes = fit.point.amplitudes.back();
  const std::size_t count = std::min(terms.size(), amplitudes.size());
  const auto n = static_cast<Eigen::Index>(count);
  const Eigen::Index parameters = fit.covariance.rows();
  const Eigen::Index first = parameters - static_cast<Eigen::Index>(amplitudes.size());
  // The base's own term and the amplitude on top of it: their sum has no prior.
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(parameters, n);
  Eigen::VectorXd off(n), stated(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const BaseTerm& term = problem.terms[terms[static_cast<std::size_t>(i)]];
    const auto at = static_cast<Eigen::Index>(terms[static_cast<std::size_t>(i)]);
    sums(at, i) = sums(first + i, i) = 1.0;
    const double x = fit.point.base[static_cast<std::size_t>(at)] + amplitudes[static_cast<std::size_t>(i)];
    off(i) = term.additive ? x : Relative(x);
    stated(i) = term.sigma * term.sigma;
  }
  const Eigen::MatrixXd influence = fit.covariance * sums;
  const Eigen::MatrixXd blocks =
      MakeProductsInBlocks({}, ColumnsOf(fit.jacobian), fit.residual.data(), problem.rows(),
                           problem.data_size(), static_cast<std::size_t>(kBlocks))
          .with_r;
  // What the log leaves open in white noise; the rest of it is other priors', which do not scatter.
  const Eigen::MatrixXd of_log = influence.transpose() * fit.normal * influence;
  const double over =
      Overdispersion(influence.transpose() * blocks, of_log.ldlt().solve(Eigen::MatrixXd::Identity(n, n)));
  Eigen::MatrixXd variance = sums.transpose() * influence + (over - 1.0) * of_log;
  variance.diagonal() += stated;
  return off.dot(variance.ldlt().solve(off));
}

}  // namespace contour::diagnosis
