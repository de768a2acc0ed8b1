#pragma once

#include "analysis/diagnosis/decision/accepted.h"

namespace contour::diagnosis {

/// Sizes and intervals of all that was accepted, from one fit of all of it; the numbers of the model, the
/// traces and what the data was like. The fit that it all comes from, which begins where the accepted one was
/// and takes its place.
Fit Quantify(const Problem& problem, const Fit& nominal, Accepted& accepted, const DiagnoseOptions& options,
             Diagnosis& out);

}  // namespace contour::diagnosis
