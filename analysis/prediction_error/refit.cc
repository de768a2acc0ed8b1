#include "analysis/prediction_error/refit.h"

#include <Eigen/Core>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "analysis/diagnosis/tuning/prediction_tuning.h"
#include "analysis/prediction_error/products.h"

namespace contour::diagnosis {
namespace {

using Column = Eigen::Map<const Eigen::VectorXd>;

Column ColumnOf(const std::vector<double>& v) { return {v.data(), static_cast<Eigen::Index>(v.size())}; }

/// Of a residual that is new.
void TakeCost(const Problem& problem, Fit& fit) {
  fit.prior = PriorOf(problem, fit.point);
  fit.cost = ColumnOf(fit.residual).squaredNorm() + fit.prior;
}

/// Sensitivities, and the residual in a lane that may be empty otherwise.
void RewhitenTogether(const Problem& problem, Fit& fit, bool residual) {
  const auto size = static_cast<std::size_t>(fit.raw_jacobian.rows());
  std::vector<std::span<const double>> in;
  std::vector<std::span<double>> out;
  for (Eigen::Index i = 0; i < fit.raw_jacobian.cols(); ++i) {
    in.emplace_back(fit.raw_jacobian.col(i).data(), size);
    out.emplace_back(fit.jacobian.col(i).data(), size);
  }
  if (residual) {
    in.emplace_back(fit.raw);
    out.emplace_back(fit.residual);
  }
  problem.WhitenInto(in, out);
  AddProducts(fit.jacobian, 0, fit.normal);
}

}  // namespace

bool FitFromStated(const Problem& problem, Fit& fit, const FitEffort& effort, double worth) {
  if (Plausible(problem, fit.point)) return false;
  Point back = fit.point;
  for (std::size_t i = 0; i < back.base.size(); ++i) {
    const BaseTerm& t = problem.terms[i];
    if (!t.nuisance && std::fabs(back.base[i]) > kFits.far_off_deviations * t.sigma) back.base[i] = 0.0;
  }
  if (!problem.excerpt.empty()) {
    // Where it leads is seen on a part of the log, from both places, as its lowest points are not the log's.
    const Fit here = FitPoint(problem, fit.point, kFits.to_the_basin, Extent::kExcerpt);
    Fit there = FitPoint(problem, std::move(back), kFits.to_the_basin, Extent::kExcerpt);
    if (there.cost > here.cost - kFits.lower || fit.cost + there.cost - here.cost > worth) return false;
    back = std::move(there.point);
  }
  FitEffort below = effort;
  below.hopeless_above = fit.cost;
  Fit other = FitPoint(problem, std::move(back), below);
  if (!(other.cost < fit.cost)) return false;
  fit = std::move(other);
  return true;
}

double CostAt(const Problem& problem, const Point& point, Extent extent) {
  return ColumnOf(problem.Residuals(std::span(&point, 1), extent)[0]).squaredNorm() + PriorOf(problem, point);
}

void RewhitenResidual(const Problem& problem, Fit& fit) {
  const std::span<const double> in(fit.raw);
  const std::span<double> out(fit.residual);
  problem.WhitenInto(std::span(&in, 1), std::span(&out, 1));
  TakeCost(problem, fit);
}

void RewhitenSensitivities(const Problem& problem, Fit& fit) { RewhitenTogether(problem, fit, false); }

void Rewhiten(const Problem& problem, Fit& fit) {
  RewhitenTogether(problem, fit, true);
  TakeCost(problem, fit);
}

Fit FitFrom(const Problem& problem, Fit fit, const FitEffort& effort) {
  Rewhiten(problem, fit);
  return FitOn(problem, std::move(fit), effort);
}

}  // namespace contour::diagnosis
