#include "core/stationary_riccati.h"

namespace contour {
namespace {

constexpr int kMostPasses = 40;
constexpr double kConverged = 1e-14;

}  // namespace

std::optional<SmallMatrix> SolveRiccati(const SmallMatrix& a, const SmallMatrix& b, const SmallMatrix& q,
                                        const SmallMatrix& r) {
  const Eigen::Index n = a.rows();
  const SmallMatrix identity = SmallMatrix::Identity(n, n);
  SmallMatrix power = a;
  SmallMatrix input = b * r.ldlt().solve(b.transpose());
  SmallMatrix cost = q;
  for (int i = 0; i < kMostPasses; ++i) {
    const Eigen::PartialPivLU<SmallMatrix> w(identity + input * cost);
    const SmallMatrix kept = w.solve(power);
    const SmallMatrix reached = w.solve(input);
    const SmallMatrix step = power.transpose() * cost * kept;
    input += (power * reached * power.transpose()).eval();
    power = (power * kept).eval();
    cost += 0.5 * (step + step.transpose());
    if (!cost.allFinite() || !input.allFinite()) return std::nullopt;
    if (step.cwiseAbs().maxCoeff() <= kConverged * cost.cwiseAbs().maxCoeff()) return cost;
  }
  return std::nullopt;
}

}  // namespace contour
