#include "analysis/prediction_error/common_factor.h"

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace contour::diagnosis {
namespace {

bool IsTorqueConstant(const BaseTerm& t) { return t.name == "torque_constant"; }

bool IsForce(const BaseTerm& t) {
  return !t.nuisance && !t.additive && t.name != "vs" && !IsTorqueConstant(t);
}

bool StatesForces(const AxisModel& m) { return m.motor_force || m.load_force || m.offset != 0.0; }

}  // namespace

CommonFactor FindCommonFactor(const Problem& problem, const Point& point) {
  double sum = 0.0, weight = 0.0;
  CommonFactor out;
  for (std::size_t i = 0; i < point.base.size(); ++i) {
    const BaseTerm& t = problem.terms[i];
    if (IsTorqueConstant(t)) {
      out.log_ratio = point.base[i];
      out.drop = std::pow(point.base[i] / t.sigma, 2);
    }
    if (!IsForce(t)) continue;
    const double w = std::pow(t.sigma, -2);
    sum += w * point.base[i];
    weight += w;
  }
  out.log_ratio -= sum / weight;
  out.drop += sum * sum / weight;
  out.sigma = std::sqrt(1.0 / weight);
  return out;
}

void TakeOver(const Problem& problem, double log_ratio, Point& point) {
  double own = 0.0;
  for (std::size_t i = 0; i < point.base.size(); ++i)
    if (IsTorqueConstant(problem.terms[i])) own += std::exchange(point.base[i], 0.0);
  for (std::size_t i = 0; i < point.base.size(); ++i)
    if (IsForce(problem.terms[i])) point.base[i] += log_ratio - own;
}

void MakeConsistent(const Problem& problem, const Point& point, Eigen::MatrixXd& jacobian) {
  if (StatesForces(problem.nominal)) return;
  Eigen::VectorXd all = Eigen::VectorXd::Zero(jacobian.rows());
  Eigen::Index column = 0;
  Eigen::Index term = -1;
  for (const BaseTerm& t : problem.terms) {
    if (IsTorqueConstant(t)) term = column;
    if (IsForce(t)) all -= jacobian.col(column);
    ++column;
  }
  std::vector<std::pair<Eigen::Index, double>> factors;
  for (std::size_t e = 0; e < point.effects.size(); ++e) {
    const Effect& effect = *point.effects[e];
    for (std::size_t i = 0; i < point.amplitudes[e].size(); ++i, ++column) {
      const double a = point.amplitudes[e][i];
      if (!effect.force.empty() && effect.force[i] != 0 && a != 0.0)
        all -= effect.force[i] * a * jacobian.col(column);
      if (effect.common_factor) factors.emplace_back(column, 1.0 + a);
    }
  }
  if (term >= 0) jacobian.col(term) = all;
  for (const auto& [at, factor] : factors) jacobian.col(at) = all / factor;
}

}  // namespace contour::diagnosis
