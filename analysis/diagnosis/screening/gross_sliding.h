#pragma once

#include <vector>

#include "analysis/prediction_error/fit.h"

namespace contour::diagnosis {

/// Travel of the table since the last reversal, m, per row. Friction says when the axis has turned; noise of
/// the reading does not.
std::vector<double> TravelSinceReversal(const Signals& signals);

/// Whether friction follows a law that is not the model's, not only with another stiffness in it:
/// an element that the model lacks is found in presliding, and in addition to it the bristle seems to hold
/// its force where it should wear (`rough` far below zero). What such a model says of presliding and of rest
/// is wrong, and what it says of gross sliding is not.
bool FrictionModelMismatch(const Problem& problem, const Fit& fit);

/// Rows that any law of friction calls a slide: far from the last reversal, by the bristle's length, and
/// faster than the Stribeck speed.
std::vector<bool> GrossSliding(const Problem& problem);

/// What a fit lowers the cost by. On a friction-model mismatch: in gross sliding and on the scale only,
/// except for kinds that show at a reversal or in the priors and nowhere else.
double DropOf(const Problem& problem, const Fit& without, const Fit& with);

}  // namespace contour::diagnosis
