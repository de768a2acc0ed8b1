#include "tools/diagnosis/score.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace contour::diagnosis {
namespace {

using Column = Eigen::Map<const Eigen::VectorXd>;

// Inner products of columns with the residual, per block of time.
void AddBlocks(const double* column, const double* residual, std::size_t rows, std::size_t size,
               Eigen::Ref<Eigen::RowVectorXd> out) {
  for (Eigen::Index b = 0; b < kBlocks; ++b) {
    const std::size_t from = rows * static_cast<std::size_t>(b) / kBlocks;
    const std::size_t to = rows * static_cast<std::size_t>(b + 1) / kBlocks;
    double sum = 0.0;
    for (std::size_t base = 0; base < size; base += rows)
      for (std::size_t k = base + from; k < base + to; ++k) sum += column[k] * residual[k];
    out(b) = sum;
  }
}

double Excess(const Eigen::MatrixXd& per_block, const Eigen::MatrixXd& covariance) {
  const double by_chance = (covariance * (per_block * per_block.transpose())).trace();
  return std::max(1.0, by_chance / static_cast<double>(per_block.rows()));
}

}  // namespace

bool InBase(const Problem& problem, const std::string& kind) {
  const auto has = [&](const char* name) {
    return std::any_of(problem.terms_.begin(), problem.terms_.end(),
                       [&](const BaseTerm& t) { return t.name == name; });
  };
  if (kind == "stribeck") return has("Fs");
  if (kind == "input_delay") return has("delay");
  if (kind == "current_lag") return has("lag");
  if (kind == "compliance") return has("stiffness");
  return kind == "torque_constant";
}

namespace {

bool IsForce(const BaseTerm& t) {
  return !t.nuisance && !t.additive && t.name != "vs" && t.name != "torque_constant";
}

}  // namespace

CommonFactor FindCommonFactor(const Problem& problem, const Point& point) {
  double sum = 0.0, weight = 0.0;
  for (std::size_t i = 0; i < point.base.size(); ++i) {
    const BaseTerm& t = problem.terms_[i];
    if (!IsForce(t)) continue;
    const double w = std::pow(t.sigma, -2);
    sum += w * point.base[i];
    weight += w;
  }
  return {-sum / weight, sum * sum / weight, std::sqrt(1.0 / weight)};
}

void ShiftForces(const Problem& problem, double log_ratio, Point& point) {
  for (std::size_t i = 0; i < point.base.size(); ++i)
    if (IsForce(problem.terms_[i])) point.base[i] += log_ratio;
}

double ExcessOfLast(const Problem& problem, const Fit& fit) {
  if (InBase(problem, fit.point.effects.back()->kind)) return 1.0;
  const auto n = static_cast<Eigen::Index>(fit.point.amplitudes.back().size());
  const Eigen::Index others = fit.jacobian.cols() - n;
  Eigen::MatrixXd blocks(fit.jacobian.cols(), kBlocks);
  for (Eigen::Index i = 0; i < fit.jacobian.cols(); ++i) {
    Eigen::RowVectorXd row(kBlocks);
    AddBlocks(fit.jacobian.col(i).data(), fit.residual.data(), problem.rows(), problem.data_size(), row);
    blocks.row(i) = row;
  }
  Eigen::MatrixXd normal = fit.jacobian.transpose() * fit.jacobian;
  for (std::size_t i = 0; i < fit.point.base.size(); ++i)
    normal(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) +=
        std::pow(problem.terms_[i].sigma, -2);
  const Eigen::MatrixXd onto =
      normal.topLeftCorner(others, others).ldlt().solve(normal.topRightCorner(others, n));
  const Eigen::MatrixXd information =
      normal.bottomRightCorner(n, n) - normal.topRightCorner(others, n).transpose() * onto;
  const Eigen::MatrixXd projected = blocks.bottomRows(n) - onto.transpose() * blocks.topRows(others);
  return Excess(projected, information.ldlt().solve(Eigen::MatrixXd::Identity(n, n)));
}

double Penalty(const Effect& effect) {
  return 3.0 * static_cast<double>(effect.steps.size()) + 2.0 * std::log(std::max(1.0, effect.grid));
}

