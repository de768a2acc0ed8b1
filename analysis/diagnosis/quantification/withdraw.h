#pragma once

#include "analysis/diagnosis/decision/accepted.h"

namespace contour::diagnosis {

/// Causes were accepted one after the other, and the fit of all of them may not need one any more. The first
/// whose size in `out` is zero within its interval, and its other numbers too or its evidence no more than
/// chance may bring about, is taken out again: of the model, of `accepted` and of `out`, where a note tells
/// it; `fit` is the fit of what is left. Whether there was one. What the priors decide stays, and all of it
/// next to a shape from outside the catalogue.
bool WithdrawIdle(const Problem& problem, Fit& fit, Accepted& accepted, Diagnosis& out);

}  // namespace contour::diagnosis
