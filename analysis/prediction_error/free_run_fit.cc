#include "analysis/prediction_error/free_run_fit.h"

#include <Eigen/Dense>
#include <cmath>
#include <utility>
#include <vector>

#include "analysis/prediction_error/fit.h"
#include "analysis/prediction_error/free_runs.h"

namespace contour::diagnosis {
namespace {

/// Of Gauss-Newton, and halvings of a step that leads uphill.
constexpr int kSteps = 5, kHalvings = 4;
/// Step of a derivative, of a parameter's freedom: what it moves is far above rounding and near linear.
constexpr double kDerivative = 0.02;

class FreeRunFit {
 public:
  FreeRunFit(const Problem& problem, const Point& from, const Eigen::VectorXd& freedom,
             std::vector<Segment> windows)
      : problem_(problem), from_(from), freedom_(freedom), windows_(std::move(windows)) {
    for (Eigen::Index i = 0; i < freedom.size(); ++i)
      if (freedom(i) > 0.0) free_.push_back(i);
  }

  Point Run() {
    const auto n = static_cast<Eigen::Index>(free_.size());
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    Eigen::VectorXd errors = ErrorsAt({x})[0];
    const double data = kFreeRunsApart * static_cast<double>(windows_.size());
    for (int step = 0; step < kSteps; ++step) {
      const double square = errors.squaredNorm() / data;
      if (!(square > 0.0)) break;
      const Eigen::MatrixXd j = DerivativeAt(x, errors);
      const Eigen::MatrixXd normal = j.transpose() * j / square + Eigen::MatrixXd::Identity(n, n);
      const Eigen::VectorXd by = -normal.ldlt().solve(j.transpose() * errors / square + x);
      if (!Descend(by, square, x, errors)) break;
    }
    return At(x);
  }

 private:
  /// x: in freedoms.
  [[nodiscard]] Point At(const Eigen::VectorXd& x) const {
    Eigen::VectorXd by = Eigen::VectorXd::Zero(freedom_.size());
    for (std::size_t i = 0; i < free_.size(); ++i)
      by(free_[i]) = x(static_cast<Eigen::Index>(i)) * freedom_(free_[i]);
    return Moved(from_, by);
  }

  [[nodiscard]] std::vector<Eigen::VectorXd> ErrorsAt(const std::vector<Eigen::VectorXd>& places) const {
    std::vector<AxisModel> models;
    for (const Eigen::VectorXd& x : places) models.push_back(problem_.Build(At(x)));
    std::vector<Eigen::VectorXd> out;
    for (const std::vector<double>& e : FreeRuns(problem_, models, windows_))
      out.emplace_back(Eigen::Map<const Eigen::VectorXd>(e.data(), static_cast<Eigen::Index>(e.size())));
    return out;
  }

  [[nodiscard]] Eigen::MatrixXd DerivativeAt(const Eigen::VectorXd& x, const Eigen::VectorXd& errors) const {
    std::vector<Eigen::VectorXd> places(free_.size(), x);
    for (std::size_t i = 0; i < places.size(); ++i) places[i](static_cast<Eigen::Index>(i)) += kDerivative;
    const std::vector<Eigen::VectorXd> moved = ErrorsAt(places);
    Eigen::MatrixXd j(errors.size(), static_cast<Eigen::Index>(free_.size()));
    for (Eigen::Index i = 0; i < j.cols(); ++i)
      j.col(i) = (moved[static_cast<std::size_t>(i)] - errors) / kDerivative;
    return j;
  }

  /// Whether a step, or a part of it, leads down: the errors, over the mean square of a window, and what the
  /// parameters pay.
  bool Descend(Eigen::VectorXd by, double square, Eigen::VectorXd& x, Eigen::VectorXd& errors) const {
    const double before = errors.squaredNorm() / square + x.squaredNorm();
    for (int halving = 0; halving < kHalvings; ++halving, by *= 0.5) {
      Eigen::VectorXd there = x + by;
      Eigen::VectorXd moved = ErrorsAt({there})[0];
      if (!(moved.squaredNorm() / square + there.squaredNorm() < before)) continue;
      x = std::move(there);
      errors = std::move(moved);
      return true;
    }
    return false;
  }

  const Problem& problem_;
  const Point& from_;
  const Eigen::VectorXd& freedom_;
  std::vector<Segment> windows_;
  std::vector<Eigen::Index> free_;
};

}  // namespace

Point FitFreeRuns(const Problem& problem, const Point& from, const Eigen::VectorXd& freedom, Parts parts) {
  std::vector<Segment> windows = FreeRunWindows(problem, parts);
  if (windows.empty()) return from;
  return FreeRunFit(problem, from, freedom, std::move(windows)).Run();
}

}  // namespace contour::diagnosis
