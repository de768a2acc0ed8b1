#include "analysis/diagnosis/quantification/widen.h"

#include <cmath>
#include <string_view>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/tuning/statistics.h"
#include "analysis/prediction_error/common_factor.h"

namespace contour::diagnosis {
namespace {

/// Of a parameter, relative.
double ModelErrorOf(const CauseDefinition& cause, std::string_view parameter) {
  for (const ModelError& e : *cause.model_errors)
    if (e.parameter == parameter) return e.sigma_rel;
  return 0.0;
}

}  // namespace

void WidenIntervals(const Problem& problem, const Point& point, Cause& cause) {
  const CauseDefinition& definition = CauseNamed(cause.kind);
  for (auto& [name, interval] : cause.parameters) {
    double sigma = ModelErrorOf(definition, name);
    // All forces against the torque: the log itself says nothing about it.
    if (definition.common_factor) sigma = FindCommonFactor(problem, point).sigma;
    const double by = kNormal95 * sigma * std::fabs(interval.value);
    interval.low = interval.value - std::hypot(interval.value - interval.low, by);
    interval.high = interval.value + std::hypot(interval.high - interval.value, by);
  }
}

}  // namespace contour::diagnosis