std::vector<Scored> ScoreEffects(const Problem& problem, const Fit& fit, std::vector<SharedEffect> effects) {
  std::stable_partition(effects.begin(), effects.end(), [](const SharedEffect& e) { return e->signals; });
  const auto size = static_cast<Eigen::Index>(problem.data_size());
  const std::size_t rows = problem.rows();
  const Eigen::Index base = fit.jacobian.cols();
  Eigen::MatrixXd base_blocks(base, kBlocks);
  for (Eigen::Index i = 0; i < base; ++i) {
    Eigen::RowVectorXd row(kBlocks);
    AddBlocks(fit.jacobian.col(i).data(), fit.residual.data(), rows, problem.data_size(), row);
    base_blocks.row(i) = row;
  }
  std::vector<Scored> out;
  const Eigen::Map<const Eigen::VectorXd> residual(fit.residual.data(), size);
  // Some two dozen columns at a time bound the memory.
  for (std::size_t at = 0; at < effects.size();) {
    const bool signals = effects[at]->signals;
    std::size_t end = at, columns = 0;
    while (end < effects.size() && effects[end]->signals == signals &&
           (columns == 0 || columns + effects[end]->tested <= 24)) {
      columns += effects[end]->tested;
      ++end;
    }
    const std::span<const SharedEffect> some = std::span(effects).subspan(at, end - at);
    std::vector<std::vector<double>> responses;
    if (!signals) {
      std::vector<Point> points;
      for (const SharedEffect& e : some)
        for (std::size_t i = 0; i < e->tested; ++i) {
          Point p = fit.point;
          p.effects.push_back(e);
          p.amplitudes.emplace_back(e->steps.size(), 0.0);
          p.amplitudes.back()[i] += e->steps[i];
          points.push_back(std::move(p));
        }
      responses = problem.Residuals(points);
      std::size_t run = 0;
      for (const SharedEffect& e : some)
        for (std::size_t i = 0; i < e->tested; ++i, ++run)
          Eigen::Map<Eigen::VectorXd>(responses[run].data(), size) =
              (Column(responses[run].data(), size) - residual) / e->steps[i];
    } else {
      responses = problem.LinearResponses(fit.point, some);
    }
    std::size_t run = 0;
    for (; at < end; ++at) {
      const Effect& effect = *effects[at];
      Scored s;
      s.effect = effects[at];
      const auto n = static_cast<Eigen::Index>(effect.tested);
      Eigen::MatrixXd g(size, n);
      for (Eigen::Index i = 0; i < n; ++i) g.col(i) = Column(responses[run++].data(), size);
      const Eigen::MatrixXd cross = fit.jacobian.transpose() * g;
      const Eigen::MatrixXd onto = fit.covariance * cross;
      Eigen::MatrixXd information = g.transpose() * g - cross.transpose() * onto;
      const Eigen::VectorXd own = (g.transpose() * g).diagonal();
      s.per_block.resize(n, kBlocks);
      for (Eigen::Index i = 0; i < n; ++i) {
        Eigen::RowVectorXd row(kBlocks);
        AddBlocks(g.col(i).data(), fit.residual.data(), rows, problem.data_size(), row);
        s.per_block.row(i) = row;
      }
      s.per_block -= onto.transpose() * base_blocks;
      // Directions that the base explains already, to rounding, carry nothing.
      const bool nearly_base = n == 1 && information(0, 0) < 1e-3 * own(0);
      for (Eigen::Index i = 0; i < n; ++i) information(i, i) += 1e-6 * own(i) + 1e-300;
      // The gradient of the prior belongs to the base; at its optimum both parts cancel.
      const Eigen::VectorXd gradient = g.transpose() * residual;
      const Eigen::LDLT<Eigen::MatrixXd> solver(information);
      s.covariance = solver.solve(Eigen::MatrixXd::Identity(n, n));
      s.amplitude = -solver.solve(gradient);
      s.drop = -gradient.dot(s.amplitude);
      // What a base parameter does already, an effect can only free from its prior.
      s.excess = Excess(s.per_block, s.covariance);
      // What the base can nearly do itself frees it from its priors and no more.
      if (nearly_base) s.drop = std::min(s.drop, 1.5 * fit.prior + 5.0);
      if (InBase(problem, effect.kind)) {
        // What a base parameter does already, an effect can only free from its prior: the evidence is in the
        // prior and not in the blocks.
        s.drop = std::min(s.drop, 1.5 * fit.prior + 5.0);
        s.per_block.setZero();
        s.excess = 1.0;
        if (effect.kind == "torque_constant") {
          const CommonFactor common = FindCommonFactor(problem, fit.point);
          s.amplitude(0) = std::expm1(common.log_ratio);
          s.covariance(0, 0) = common.sigma * common.sigma;
          s.drop = common.drop;
        }
      }
      s.score = s.drop / s.excess - Penalty(effect);
      const Eigen::RowVectorXd blocks = -s.amplitude.transpose() * s.per_block;
      s.consistency = blocks.sum() / (blocks.norm() + 1e-300);
      out.push_back(std::move(s));
    }
  }
  return out;
}

}  // namespace contour::diagnosis
