#include "analysis/rough_fit/two_starts.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "analysis/prediction_error/refit.h"

namespace contour::diagnosis {
namespace {

constexpr FitEffort kThorough = {.most_steps = 40, .most_refreshes = 12, .close_enough = 0.1};

Point Stated(const Problem& problem) {
  Point out;
  for (const BaseTerm& t : problem.terms) out.base.push_back(t.start);
  return out;
}

Point OfLeastSquares(const Problem& problem, const RoughFit& rough) {
  Point out = Stated(problem);
  const StatedAxis& stated = problem.stated;
  const StatedFriction& f = stated.friction;
  const auto put = [](double value, double was, double& x) {
    if (value > 0.0 && was > 0.0) x = std::log(value / was);
  };
  for (std::size_t i = 0; i < out.base.size(); ++i) {
    const std::string_view name = problem.terms[i].name;
    if (name == "inertia" || name == "load_inertia")
      put(rough.inertia, stated.motor_inertia + stated.load_inertia, out.base[i]);
    if (name == "Fc" || name == "Fs") put(rough.coulomb, 0.5 * (f.Fc_plus + f.Fc_minus), out.base[i]);
    if (name == "s2") put(rough.viscous, f.s2, out.base[i]);
  }
  return out;
}

struct End {
  Fit fit;
  LearntNoise noise;
};

End FitFrom(Problem& problem, const Point& start) {
  problem.LearnNoise(start);
  Fit fit = FitPoint(problem, start, kThorough);
  for (int round = 0; round < 2; ++round) {
    problem.LearnNoise(fit.point);
    fit = FitPoint(problem, fit.point, kThorough);
  }
  return {std::move(fit), problem.Learnt()};
}

/// Under either's noise.
bool LowerThan(Problem& problem, const End& one, const End& other) {
  for (const End* of : {&one, &other}) {
    problem.Take(of->noise);
    Fit a = one.fit, b = other.fit;
    RewhitenResidual(problem, a);
    RewhitenResidual(problem, b);
    if (!(a.cost < b.cost)) return false;
  }
  return true;
}

}  // namespace

bool SaysEnough(const RoughFit& rough) {
  return rough.why_not.empty() && rough.unexplained <= kMostUnexplained && rough.inertia > 0.0 &&
         rough.coulomb > 0.0;
}

std::vector<double> DeviationsByParts(const Problem& problem, const Fit& fit) {
  const std::size_t n = problem.rows(), terms = problem.terms.size();
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(fit.covariance.rows(), fit.covariance.cols());
  const Eigen::Map<const Eigen::VectorXd> residual(fit.residual.data(),
                                                   static_cast<Eigen::Index>(fit.residual.size()));
  for (std::size_t part = 0; part < kPartsOfLog; ++part) {
    const auto from = static_cast<Eigen::Index>(n * part / kPartsOfLog);
    const auto rows = static_cast<Eigen::Index>(n * (part + 1) / kPartsOfLog) - from;
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(sums.rows());
    for (Eigen::Index channel = 0; channel < residual.size(); channel += static_cast<Eigen::Index>(n))
      sum +=
          fit.jacobian.middleRows(channel + from, rows).transpose() * residual.segment(channel + from, rows);
    sums += sum * sum.transpose();
  }
  const double of_freedom = static_cast<double>(kPartsOfLog) / (static_cast<double>(kPartsOfLog) - 1.0);
  const Eigen::MatrixXd covariance = of_freedom * fit.covariance * sums * fit.covariance;
  std::vector<double> out;
  for (std::size_t i = 0; i < terms; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    out.push_back(std::sqrt(std::max({0.0, covariance(at, at), fit.covariance(at, at)})));
  }
  return out;
}

TwoStarts FitFromTwoStarts(Problem& problem, const RoughFit& rough) {
  const Point stated = Stated(problem);
  if (!SaysEnough(rough)) {
    problem.LearnOutliers(stated);
    End only = FitFrom(problem, stated);
    const std::vector<double> none(stated.base.size(), 0.0);
    return {std::move(only.fit), none, none};
  }
  const Point other = OfLeastSquares(problem, rough);
  problem.LearnOutliers(other);
  End here = FitFrom(problem, other), there = FitFrom(problem, stated);
  if (LowerThan(problem, there, here)) std::swap(here, there);
  problem.Take(here.noise);
  TwoStarts out{std::move(here.fit), {}, {}};
  out.sigma = DeviationsByParts(problem, out.fit);
  const std::vector<double> theirs = DeviationsByParts(problem, there.fit);
  for (std::size_t i = 0; i < theirs.size(); ++i) {
    const double apart = std::fabs(out.fit.point.base[i] - there.fit.point.base[i]);
    out.apart.push_back(apart > kDisagree * std::hypot(out.sigma[i], theirs[i]) ? apart : 0.0);
  }
  return out;
}

}  // namespace contour::diagnosis
