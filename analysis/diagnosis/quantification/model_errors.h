#pragma once

#include <array>

#include "analysis/diagnosis/result/finding.h"
#include "analysis/prediction_error/fit.h"

namespace contour::diagnosis {

/// One-step and free-run errors of the stated model, of its numbers as fitted without the causes
/// (`without`), and of all that was found (`with`). Free runs begin at the smoothed measurement and go on the
/// recorded command alone; those of the unseen parts by what the other half of the parts asks for (`halves`,
/// of the fit `with`).
void DescribeModelErrors(const Problem& problem, const Fit& without, const Fit& with,
                         const std::array<Point, 2>& halves, Diagnosis& out);

/// Says them in a note.
void TellModelErrors(const Problem& problem, Diagnosis& out);

/// Of a model named so, fitted to all parts, and of those fitted to either half on what they have not seen.
ForecastError ErrorsOf(const Problem& p, const char* name, const Point& all,
                       const std::array<Point, 2>& halves);

}  // namespace contour::diagnosis
