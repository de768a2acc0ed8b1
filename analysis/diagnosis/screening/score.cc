#include "analysis/diagnosis/screening/score.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/screening/overdispersion.h"
#include "analysis/prediction_error/common_factor.h"
#include "analysis/prediction_error/products.h"
#include "analysis/prediction_error/simd/lanes.h"

namespace contour::diagnosis {
namespace {

// Keep solvers away from zero.
constexpr double kRidge = 1e-6, kLeastLeft = 1e-9;
// For the memory: columns of some runs of all lanes. Models of several shapes share no run, so that the more
// there are at once the fewer lanes stay empty.
constexpr std::size_t kColumnsAtOnce = 2 * kLanes, kRunsAtOnce = 2 * kColumnsAtOnce;

// Products of columns with each other and, in blocks of time, with the residual.
ProductsInBlocks InBlocks(const Problem& problem, const Fit& fit, std::span<const double* const> a,
                          std::span<const double* const> b) {
  return MakeProductsInBlocks(a, b, fit.residual.data(), problem.rows(), problem.data_size(),
                              static_cast<std::size_t>(kBlocks));
}

}  // namespace

std::vector<std::size_t> FreedTerms(const Problem& problem, const std::string& kind) {
  std::vector<std::size_t> out;
  for (const std::string_view name : *CauseNamed(kind).freed_terms)
    for (std::size_t i = 0; i < problem.terms.size(); ++i)
      if (problem.terms[i].name == name) out.push_back(i);
  return out;
}

bool InBase(const Problem& problem, const std::string& kind) {
  return CauseNamed(kind).common_factor || !FreedTerms(problem, kind).empty();
}

double OverdispersionOfLast(const Problem& problem, const Fit& fit) {
  if (InBase(problem, fit.point.effects.back()->kind)) return 1.0;
  const auto n = static_cast<Eigen::Index>(fit.point.amplitudes.back().size());
  const Eigen::Index others = fit.jacobian.cols() - n;
  const Eigen::MatrixXd blocks = InBlocks(problem, fit, {}, ColumnsOf(fit.jacobian)).with_r;
  Eigen::MatrixXd normal = fit.normal;
  for (std::size_t i = 0; i < fit.point.base.size(); ++i)
    normal(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) +=
        std::pow(problem.terms[i].sigma, -2);
  const Eigen::MatrixXd onto =
      normal.topLeftCorner(others, others).ldlt().solve(normal.topRightCorner(others, n));
  const Eigen::MatrixXd information =
      normal.bottomRightCorner(n, n) - normal.topRightCorner(others, n).transpose() * onto;
  const Eigen::MatrixXd projected = blocks.bottomRows(n) - onto.transpose() * blocks.topRows(others);
  return Overdispersion(projected, information.ldlt().solve(Eigen::MatrixXd::Identity(n, n)));
}

double NoFault_Hz(const Problem& problem) { return 0.5 / problem.log.period_s; }

namespace {

using Marks = std::array<bool, static_cast<std::size_t>(kBlocks)>;

// An axis that hardly breaks away does so at one place of its stroke, to and fro; a block may end within it.
constexpr int kMostPlaces = 2, kBlocksOfPlace = 2;

/// Blocks side by side are one place.
bool AreAFewPlaces(const Marks& marks) {
  int places = 0, blocks = 0;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    blocks += marks[i] ? 1 : 0;
    places += marks[i] && (i == 0 || !marks[i - 1]) ? 1 : 0;
  }
  return places <= kMostPlaces && blocks <= kMostPlaces * kBlocksOfPlace;
}

}  // namespace

void LeaveOutRunaways(std::vector<double>& column, std::size_t rows) {
  const std::vector<double> whole = column;
  Marks marks{};
  for (;;) {
    double all = 0.0, largest = 0.0;
    for (const double v : column) {
      all += v * v;
      largest = std::max(largest, v * v);
    }
    if (!(all > 0.0)) column = whole;
    const double most = all / static_cast<double>(kBlocks);
    if (!(largest > most)) return;
    for (std::size_t k = 0; k < column.size(); ++k)
      if (column[k] * column[k] > most) marks[k % rows * marks.size() / rows] = true;
    if (!AreAFewPlaces(marks)) return;
    for (double& v : column)
      if (v * v > most) v = 0.0;
  }
}

double DropAlongBase(const Eigen::MatrixXd& information, const Eigen::MatrixXd& square,
                     const Eigen::VectorXd& gradient) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> left(information, square);
  if (left.info() != Eigen::Success) return 0.0;
  double drop = 0.0;
  for (Eigen::Index i = 0; i < gradient.size() && left.eigenvalues()(i) < kScreening.negligible_share; ++i)
    if (left.eigenvalues()(i) > 0.0)
      drop += std::pow(left.eigenvectors().col(i).dot(gradient), 2) / left.eigenvalues()(i);
  return drop;
}

double Penalty(const Effect& effect) {
  return kScreening.penalty_per_amplitude * static_cast<double>(effect.steps.size()) +
         2.0 * std::log(std::max(1.0, effect.grid));
}

