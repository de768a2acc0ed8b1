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

/// What the motion needs in some rows, by the model of a sliding axis. Most numbers leave the Stribeck curve
/// as it is, and that is what takes time.
class NeededTorque {
 public:
  NeededTorque(const Signals& s, const std::vector<std::size_t>& rows) : rows_(rows) {
    for (const std::size_t k : rows) {
      velocity_.push_back(s.velocity[k]);
      acceleration_.push_back(s.acceleration[k]);
    }
  }

  Eigen::VectorXd Of(const AxisModel& m) {
    const StatedFriction& f = m.friction;
    const Signal& fall = Fall(f.vs, f.exponent);
    Eigen::VectorXd out(static_cast<Eigen::Index>(rows_.size()));
    const auto at = [](const SharedSignal& signal, std::size_t k) { return signal ? (*signal)[k] : 0.0; };
    const double inertia = m.motor_inertia + (m.two_inertia ? m.load_inertia : 0.0);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const std::size_t k = rows_[i];
      const double v = velocity_[i], sign = v > 0.0 ? 1.0 : -1.0;
      const double coulomb = v > 0.0 ? f.Fc_plus : f.Fc_minus, rest = v > 0.0 ? f.Fs_plus : f.Fs_minus;
      const double level = coulomb + (rest - coulomb) * fall[i];
      const double moved = (inertia + (k >= m.payload_row ? m.payload : 0.0)) * acceleration_[i];
      const double held = (1.0 + at(m.level, k)) * level * sign + f.s2 * (1.0 + at(m.viscous, k)) * v;
      out(static_cast<Eigen::Index>(i)) =
          (moved + held - at(m.motor_force, k) - at(m.load_force, k) - m.offset) / m.torque_gain;
    }
    return out;
  }

 private:
  /// Of the level, from rest on, at each row's speed.
  struct Curve {
    double vs = 0.0, exponent = 0.0;
    Signal fall = {};
  };

  const Signal& Fall(double vs, double exponent) {
    for (const Curve& c : curves_)
      if (c.vs == vs && c.exponent == exponent) return c.fall;
    // The first ones, from which every cause begins, stay.
    if (std::ssize(curves_) == 2 * kCurvesOfAStep) curves_.erase(curves_.begin() + kCurvesOfAStep);
    curves_.push_back({vs, exponent, Signal(rows_.size())});
    Curve& c = curves_.back();
    for (std::size_t i = 0; i < c.fall.size(); ++i)
      c.fall[i] = std::exp(-std::pow(std::fabs(velocity_[i]) / vs, exponent));
    return c.fall;
  }

  static constexpr std::ptrdiff_t kCurvesOfAStep = 2;  ///< at vs as it is, and moved
  const std::vector<std::size_t>& rows_;
  Signal velocity_, acceleration_;
  std::vector<Curve> curves_;
};

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

/// The model of a point of which only numbers of the base are others than in `with`: signals stay.
AxisModel BuildBase(const Problem& problem, const Point& point, const AxisModel& with) {
  if (point.effects.empty() || !point.effects.back()->signals) return problem.Build(point);
  Point before = point;
  before.effects.pop_back();
  before.amplitudes.pop_back();
  AxisModel m = problem.Build(before);
  m.motor_force = with.motor_force;
  m.load_force = with.load_force;
  m.level = with.level;
  m.viscous = with.viscous;
  return m;
}

LeastSquares Solve(const Problem& problem, const Sliding& sliding, NeededTorque& needed, Point point,
                   bool own) {
  Eigen::VectorXd acting(static_cast<Eigen::Index>(sliding.rows.size()));
  for (std::size_t i = 0; i < sliding.rows.size(); ++i)
    acting(static_cast<Eigen::Index>(i)) = sliding.acting[sliding.rows[i]];
  const std::size_t base_numbers = Numbers(problem, point, false).size();
  AxisModel model = problem.Build(point);
  Eigen::VectorXd residual = acting - needed.Of(model);
  // What is no straight line is one near its end.
  for (int turn = 0; turn < kEfforts.quick.most_steps; ++turn) {
    const auto numbers = Numbers(problem, point, own);
    const std::size_t of_own = numbers.size() - base_numbers;
    Eigen::MatrixXd columns(acting.size(), static_cast<Eigen::Index>(numbers.size()));
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      auto& [x, step] = numbers[i];
      const double was = std::exchange(*x, *x + step);
      const bool of_base = numbers.size() - i > of_own;
      columns.col(static_cast<Eigen::Index>(i)) =
          (residual -
           (acting - needed.Of(of_base ? BuildBase(problem, point, model) : problem.Build(point)))) /
          step;
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
    model = problem.Build(point);
    residual = acting - needed.Of(model);
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
  NeededTorque needed(*problem.signals, sliding.rows);
  const double without = Solve(problem, sliding, needed, current.point, false).left;
  std::vector<LeastSquares> gross;
  for (const Scored& s : scored) {
    if (!MayBeGross(problem, s)) continue;
    Point point = current.point;
    point.effects.push_back(s.effect);
    point.amplitudes.emplace_back(s.effect->steps.size(), 0.0);
    LeastSquares with = Solve(problem, sliding, needed, std::move(point), true);
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
