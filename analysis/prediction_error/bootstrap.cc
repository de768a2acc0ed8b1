#include "analysis/prediction_error/bootstrap.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>

#include "analysis/diagnosis/tuning/prediction_tuning.h"
#include "analysis/prediction_error/products.h"
#include "analysis/prediction_error/simd/lanes.h"

namespace contour::diagnosis {
namespace {

/// What the strokes pull the parameters by, one column per stroke, in the size that it had before the fit
/// yielded to it: with G = J'J of the stroke, white noise would make the covariance of the pull G, the fit
/// leaves G - G (sum of G and priors)^-1 G of it (the bias-reduced cluster estimate of Bell and McCaffrey,
/// Survey Methodology 28(2), 2002).
Eigen::MatrixXd PullsOf(const Problem& problem, const Fit& fit, const Eigen::VectorXd& precision) {
  const std::vector<const double*> columns = ColumnsOf(fit.jacobian);
  const Eigen::Index n = fit.jacobian.cols();
  Eigen::MatrixXd whole = fit.normal;
  whole.diagonal() += precision;
  whole.diagonal() *= 1.0 + 1e-12;
  const Eigen::LDLT<Eigen::MatrixXd> solver(whole);
  const std::vector<std::size_t> ends = StrokeEnds(problem);
  Eigen::MatrixXd pulls(n, static_cast<Eigen::Index>(ends.size()));
  // Units in which no parameter outweighs the others by many powers of ten.
  const Eigen::VectorXd unit = whole.diagonal().cwiseSqrt().cwiseInverse();
  std::size_t from = 0;
  for (std::size_t b = 0; b < ends.size(); from = ends[b++]) {
    Eigen::MatrixXd own = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd pull = Eigen::VectorXd::Zero(n);
    for (std::size_t base = 0; base < problem.data_size(); base += problem.rows()) {
      std::vector<const double*> part = columns;
      for (const double*& c : part) c += base + from;
      const double* residual[] = {fit.residual.data() + base + from};
      own += ProductsOf(part, part, ends[b] - from);
      pull += ProductsOf(part, residual, ends[b] - from);
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> split(unit.asDiagonal() * own * unit.asDiagonal());
    const Eigen::VectorXd root = split.eigenvalues().cwiseMax(1e-12).cwiseSqrt();
    // own = half half'
    const Eigen::MatrixXd half = unit.cwiseInverse().asDiagonal() * split.eigenvectors() * root.asDiagonal();
    const Eigen::MatrixXd left = Eigen::MatrixXd::Identity(n, n) - half.transpose() * solver.solve(half);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> taken(left);
    const Eigen::VectorXd larger = taken.eigenvalues()
                                       .cwiseMax(1.0 / (kBootstrap.most_taken * kBootstrap.most_taken))
                                       .cwiseSqrt()
                                       .cwiseInverse();
    const Eigen::VectorXd seen =
        root.cwiseInverse().asDiagonal() * split.eigenvectors().transpose() * unit.asDiagonal() * pull;
    pulls.col(static_cast<Eigen::Index>(b)) =
        half * (taken.eigenvectors() * larger.asDiagonal() * (taken.eigenvectors().transpose() * seen));
  }
  return pulls;
}

/// One run of the bootstrap.
struct Draw {
  Eigen::VectorXd pull;  ///< what is drawn, of strokes and priors
  Eigen::VectorXd by;    ///< deviation from the fit
  double promised = 0.0;
};

class Bootstrap {
 public:
  Bootstrap(const Problem& problem, const Fit& fit) : fit_(fit) {
    at_ = ValuesOf(fit.point);
    precision_ = Eigen::VectorXd::Zero(at_.size());
    for (std::size_t i = 0; i < fit.point.base.size(); ++i)
      precision_(static_cast<Eigen::Index>(i)) = std::pow(problem.terms[i].sigma, -2);
    pulls_ = PullsOf(problem, fit, precision_);
    Eigen::MatrixXd whole = fit.normal;
    whole.diagonal() += precision_;
    whole.diagonal() *= 1.0 + 1e-12;
    normal_.compute(whole);
    gradient_ = GradientOf(fit.jacobian, fit.residual) + precision_.cwiseProduct(at_);
  }

  Draw Begin(std::mt19937_64& random) const {
    std::normal_distribution<double> normal;
    Draw d;
    d.pull = Eigen::VectorXd::Zero(at_.size());
    for (Eigen::Index b = 0; b < pulls_.cols(); ++b) d.pull += normal(random) * pulls_.col(b);
    for (Eigen::Index i = 0; i < at_.size(); ++i)
      if (precision_(i) > 0.0) d.pull(i) += normal(random) * std::sqrt(precision_(i));
    d.by = Eigen::VectorXd::Zero(at_.size());
    Step(d, fit_.residual);
    return d;
  }

  /// From the white residual where the draw stands.
  void Step(Draw& d, const std::vector<double>& residual) const {
    // What the fit itself has not quite balanced is no deviation from it.
    const Eigen::VectorXd gradient =
        GradientOf(fit_.jacobian, residual) + precision_.cwiseProduct(at_ + d.by) - gradient_ + d.pull;
    const Eigen::VectorXd step = -normal_.solve(gradient);
    const double promised = -gradient.dot(step);
    // A second step that promises more than the first did leads nowhere.
    if (d.promised > 0.0 && promised > d.promised) return;
    d.promised = promised;
    d.by += step;
    d.by = ValuesOf(Where(d)) - at_;  // inside the bounds
  }

  [[nodiscard]] Point Where(const Draw& d) const { return Moved(fit_.point, d.by); }

 private:
  static Eigen::VectorXd ValuesOf(const Point& p) {
    Eigen::VectorXd out(static_cast<Eigen::Index>(ParameterCount(p)));
    Eigen::Index j = 0;
    for (const double x : p.base) out(j++) = x;
    for (const auto& amplitudes : p.amplitudes)
      for (const double a : amplitudes) out(j++) = a;
    return out;
  }

  const Fit& fit_;
  Eigen::VectorXd at_, precision_, gradient_;
  Eigen::MatrixXd pulls_;
  Eigen::LDLT<Eigen::MatrixXd> normal_;
};

}  // namespace

std::vector<std::size_t> StrokeEnds(const Problem& problem) {
  const std::vector<double>& q = problem.signals->position;
  const std::size_t n = problem.rows();
  const auto shortest =
      std::max<std::size_t>(1, static_cast<std::size_t>(kBootstrap.shortest_s / problem.log.period_s));
  const std::size_t longest = std::max(shortest, n / kBootstrap.fewest_blocks);
  const auto [low, high] = std::minmax_element(q.begin(), q.end());
  const double turn =
      std::max(kBootstrap.turn_share * (*high - *low), kBootstrap.turn_counts * problem.stated.position_step);
  std::vector<std::size_t> ends;
  std::size_t from = 0, extreme = 0;
  double direction = 0.0;  // +1 upwards, -1 downwards, 0 not known yet
  const auto cut = [&](std::size_t end) {
    for (; end - from > 2 * longest; from += longest) ends.push_back(from + longest);
    ends.push_back(end);
    from = end;
  };
  for (std::size_t k = 0; k < n; ++k) {
    const double ahead = q[k] - q[extreme];
    if (direction * ahead > 0.0 || (direction == 0.0 && std::fabs(ahead) > turn)) {
      if (direction == 0.0) direction = ahead > 0.0 ? 1.0 : -1.0;
      extreme = k;
    } else if (direction != 0.0 && -direction * ahead > turn) {
      if (extreme - from >= shortest) cut(extreme);
      direction = -direction;
      extreme = k;
    }
  }
  if (!ends.empty() && n - from < shortest) {
    ends.pop_back();
    from = ends.empty() ? 0 : ends.back();
  }
  cut(n);
  return ends;
}

Eigen::MatrixXd StrokeBootstrap(const Problem& problem, const Fit& fit, int runs, std::uint64_t seed,
                                const std::function<void(double)>& progress) {
  const Bootstrap bootstrap(problem, fit);
  std::mt19937_64 random(seed * 0x9e3779b97f4a7c15U + 5);
  Eigen::MatrixXd out(fit.jacobian.cols(), runs);
  constexpr int kAtOnce = 2 * kLanes;  // bounds the memory
  for (int first = 0; first < runs; first += kAtOnce) {
    if (progress) progress(static_cast<double>(first) / runs);
    std::vector<Draw> draws;
    std::vector<Point> points;
    for (int i = first; i < std::min(runs, first + kAtOnce); ++i) {
      draws.push_back(bootstrap.Begin(random));
      points.push_back(bootstrap.Where(draws.back()));
    }
    const std::vector<std::vector<double>> residuals = problem.Residuals(points);
    for (std::size_t i = 0; i < draws.size(); ++i) {
      bootstrap.Step(draws[i], residuals[i]);
      out.col(first + static_cast<Eigen::Index>(i)) = draws[i].by;
    }
  }
  // What few strokes show may scatter little by chance: never less than white noise makes it.
  const Eigen::VectorXd mean = out.rowwise().mean();
  for (Eigen::Index i = 0; i < out.rows(); ++i) {
    const double scatter = (out.row(i).array() - mean(i)).square().sum() / std::max(1.0, runs - 1.0);
    const double least = fit.covariance(i, i);
    if (scatter < least && scatter > 0.0)
      out.row(i) = mean(i) + (out.row(i).array() - mean(i)) * std::sqrt(least / scatter);
  }
  return out;
}

}  // namespace contour::diagnosis
