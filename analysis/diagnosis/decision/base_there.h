#pragma once

#include <cstddef>

#include "analysis/diagnosis/decision/hypothesis.h"

namespace contour::diagnosis {

/// Where a base lies that does without the last effect. What that has freed of the base stays where it is.
Point WithoutLast(const Problem& problem, Point point);
/// The same of the effect at a place.
Point Without(const Problem& problem, Point point, std::size_t place);

/// Whether a fit with sensitivities that are not its own may end lower than another one by more than `enough`
/// with its own: it promises that, or ended more than `lost` above and says nothing.
bool MayLieLower(const Fit& there, const Fit& here, double enough, double lost);

/// Whether a base that begins where the hypothesis lies ends so much lower than the one at hand that it
/// explains most of what the hypothesis was to explain; then it is the base.
bool BaseLiesThere(const Problem& problem, const Hypothesis& r, const FitEffort& effort, Fit& current);

}  // namespace contour::diagnosis
