#pragma once

#include "design/loop_search.h"

namespace contour {

/// SearchLoop; and where friction is what leaves no loop within the limits, a loop for an axis that creeps
/// badly but slides and stands well (CreepingSet, StickSlipOf), if there is one: then its verdict is of that
/// set. Whether what was found is good enough is for ReportOn and WhatIsWrong to say.
FoundLoop FindLoop(const LoopAxis& axis, double period_s, const LoopSearchOptions& options = {});

}  // namespace contour
