#include "analysis/diagnosis/screening/full_size.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "analysis/diagnosis/tuning/decision_tuning.h"
#include "analysis/prediction_error/products.h"
#include "analysis/prediction_error/simd/lanes.h"

namespace contour::diagnosis {
namespace {

// Grid points that the excerpt leaves for the whole log: one run of all lanes.
constexpr std::size_t kShortlist = kLanes;

std::vector<Point> GridPointsOf(const Problem& problem, const Fit& current, const std::string& kind,
                                const std::vector<Scored>& scored) {
  std::vector<Point> points;
  const auto add = [&](const SharedEffect& e, double first) {
    std::vector<double> a = e->start;
    a[0] = std::clamp(first, e->low[0], e->high[0]);
    // The test's step is as large as what it looks for; a derivative needs a small one.
    auto fine = std::make_shared<Effect>(*e);
    fine->steps[0] = std::min(fine->steps[0], kScreening.fine_step_share * std::fabs(a[0]));
    Point p = current.point;
    p.effects.push_back(std::move(fine));
    p.amplitudes.push_back(std::move(a));
    points.push_back(std::move(p));
  };
  std::size_t small = 0;
  for (const Scored& s : scored) {
    if (s.effect->kind != kind || s.effect->start.empty()) continue;
    for (int i = 0; i < kScreening.grid_sizes; ++i) add(s.effect, std::exp2(-2.0 * i) * s.effect->start[0]);
    // Small ones from where the score test would have them.
    if (small >= kHypotheses.most_kinds || InBase(problem, kind) || s.amplitude(0) <= 0.0) continue;
    ++small;
    for (const double size : {1.0, 2.0}) add(s.effect, size * s.amplitude(0));
  }
  return points;
}

/// Those with a cost that is a number.
std::vector<GridPoint> Costs(const Problem& problem, const Fit& around, std::vector<Point> points,
                             Extent extent) {
  std::vector<GridPoint> out;
  constexpr std::size_t kAtOnce = 2 * kLanes;  // two runs of all lanes side by side
  for (std::size_t first = 0; first < points.size(); first += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, points.size() - first);
    const auto residuals = problem.Residuals(std::span(points).subspan(first, count), extent);
    for (std::size_t i = 0; i < count; ++i) {
      Eigen::VectorXd gradient = GradientOf(around.jacobian, residuals[i]);
      for (std::size_t t = 0; t < around.point.base.size(); ++t)
        gradient(static_cast<Eigen::Index>(t)) += around.point.base[t] / std::pow(problem.terms[t].sigma, 2);
      const Eigen::Map<const Eigen::VectorXd> r(residuals[i].data(),
                                                static_cast<Eigen::Index>(residuals[i].size()));
      const double cost = r.squaredNorm() + around.prior - gradient.dot(around.covariance * gradient);
      if (std::isfinite(cost)) out.push_back({std::move(points[first + i]), cost});
    }
  }
  return out;
}

/// What the excerpt has of a fit's sensitivities, with the covariance that they leave.
Fit OnExcerpt(const Problem& problem, const Fit& fit) {
  const Excerpt& e = problem.excerpt;
  const std::size_t m = e.row.size(), n = problem.rows(), size = problem.data_size(Extent::kExcerpt);
  Fit out;
  out.point = fit.point;
  out.prior = fit.prior;
  out.jacobian = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(size), fit.jacobian.cols());
  const double root = std::sqrt(e.per_row);
  for (std::size_t i = 0; i < size; ++i)
    if (e.counts[i % m] != 0)
      out.jacobian.row(static_cast<Eigen::Index>(i)) =
          root * fit.jacobian.row(static_cast<Eigen::Index>(i / m * n + e.row[i % m]));
  const Eigen::Index columns = fit.jacobian.cols();
  out.normal = Eigen::MatrixXd::Zero(columns, columns);
  AddProducts(out.jacobian, 0, out.normal);
  Eigen::MatrixXd normal = out.normal;
  for (std::size_t t = 0; t < fit.point.base.size(); ++t) {
    const auto j = static_cast<Eigen::Index>(t);
    normal(j, j) += std::pow(problem.terms[t].sigma, -2);
  }
  normal.diagonal().array() += 1e-18 * normal.diagonal().maxCoeff();
  out.covariance = normal.ldlt().solve(Eigen::MatrixXd::Identity(columns, columns));
  return out;
}

/// The best by the excerpt; of couplings, as many again of those that every screw has.
std::vector<Point> Shortlist(const Problem& problem, const Fit& current, std::vector<Point> points) {
  std::vector<GridPoint> points_of_grid = RoughCosts(problem, current, std::move(points));
  std::stable_sort(points_of_grid.begin(), points_of_grid.end(),
                   [](const GridPoint& a, const GridPoint& b) { return a.cost < b.cost; });
  const auto stiff = [&](const GridPoint& p) { return p.point.effects.back()->order > NoFault_Hz(problem); };
  const bool both = std::any_of(points_of_grid.begin(), points_of_grid.end(), stiff);
  const std::size_t most = both ? kShortlist / 2 : kShortlist;
  std::size_t kept[2] = {0, 0};
  std::vector<Point> out;
  for (GridPoint& p : points_of_grid)
    if (kept[stiff(p) ? 1 : 0]++ < most) out.push_back(std::move(p.point));
  return out;
}

}  // namespace

std::vector<GridPoint> RoughCosts(const Problem& problem, const Fit& around, std::vector<Point> points) {
  if (problem.excerpt.empty()) return Costs(problem, around, std::move(points), Extent::kWhole);
  return Costs(problem, OnExcerpt(problem, around), std::move(points), Extent::kExcerpt);
}

std::vector<GridPoint> FullSize(const Problem& problem, const Fit& current, const std::string& kind,
                                const std::vector<Scored>& scored) {
  std::vector<Point> points = GridPointsOf(problem, current, kind, scored);
  const bool strong = std::any_of(scored.begin(), scored.end(), [&](const Scored& s) {
    return s.effect->kind == kind && s.drop > kAcceptance.no_chance_score;
  });
  if (strong && points.size() > 2 * kShortlist && !problem.excerpt.empty())
    points = Shortlist(problem, current, std::move(points));
  std::vector<GridPoint> out = Costs(problem, current, std::move(points), Extent::kWhole);
  std::erase_if(out, [&](const GridPoint& p) { return p.cost >= current.cost; });
  return out;
}

}  // namespace contour::diagnosis