namespace {

// How a column gets its numbers.
enum class Means { kSignals, kRuns, kTerm };
Means MeansOf(const Effect& e) {
  return e.signals ? Means::kSignals : (e.as_term.empty() ? Means::kRuns : Means::kTerm);
}

// White columns by runs.
std::vector<std::vector<double>> RunColumns(const Problem& problem, const Fit& fit,
                                            std::span<const SharedEffect> effects) {
  std::vector<Point> points;
  std::vector<double> steps;
  for (const SharedEffect& e : effects)
    for (std::size_t i = 0; i < e->tested; ++i) {
      Point p = fit.point;
      p.effects.push_back(e);
      p.amplitudes.emplace_back(e->steps.size(), 0.0);
      p.amplitudes.back()[i] += e->steps[i];
      points.push_back(std::move(p));
      steps.push_back(e->steps[i]);
    }
  std::vector<std::vector<double>> columns = problem.Residuals(points);
  for (std::size_t c = 0; c < columns.size(); ++c)
    for (std::size_t k = 0; k < columns[c].size(); ++k)
      columns[c][k] = (columns[c][k] - fit.residual[k]) / steps[c];
  return columns;
}

// White columns of what acts as a base term does from a row on.
std::vector<std::vector<double>> TermColumns(const Problem& problem, const Fit& fit,
                                             std::span<const SharedEffect> effects) {
  const AxisModel m = problem.Build(fit.point);
  const AxisModel& stated = problem.nominal;
  // The term moves the logarithm of its own inertia, the effect a share of the whole stated one.
  const double factor =
      (stated.motor_inertia + stated.load_inertia) / (m.two_inertia ? m.load_inertia : m.motor_inertia);
  std::vector<std::vector<double>> columns;
  for (const SharedEffect& e : effects) {
    const auto term = std::find_if(problem.terms.begin(), problem.terms.end(),
                                   [&](const BaseTerm& t) { return t.name == e->as_term; });
    std::vector<double> column(problem.data_size(), 0.0);
    if (term != problem.terms.end()) {
      const double* from = fit.jacobian.col(term - problem.terms.begin()).data();
      for (std::size_t base = 0; base < column.size(); base += problem.rows())
        for (std::size_t k = base + e->from_row; k < base + problem.rows(); ++k) column[k] = factor * from[k];
    }
    columns.push_back(std::move(column));
  }
  return columns;
}

class Scorer {
 public:
  Scorer(const Problem& problem, const Fit& fit)
      : problem_(problem),
        fit_(fit),
        base_columns_(ColumnsOf(fit.jacobian)),
        base_blocks_(InBlocks(problem, fit, {}, base_columns_).with_r),
        base_gradient_(base_blocks_.rowwise().sum()) {
    for (std::size_t i = 0; i < fit.point.base.size(); ++i)
      base_gradient_(static_cast<Eigen::Index>(i)) +=
          std::pow(problem.terms[i].sigma, -2) * fit.point.base[i];
  }

  /// Every effect with all its columns, then as much shorter as it may be.
  void Score(std::span<const SharedEffect> effects, std::span<const std::vector<double>> columns,
             std::vector<Scored>& out) const {
    std::vector<const double*> all;
    for (const std::vector<double>& c : columns) all.push_back(c.data());
    const ProductsInBlocks with_base = InBlocks(problem_, fit_, base_columns_, all);
    std::size_t first = 0;
    for (const SharedEffect& effect : effects) {
      const std::span<const double* const> own = std::span(all).subspan(first, effect->tested);
      const Eigen::MatrixXd square = ProductsOf(own, own, problem_.data_size());
      const auto at = static_cast<Eigen::Index>(first);
      for (SharedEffect e = effect; e; e = e->shorter) {
        const auto m = static_cast<Eigen::Index>(e->tested);
        out.push_back(ScoreOne(e, with_base.products.middleCols(at, m), square.topLeftCorner(m, m),
                               with_base.with_r.middleRows(at, m)));
      }
      first += effect->tested;
    }
  }

