#include "analysis/diagnosis/causes/extensions_of.h"

#include <cmath>

#include "analysis/diagnosis/causes/catalogue.h"

namespace contour::diagnosis {

bool CanExtend(const std::string& kind) {
  const CauseDefinition* cause = FindCause(kind);
  return cause != nullptr && cause->extension != nullptr;
}

void AddCauses(const std::vector<Cause>& causes, double first_temperature_degC, ExtensionsConfig& e) {
  for (const Cause& c : causes)
    if (CanExtend(c.kind)) (*CauseNamed(c.kind).extension->add)(c, first_temperature_degC, e);
}

LogTemperature TemperatureOf(const AxisLog& log) {
  LogTemperature out;
  bool any = false;
  for (const double t : log.temperature_degC) {
    if (std::isnan(t)) continue;
    if (!any) out = {t, t};
    any = true;
    if (std::abs(t - out.first_degC) > std::abs(out.farthest_degC - out.first_degC)) out.farthest_degC = t;
  }
  return out;
}

}  // namespace contour::diagnosis
