#pragma once

#include "analysis/diagnosis/result/finding.h"
#include "analysis/prediction_error/problem.h"

namespace contour::diagnosis {

/// A note where the torque (force) that the model leaves, averaged for as long as a free run lasts, goes far
/// beyond what it is over the rest of the log, and beyond what Coulomb friction is stated to be off by: a
/// force from outside for some seconds passes for noise.
void TellSlowTorque(const Problem& problem, Diagnosis& out);

}  // namespace contour::diagnosis
