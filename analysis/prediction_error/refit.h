#pragma once

#include <limits>

#include "analysis/prediction_error/fit.h"

namespace contour::diagnosis {

/// A fit for which the stated numbers would have to be off as they hardly ever are may have ended in a wrong
/// place: once more from where those numbers are back that are far off. The lower end counts. Whether it was
/// replaced. Where the excerpt ends above the cost that would be `worth` it, the whole log is spared.
bool FitFromStated(const Problem& problem, Fit& fit, const FitEffort& effort,
                   double worth = std::numeric_limits<double>::infinity());

double CostAt(const Problem& problem, const Point& point, Extent extent = Extent::kWhole);

/// The fit's own runs under the noise that was learnt since: both of the two below it, of which the residual
/// alone tells the cost.
void Rewhiten(const Problem& problem, Fit& fit);
void RewhitenResidual(const Problem& problem, Fit& fit);
void RewhitenSensitivities(const Problem& problem, Fit& fit);

/// From where a fit stands that was made under another noise or of other rows: its runs serve until they lead
/// astray.
Fit FitFrom(const Problem& problem, Fit fit, const FitEffort& effort);

}  // namespace contour::diagnosis
