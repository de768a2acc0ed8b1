#include "analysis/prediction_error/steady_gain.h"

namespace contour::diagnosis {
namespace {

constexpr int kMostRounds = 4000, kFewestRounds = 50;
constexpr double kSettled = 1e-12;  // relative change of the gain in a round

}  // namespace

Eigen::VectorXd SteadyGain(const Eigen::MatrixXd& f, const Eigen::MatrixXd& noise, double reading,
                           const Eigen::MatrixXd& start) {
  Eigen::MatrixXd p = start;
  Eigen::VectorXd gain = Eigen::VectorXd::Zero(f.rows());
  for (int i = 0; i < kMostRounds; ++i) {
    const Eigen::VectorXd next = p.col(0) / (p(0, 0) + reading);
    const bool settled = i > kFewestRounds && (next - gain).norm() < kSettled * next.norm();
    gain = next;
    if (settled) break;
    p = (p - gain * p.row(0)).eval();
    p = (f * p * f.transpose() + noise).eval();
    p = (0.5 * (p + p.transpose())).eval();
  }
  return gain;
}

}  // namespace contour::diagnosis
