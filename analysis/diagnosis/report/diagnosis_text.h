#pragma once

#include <string>

#include "analysis/axis_model/extension_keys.h"
#include "analysis/diagnosis/result/finding.h"

namespace contour::diagnosis {

/// Of a linear axis sizes are told in N and m, of others in Nm and rad.
ExtensionUnits UnitsIn(const Diagnosis& d);

/// What was found, how sure, what it gains and what to do next, in plain words; lines of at most 100
/// characters.
std::string DiagnosisText(const Diagnosis& diagnosis);

/// The first sentence of it.
std::string VerdictText(const Diagnosis& diagnosis);

}  // namespace contour::diagnosis
