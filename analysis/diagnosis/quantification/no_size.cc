#include "analysis/diagnosis/quantification/no_size.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/effect_parts.h"

namespace contour::diagnosis {
namespace {

/// The size where its first amplitude is that.
double SizeWith(const Problem& problem, Point point, std::size_t place, double amplitude) {
  const CauseDefinition& cause = CauseNamed(point.effects[place]->kind);
  point.amplitudes[place][0] = amplitude;
  return (*cause.parameters)({problem, point, place}).at(std::string(*cause.main_parameter));
}

bool NoSize(const Problem& problem, const Fit& fit, std::size_t place, const Interval& size) {
  const Effect& effect = *fit.point.effects[place];
  if (effect.low.empty() || !AtItsBound(problem, effect, fit.point.amplitudes[place])) return false;
  if (size.low <= 0.0 && size.high >= 0.0) return true;
  const double step = effect.steps[0];
  const double at_low = SizeWith(problem, fit.point, place, effect.low[0] + step),
               at_high = SizeWith(problem, fit.point, place, effect.high[0] - step);
  return size.low <= std::min(at_low, at_high) && size.high >= std::max(at_low, at_high);
}

}  // namespace

void MarkNoSize(const Problem& problem, const Fit& fit, const Accepted& accepted, Diagnosis& out) {
  std::size_t in_fit = 0;
  for (Cause& cause : out.causes) {
    const CauseDefinition& definition = CauseNamed(cause.kind);
    if (definition.in_scatter_only) continue;  // not in the fit
    const std::size_t place = accepted.places[in_fit++];
    const auto size = cause.parameters.find(std::string(*definition.main_parameter));
    // A factor on all forces against the torque has its interval from what is stated.
    if (size == cause.parameters.end() || definition.common_factor) continue;
    cause.no_size = NoSize(problem, fit, place, size->second);
  }
}

}  // namespace contour::diagnosis
