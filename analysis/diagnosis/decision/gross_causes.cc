#include "analysis/diagnosis/decision/gross_causes.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/tuning/decision_tuning.h"

namespace contour::diagnosis {
namespace {

/// Rows in which the axis slides, as far apart as the smoothing makes them independent, and what acts there.
struct Sliding {
  std::vector<std::size_t> rows;
  Signal acting;
};

/// The command in the middle of the row in which it acts.
double Acting(const Problem& problem, const AxisModel& m, std::size_t k) {
  const double late = (m.delay_s + m.lag_s) / problem.log.period_s + 1.0 / 2.0;
  const double at = std::clamp(static_cast<double>(k) - late, 0.0, static_cast<double>(problem.rows() - 1));
  const auto i = static_cast<std::size_t>(at);
  const double next = problem.log.command[std::min(i + 1, problem.rows() - 1)];
  return problem.log.command[i] + (at - static_cast<double>(i)) * (next - problem.log.command[i]);
}

Sliding SlidingRows(const Problem& problem, const Fit& current) {
  const AxisModel m = problem.Build(current.point);
  const Signals& s = *problem.signals;
  const double sigma = kRows.kinematic_smoothing_s / problem.log.period_s;
  Signal acting(problem.rows());
  for (std::size_t k = 0; k < acting.size(); ++k) acting[k] = Acting(problem, m, k);
  Sliding out;
  out.acting = Smooth(acting, std::hypot(sigma, kRows.acceleration_smoothing_share * sigma));
  const auto apart = static_cast<std::size_t>(1.0 + 2.0 * sigma);
  for (std::size_t k = 0; k < problem.rows(); k += apart)
    if (problem.counted[k] != 0 && std::fabs(s.velocity[k]) > kScreening.little_share * s.max_speed)
      out.rows.push_back(k);
  return out;
}

/// What the motion needs, by the model of a sliding axis.
Eigen::VectorXd Needed(const AxisModel& m, const Signals& s, const std::vector<std::size_t>& rows) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(rows.size()));
  const auto at = [](const SharedSignal& signal, std::size_t k) { return signal ? (*signal)[k] : 0.0; };
  const StatedFriction& f = m.friction;
  const double inertia = m.motor_inertia + (m.two_inertia ? m.load_inertia : 0.0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t k = rows[i];
    const double v = s.velocity[k], sign = v > 0.0 ? 1.0 : -1.0;
    const double coulomb = v > 0.0 ? f.Fc_plus : f.Fc_minus, rest = v > 0.0 ? f.Fs_plus : f.Fs_minus;
    const double level = coulomb + (rest - coulomb) * std::exp(-std::pow(std::fabs(v) / f.vs, f.exponent));
    const double moved = (inertia + (k >= m.payload_row ? m.payload : 0.0)) * s.acceleration[k];
    const double held = (1.0 + at(m.level, k)) * level * sign + f.s2 * (1.0 + at(m.viscous, k)) * v;
    out(static_cast<Eigen::Index>(i)) =
        (moved + held - at(m.motor_force, k) - at(m.load_force, k) - m.offset) / m.torque_gain;
  }
  return out;
}

struct LeastSquares {
  Point point;
  double left = 0.0;  ///< sum of squares
};

/// Every number that may move: of the base, and of the last effect where `own`.
std::vector<std::pair<double*, double>> Numbers(const Problem& problem, Point& point, bool own) {
  std::vector<std::pair<double*, double>> out;
  for (std::size_t i = 0; i < point.base.size(); ++i)
    if (!problem.terms[i].nuisance) out.emplace_back(&point.base[i], problem.terms[i].step);
  if (!own) return out;
  const Effect& e = *point.effects.back();
  for (std::size_t i = 0; i < (e.tested > 0 ? e.tested : e.steps.size()); ++i)
    out.emplace_back(&point.amplitudes.back()[i], e.steps[i]);
  return out;
}

void WithinBounds(Point& point) {
  const Effect& e = *point.effects.back();
  std::vector<double>& a = point.amplitudes.back();
  for (std::size_t i = 0; i < a.size() && !e.low.empty(); ++i) a[i] = std::clamp(a[i], e.low[i], e.high[i]);
}

