#pragma once

#include <string>

#include "analysis/diagnosis/causes/specimen.h"
#include "tools/validation/hidden/hidden_case.h"

// What validation hides, from the catalogue of diagnosis.
namespace contour::hidden {

/// Of a cause; null for effects from outside the catalogue.
const diagnosis::Specimen* SpecimenOf(const std::string& kind);

diagnosis::SpecimenMachine MachineOf(const Setting& setting);
diagnosis::Drawn DrawnOf(const Hidden& hidden);

/// All of the catalogue.
std::vector<std::string> CatalogueKinds();

}  // namespace contour::hidden
