#pragma once

#include <string>

#include "design/loop_report.h"
#include "design/loop_search.h"

namespace contour {

/// SearchLoop; and where friction is among what leaves no loop within the limits, a loop for an axis that
/// creeps badly but slides and stands well (CreepingSet, StickSlipOf), if there is one: then its verdict is
/// of that set. Whether what was found is good enough is for ReportOn and WhatIsWrong to say.
FoundLoop FindLoop(const LoopAxis& axis, double period_s, const LoopSearchOptions& options = {});

/// Why what was found is not good enough, of both searches where there were two; `report` is on its tuning.
/// Empty where it is.
std::string WhyRefused(const FoundLoop& found, const LoopReport& report);

}  // namespace contour
