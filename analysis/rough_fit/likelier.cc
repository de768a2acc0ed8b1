#include "analysis/rough_fit/likelier.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "analysis/prediction_error/settling.h"

namespace contour::diagnosis {
namespace {

std::vector<double> ResidualUnder(const LearntNoise& noise, const SettledModel& model) {
  model.problem.Take(noise);
  return std::move(model.problem.White(std::span(&model.raw, 1)).front());
}

double Under(const LearntNoise& noise, const SettledModel& first, const SettledModel& second) {
  const std::vector<double> one = ResidualUnder(noise, first), other = ResidualUnder(noise, second);
  const std::size_t n = first.problem.rows();
  const auto block =
      std::max<std::size_t>(1, static_cast<std::size_t>(kSettling_s / first.problem.log.period_s));
  std::vector<double> better(n / block + 1, 0.0);
  for (std::size_t i = 0; i < one.size(); ++i) {
    // What one of them takes for a wrong reading says nothing of the other.
    if (first.problem.counted[i % n] == 0 || second.problem.counted[i % n] == 0) continue;
    better[i % n / block] += other[i] * other[i] - one[i] * one[i];
  }
  const auto blocks = static_cast<double>(better.size());
  double sum = 0.0, squares = 0.0;
  for (const double b : better) sum += b;
  for (const double b : better) squares += std::pow(b - sum / blocks, 2);
  return squares > 0.0 ? sum / std::sqrt(squares) : 0.0;
}

}  // namespace

double FirstIsBetterBy(const SettledModel& first, const SettledModel& second) {
  const LearntNoise of_first = first.problem.Learnt(), of_second = second.problem.Learnt();
  const double one = Under(of_first, first, second), other = Under(of_second, first, second);
  first.problem.Take(of_first);
  second.problem.Take(of_second);
  if (!(one * other > 0.0)) return 0.0;
  return std::copysign(std::min(std::fabs(one), std::fabs(other)), one);
}

}  // namespace contour::diagnosis
