#include "tools/improve/kept_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "analysis/text/format_text.h"

namespace contour::improve {
namespace {

/// Student's 97.5 % quantile by degrees of freedom, 2 to 10; beyond, the last is a little too careful.
constexpr std::array<double, 9> kStudent{4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228};

double Mean(const std::vector<double>& x) {
  return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
}

double SumOfSquares(const std::vector<double>& x, double mean) {
  double sum = 0.0;
  for (const double v : x) sum += (v - mean) * (v - mean);
  return sum;
}

std::string InNumbers(const char* what, const Comparison& c) {
  return FormatText("%s %.3g um, before %.3g um (a difference below %.2g um is chance)", what, c.after_um,
                    c.before_um, c.repeatability_um);
}

}  // namespace

Comparison Compare(const Repeats& r, double resolution_um) {
  if (r.before_um.size() < 2 || r.after_um.size() < 2)
    throw std::invalid_argument("two passes before and two after are needed");
  Comparison c;
  c.before_um = Mean(r.before_um);
  c.after_um = Mean(r.after_um);
  const std::size_t freedom = r.before_um.size() + r.after_um.size() - 2;
  const double variance = (SumOfSquares(r.before_um, c.before_um) + SumOfSquares(r.after_um, c.after_um)) /
                          static_cast<double>(freedom);
  const double shares =
      1.0 / static_cast<double>(r.before_um.size()) + 1.0 / static_cast<double>(r.after_um.size());
  const double quantile = kStudent[std::min(freedom - 2, kStudent.size() - 1)];
  c.repeatability_um = std::max(resolution_um, quantile * std::sqrt(variance * shares));
  return c;
}

Judgement Judge(const Comparison& path, const Comparison& check) {
  if (check.worse())
    return {false, "the new model is worse on the program that it was not fitted on: " +
                       InNumbers("largest error", check)};
  if (!check.better())
    return {false,
            "the new model is not better on the program that it was not fitted on, beyond "
            "repeatability: " +
                InNumbers("largest error", check)};
  if (path.worse()) return {false, "the new model is worse on the path: " + InNumbers("largest error", path)};
  return {true, InNumbers("largest error on the program that it was not fitted on", check)};
}

}  // namespace contour::improve
