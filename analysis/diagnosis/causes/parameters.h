#pragma once

#include "analysis/diagnosis/result/finding.h"
#include "analysis/prediction_error/fit.h"

namespace contour::diagnosis {

/// Parameters of the fit's effect `index` by the catalogue's names, with 95 % intervals, and its shapes. The
/// intervals come from draws of the fit's covariance.
void DescribeEffect(const Problem& problem, const Fit& fit, std::size_t index, Cause& cause);
/// From draws that are there: deviations of the fit's parameters, one column each.
void DescribeEffect(const Problem& problem, const Fit& fit, std::size_t index, const Eigen::MatrixXd& draws,
                    Cause& cause);

}  // namespace contour::diagnosis
