#include "tools/improve/kept_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "analysis/text/format_text.h"

namespace contour::improve {
namespace {

/// Of keeping a model that is no better.
constexpr double kChance = 0.025;

double Mean(const std::vector<double>& x) {
  return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
}

double SumOfSquares(const std::vector<double>& x, double mean) {
  double sum = 0.0;
  for (const double v : x) sum += (v - mean) * (v - mean);
  return sum;
}

/// Of errors; what is smaller than the place of measurement tells counts as much as that.
std::vector<double> Logarithms(const std::vector<double>& x, double least) {
  std::vector<double> out;
  for (const double v : x) out.push_back(std::log(std::max(v, least)));
  return out;
}

std::string InNumbers(const char* what, const Comparison& c, double usual_um) {
  return FormatText("%s %.3g um, before %.3g um (a difference below %.2g um is chance)", what, c.after_um,
                    c.before_um, usual_um);
}

}  // namespace

/// By the angle t = sqrt(n) tan(a), whose density is cos(a)^(n - 1): smooth, and of finite range.
double StudentQuantile(std::size_t freedom, double probability) {
  constexpr int kSteps = 4000;
  const double step = 0.5 * std::numbers::pi / kSteps;
  const auto density = [&](double angle) {
    return std::pow(std::cos(angle), static_cast<double>(freedom) - 1.0);
  };
  double half = 0.0;
  for (int i = 0; i < kSteps; ++i) half += density((i + 0.5) * step);
  double above = 2.0 * probability * half;
  int i = kSteps - 1;
  for (; i > 0 && above > density((i + 0.5) * step); --i) above -= density((i + 0.5) * step);
  const double angle = (i + 1 - above / density((i + 0.5) * step)) * step;
  return std::sqrt(static_cast<double>(freedom)) * std::tan(angle);
}

Comparison Compare(const Repeats& r, double resolution_um, std::size_t candidates) {
  if (r.before_um.size() < 2 || r.after_um.size() < 2)
    throw std::invalid_argument("two passes before and two after are needed");
  Comparison c;
  c.before_um = Mean(r.before_um);
  c.after_um = Mean(r.after_um);
  c.resolution_um = resolution_um;
  const std::vector<double> before = Logarithms(r.before_um, resolution_um);
  const std::vector<double> after = Logarithms(r.after_um, resolution_um);
  c.log_ratio = Mean(after) - Mean(before);
  const std::size_t freedom = before.size() + after.size() - 2;
  const double variance =
      (SumOfSquares(before, Mean(before)) + SumOfSquares(after, Mean(after))) / static_cast<double>(freedom);
  const double shares = 1.0 / static_cast<double>(before.size()) + 1.0 / static_cast<double>(after.size());
  const double quantile =
      StudentQuantile(freedom, kChance / static_cast<double>(std::max<std::size_t>(1, candidates)));
  c.log_deviation = std::sqrt(variance * shares);
  c.log_chance = quantile * c.log_deviation;
  c.repeatability_um = std::max(resolution_um, -c.before_um * std::expm1(-c.log_chance));
  return c;
}

Judgement Judge(const Comparison& path, const Comparison& check) {
  if (check.worse())
    return {false, "the new model is worse on the program that it was not fitted on: " +
                       InNumbers("largest error", check, check.Rise_um(check.log_chance))};
  if (!check.better())
    return {false,
            "the new model is not better on the program that it was not fitted on, beyond "
            "repeatability: " +
                InNumbers("largest error", check, check.repeatability_um)};
  if (path.higher())
    return {false, "the new model is higher on the path, by more than repeats usually differ: " +
                       InNumbers("largest error", path, path.Rise_um(path.log_deviation))};
  return {true,
          InNumbers("largest error on the program that it was not fitted on", check, check.repeatability_um)};
}

}  // namespace contour::improve
