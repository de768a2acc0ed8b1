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

/// Root mean square of free runs of `seconds` over the rows [from, to) of the log, window after window.
double FreeRunError(const Problem& problem, const AxisModel& model, double seconds, std::size_t from,
                    std::size_t to);

}  // namespace contour::diagnosis
