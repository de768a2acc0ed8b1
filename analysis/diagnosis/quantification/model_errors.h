#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

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

/// A model named so: fitted to all parts, and to either half of them; none where it was not fitted.
struct Forecast {
  const char* model = "";
  Point all;
  std::optional<std::array<Point, 2>> halves;
};

/// Of every model, and of those fitted to a half on what they have not seen.
std::vector<ForecastError> ErrorsOf(const Problem& p, std::span<const Forecast> forecasts);

}  // namespace contour::diagnosis
