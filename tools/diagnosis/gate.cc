#include "tools/diagnosis/gate.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace contour::diagnosis {

double SignFlipGate(std::span<const Scored> scored, double false_alarm_rate, std::uint64_t seed) {
  constexpr int kDraws = 1500;
  constexpr int kScans = 6;
  std::mt19937_64 random(seed * 2654435761U + 99);
  std::uniform_real_distribution<double> uniform(1e-12, 1.0);
  std::vector<double> largest;
  Eigen::VectorXd signs(kBlocks);
  for (int d = 0; d < kDraws; ++d) {
    for (Eigen::Index b = 0; b < kBlocks; ++b) signs(b) = (random() & 1U) != 0 ? 1.0 : -1.0;
    double best = -1e300;
    for (int i = 0; i < kScans; ++i) best = std::max(best, -2.0 * std::log(-std::log(uniform(random))) - 6.0);
    for (const Scored& s : scored) {
      if (s.effect->grid >= 12.0 && s.effect->order > 0.0 && s.effect->kind != "payload_step")
        continue;  // a scan's
      const Eigen::VectorXd h = s.per_block * signs;
      best = std::max(best, h.dot(s.covariance * h) / s.excess - Penalty(*s.effect));
    }
    largest.push_back(best);
  }
  std::sort(largest.begin(), largest.end());
  const auto quantile = [&](double p) {
    return largest[std::min<std::size_t>(kDraws - 1, static_cast<std::size_t>(p * kDraws))];
  };
  if (false_alarm_rate >= 0.02) return quantile(1.0 - false_alarm_rate);
  // Straight through the 80 % and the 98 % quantile on Gumbel's paper.
  const auto paper = [](double p) { return -std::log(-std::log(p)); };
  const double slope = (quantile(0.98) - quantile(0.80)) / (paper(0.98) - paper(0.80));
  return quantile(0.98) + slope * (paper(1.0 - false_alarm_rate) - paper(0.98));
}

}  // namespace contour::diagnosis
