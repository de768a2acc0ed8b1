#pragma once

#include "analysis/prediction_error/fit.h"

namespace contour::diagnosis {

/// The most lag, in exchange for delay, that a coupling is which is no fault of an axis stated as rigid:
/// 1 / w^2 is half of what the square of the lag has more.
double MostLagForDelay(const Problem& problem, const Point& point);

/// Where the base's exchange of delay for lag is off as it hardly ever is: what it may be. A coupling acts as
/// a lag that came with less delay, up to what one at half the rate of the rows does, and never as a delay
/// that came with less lag. Whether the exchange's deviation is another one since.
bool AdmitCouplings(Problem& problem, const Fit& fit);

}  // namespace contour::diagnosis
