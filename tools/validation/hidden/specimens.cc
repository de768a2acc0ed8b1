#include "tools/validation/hidden/specimens.h"

#include "analysis/diagnosis/causes/catalogue.h"
#include "tools/validation/hidden/machine_text.h"

namespace contour::hidden {

const diagnosis::Specimen* SpecimenOf(const std::string& kind) {
  const diagnosis::CauseDefinition* cause = diagnosis::FindCause(kind);
  return cause == nullptr ? nullptr : *cause->specimen;
}

diagnosis::SpecimenMachine MachineOf(const Setting& s) {
  const TrueAxis& t = s.truth;
  return {.friction_Nm = t.Fc_N * t.radius_m_rad(),
          .vs_rad_s = t.vs_rad_s(),
          .speed_limit_rad_s = kSpeedLimit_mm_s * 1e-3 / t.radius_m_rad(),
          .emulated_stroke_mm = EmulatedStroke_mm(t),
          .travel_mm = 2.0 * t.half_stroke_mm,
          .other_axis = "y"};
}

diagnosis::Drawn DrawnOf(const Hidden& h) { return {h.size, h.order, h.phase_rad, h.second}; }

std::vector<std::string> CatalogueKinds() {
  std::vector<std::string> kinds;
  for (const diagnosis::CauseDefinition* cause : diagnosis::AllCauses())
    if (cause->specimen != nullptr) kinds.emplace_back(*cause->name);
  return kinds;
}

}  // namespace contour::hidden
