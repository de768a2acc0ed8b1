#include "tools/validation/emps/fit_free_run.h"

#include <ceres/ceres.h>

#include <stdexcept>

namespace contour::emps {
namespace {

constexpr std::size_t kEvery = 20;
constexpr std::size_t kStartEvery = 250;
constexpr double kUnit_m = 1e-4;
constexpr double kDifference = 1e-4;  // of a scaled parameter

class WindowsCost final : public ceres::CostFunction {
 public:
  WindowsCost(const Parameters& start, const std::vector<Free>& free, const Recording& r,
              std::vector<std::size_t> windows, std::size_t rows)
      : start_(start), free_(free), recording_(r), windows_(std::move(windows)), rows_(rows) {
    mutable_parameter_block_sizes()->push_back(static_cast<int>(free.size()));
    set_num_residuals(static_cast<int>(windows_.size() * Rows()));
  }

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const std::vector<double> here(x[0], x[0] + free_.size());
    const std::vector<double> base = Residuals(here);
    std::copy(base.begin(), base.end(), residuals);
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    for (std::size_t j = 0; j < free_.size(); ++j) {
      std::vector<double> moved = here;
      moved[j] += kDifference;
      const std::vector<double> r = Residuals(moved);
      for (std::size_t i = 0; i < r.size(); ++i)
        jacobians[0][i * free_.size() + j] = (r[i] - base[i]) / kDifference;
    }
    return true;
  }

  [[nodiscard]] Parameters At(const std::vector<double>& x) const {
    Parameters p = start_;
    for (std::size_t j = 0; j < free_.size(); ++j) p.*free_[j].value = x[j] * free_[j].scale;
    return p;
  }

 private:
  [[nodiscard]] std::size_t Rows() const { return (rows_ + kEvery - 1) / kEvery; }
  [[nodiscard]] std::vector<double> Residuals(const std::vector<double>& x) const {
    const Parameters p = At(x);
    std::vector<double> out;
    out.reserve(windows_.size() * Rows());
    for (const std::size_t start : windows_) {
      const std::vector<double> run = FreeRun(p, recording_, start, rows_);
      for (std::size_t k = 0; k < rows_; k += kEvery)
        out.push_back((recording_.position_m[start + k] - run[k]) / kUnit_m);
    }
    return out;
  }

  Parameters start_;
  std::vector<Free> free_;
  const Recording& recording_;
  std::vector<std::size_t> windows_;
  std::size_t rows_;
};

}  // namespace

Parameters FitFreeRun(Parameters start, const std::vector<Free>& free, const Recording& r,
                      const Segment& segment, std::size_t window) {
  std::vector<double> x;
  for (const Free& f : free) x.push_back(start.*f.value / f.scale);
  auto* cost =
      new WindowsCost(start, free, r, segment.Windows(window, kStartEvery), window);  // the problem's own
  ceres::Problem problem;
  problem.AddResidualBlock(cost, nullptr, x.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 30;
  options.function_tolerance = 1e-5;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) throw std::runtime_error("fit of free runs: " + summary.message);
  return cost->At(x);
}

}  // namespace contour::emps