 private:
  /// What the cost falls by when the prior P of the terms that the kind frees is taken away: with x their
  /// deviations and C their covariance, x'Px + x'P (C^-1 - P)^-1 Px.
  void Free(Scored& s) const {
    if (s.effect->common_factor) {
      const CommonFactor common = FindCommonFactor(problem_, fit_.point);
      s.amplitude(0) = std::expm1(common.log_ratio);
      s.covariance(0, 0) = common.sigma * common.sigma;
      s.drop = common.drop;
      return;
    }
    const std::vector<std::size_t> terms = FreedTerms(problem_, s.effect->kind);
    const auto n = std::min(static_cast<Eigen::Index>(terms.size()), s.amplitude.size());
    Eigen::VectorXd x(n), prior(n);
    Eigen::MatrixXd c(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const std::size_t t = terms[static_cast<std::size_t>(i)];
      x(i) = fit_.point.base[t];
      prior(i) = std::pow(problem_.terms[t].sigma, -2);
      for (Eigen::Index j = 0; j < n; ++j)
        c(i, j) = fit_.covariance(static_cast<Eigen::Index>(t),
                                  static_cast<Eigen::Index>(terms[static_cast<std::size_t>(j)]));
    }
    // In units of the prior's deviation; what the data do not know at all stays where it is.
    const Eigen::VectorXd root = prior.cwiseSqrt();
    const Eigen::MatrixXd known = root.asDiagonal() * c * root.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (known + known.transpose()));
    const Eigen::VectorXd z = eigen.eigenvectors().transpose() * root.asDiagonal() * x;
    Eigen::VectorXd to = z, spread(n);
    s.drop = 0.0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double share = std::clamp(eigen.eigenvalues()(i), kLeastLeft, 1.0 - kScreening.little_share);
      s.drop += z(i) * z(i) / (1.0 - share);
      to(i) = z(i) / (1.0 - share);
      spread(i) = share / (1.0 - share);
    }
    const Eigen::MatrixXd back = root.cwiseInverse().asDiagonal() * eigen.eigenvectors();
    s.amplitude.head(n) = back * to;
    s.covariance.topLeftCorner(n, n) = back * spread.asDiagonal() * back.transpose();
  }

  Scored ScoreOne(const SharedEffect& effect, const Eigen::MatrixXd& cross, const Eigen::MatrixXd& square,
                  const Eigen::MatrixXd& blocks) const {
    Scored s;
    s.effect = effect;
    const Eigen::Index n = square.rows();
    const Eigen::MatrixXd onto = fit_.covariance * cross;
    // What the base's fit has not gone down yet is no evidence (C(alpha); Neyman, 1959): of a column that the
    // base nearly does itself it would be most.
    const Eigen::VectorXd gradient = blocks.rowwise().sum() - onto.transpose() * base_gradient_;
    Eigen::MatrixXd information = square - cross.transpose() * onto;
    s.per_block = blocks - onto.transpose() * base_blocks_;
    // Directions that the base explains already, to rounding, carry nothing.
    const bool nearly_base = n == 1 && information(0, 0) < kScreening.negligible_share * square(0, 0);
    for (Eigen::Index i = 0; i < n; ++i) information(i, i) += kRidge * square(i, i) + 1e-300;
    const Eigen::LDLT<Eigen::MatrixXd> solver(information);
    s.covariance = solver.solve(Eigen::MatrixXd::Identity(n, n));
    s.amplitude = -solver.solve(gradient);
    s.drop = -gradient.dot(s.amplitude);
    s.overdispersion = Overdispersion(s.per_block, s.covariance);
    s.within_blocks = WithinBlocks(s.per_block, s.covariance);
    // What the base can nearly do itself frees it from its priors and no more.
    if (nearly_base) s.drop = std::min(s.drop, 2.0 * fit_.prior);
    if (n > 1) s.drop -= std::max(0.0, DropAlongBase(information, square, gradient) - 2.0 * fit_.prior);
    if (InBase(problem_, effect->kind)) {
      // A number of the base already: the evidence is in the prior and not in the blocks.
      s.per_block.setZero();
      s.overdispersion = s.within_blocks = 1.0;
      Free(s);
    }
    s.score = s.drop / s.within_blocks - Penalty(*effect);
    const Eigen::RowVectorXd gain = -s.amplitude.transpose() * s.per_block;
    s.consistency = gain.sum() / (gain.norm() + 1e-300);
    return s;
  }

  const Problem& problem_;
  const Fit& fit_;
  std::vector<const double*> base_columns_;
  Eigen::MatrixXd base_blocks_;
  Eigen::VectorXd base_gradient_;  ///< prior included; nothing at the base's end
};

}  // namespace

std::vector<Scored> ScoreEffects(const Problem& problem, const Fit& fit, std::vector<SharedEffect> effects) {
  std::stable_sort(effects.begin(), effects.end(),
                   [](const SharedEffect& a, const SharedEffect& b) { return MeansOf(*a) < MeansOf(*b); });
  const Scorer scorer(problem, fit);
  std::vector<Scored> out;
  // So many columns at a time bound the memory.
  for (std::size_t at = 0; at < effects.size();) {
    const Means means = MeansOf(*effects[at]);
    const std::size_t most = means == Means::kRuns ? kRunsAtOnce : kColumnsAtOnce;
    std::size_t end = at, count = 0;
    while (end < effects.size() && MeansOf(*effects[end]) == means &&
           (count == 0 || count + effects[end]->tested <= most)) {
      count += effects[end]->tested;
      ++end;
    }
    const std::span<const SharedEffect> some = std::span(effects).subspan(at, end - at);
    std::vector<std::vector<double>> columns;
    if (means == Means::kSignals) {
      columns = problem.LinearResponses(fit.point, some);
      for (std::vector<double>& c : columns) LeaveOutRunaways(c, problem.rows());
    } else {
      columns = means == Means::kRuns ? RunColumns(problem, fit, some) : TermColumns(problem, fit, some);
    }
    scorer.Score(some, columns, out);
    at = end;
  }
  return out;
}

}  // namespace contour::diagnosis