LeastSquares Solve(const Problem& problem, const Sliding& sliding, Point point, bool own) {
  const Signals& s = *problem.signals;
  Eigen::VectorXd acting(static_cast<Eigen::Index>(sliding.rows.size()));
  for (std::size_t i = 0; i < sliding.rows.size(); ++i)
    acting(static_cast<Eigen::Index>(i)) = sliding.acting[sliding.rows[i]];
  const auto left = [&] { return Eigen::VectorXd(acting - Needed(problem.Build(point), s, sliding.rows)); };
  Eigen::VectorXd residual = left();
  // What is no straight line is one near its end.
  for (int turn = 0; turn < kEfforts.quick.most_steps; ++turn) {
    const auto numbers = Numbers(problem, point, own);
    Eigen::MatrixXd columns(acting.size(), static_cast<Eigen::Index>(numbers.size()));
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      auto& [x, step] = numbers[i];
      const double was = std::exchange(*x, *x + step);
      columns.col(static_cast<Eigen::Index>(i)) = (residual - left()) / step;
      *x = was;
    }
    Eigen::MatrixXd normal = columns.transpose() * columns;
    // As far as what is left lets it: the base's priors.
    const double variance = residual.squaredNorm() / static_cast<double>(acting.size());
    Eigen::VectorXd gradient = columns.transpose() * residual;
    std::size_t i = 0;
    for (std::size_t t = 0; t < point.base.size(); ++t) {
      if (problem.terms[t].nuisance) continue;
      const double weight = variance / std::pow(problem.terms[t].sigma, 2);
      const auto j = static_cast<Eigen::Index>(i++);
      normal(j, j) += weight;
      gradient(j) -= weight * point.base[t];
    }
    normal.diagonal() *= 1.0 + kScreening.negligible_share * kScreening.negligible_share;
    const Eigen::VectorXd step = normal.completeOrthogonalDecomposition().solve(gradient);
    for (std::size_t j = 0; j < numbers.size(); ++j) *numbers[j].first += step(static_cast<Eigen::Index>(j));
    if (own) WithinBounds(point);
    residual = left();
  }
  return {std::move(point), residual.squaredNorm()};
}

bool MayBeGross(const Problem& problem, const Scored& s) {
  const Effect& e = *s.effect;
  return !Outside(e.kind) && !InBase(problem, e.kind) && e.start.empty() && !e.common_factor &&
         !CauseNamed(e.kind).judged_at_scale && !CauseNamed(e.kind).about_timing;
}

}  // namespace

std::vector<InitialGuess> FromLeastSquares(const Problem& problem, const Fit& current,
                                           const std::vector<Scored>& scored) {
  const Sliding sliding = SlidingRows(problem, current);
  std::vector<InitialGuess> guesses;
  if (sliding.rows.size() < static_cast<std::size_t>(kScreening.blocks)) return guesses;
  const double without = Solve(problem, sliding, current.point, false).left;
  std::vector<LeastSquares> gross;
  for (const Scored& s : scored) {
    if (!MayBeGross(problem, s)) continue;
    Point point = current.point;
    point.effects.push_back(s.effect);
    point.amplitudes.emplace_back(s.effect->steps.size(), 0.0);
    LeastSquares with = Solve(problem, sliding, std::move(point), true);
    if (with.left < kHypotheses.half_share * without) gross.push_back(std::move(with));
  }
  std::stable_sort(gross.begin(), gross.end(),
                   [](const LeastSquares& a, const LeastSquares& b) { return a.left < b.left; });
  if (gross.size() > kHypotheses.most_kinds) gross.resize(kHypotheses.most_kinds);
  for (LeastSquares& g : gross) {
    FitEffort effort = WorthFrom(current, kEfforts.far, kScreening.negligible_share);
    effort.hopeless_above = current.cost;
    guesses.push_back({std::move(g.point), effort});
  }
  return guesses;
}

}  // namespace contour::diagnosis
