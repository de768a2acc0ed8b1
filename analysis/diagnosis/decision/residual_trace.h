#pragma once

#include <vector>

#include "analysis/diagnosis/result/finding.h"
#include "analysis/prediction_error/fit.h"

namespace contour::diagnosis {

/// u that has to be taken off the command for the model to move as measured (applied minus modelled), from
/// the observer's corrections, low-passed at about 100 Hz; 0 where rows do not count.
Signal TorqueResidual(const Problem& problem, const Point& point);

/// The same, of what Problem::Raw gives for the point.
Signal TorqueResidualFrom(const Problem& problem, const Point& point, const std::vector<double>& raw);

/// Of two fits under the problem's setup, whose runs serve.
Traces MakeTraces(const Problem& problem, const Fit& before, const Fit& after);

/// A wave that is mostly faster than what the torque's smoothing leaves: it shows in the rows only.
bool FasterThanTheTorque(const Problem& problem, const Effect& effect);

}  // namespace contour::diagnosis
