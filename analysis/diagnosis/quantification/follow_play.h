#pragma once

#include "analysis/diagnosis/decision/accepted.h"

namespace contour::diagnosis {

/// Where a play is among what was accepted: the fit once more, with an observer that follows the reading as
/// quickly as the noise lets it, and the base alone (`nominal`). Where the slow one's fit ended is kept in
/// `accepted`. Where the play does not show behind the quicker one, all stays as it was, and the size is a
/// bound.
void FollowPlay(Problem& problem, Accepted& accepted, Fit& nominal);

/// What a quicker observer changed of the sizes of the cause at `place` of the fit, it may leave as much of:
/// the intervals are wider by it.
void WidenByObserver(const Problem& problem, const Accepted& accepted, std::size_t place, Cause& cause);

}  // namespace contour::diagnosis
