#pragma once

#include "analysis/diagnosis/decision/hypothesis.h"

namespace contour::diagnosis {

/// Whether `r`, about timing, does the same as `best`. A delay, a lag and a coupling too stiff for its
/// resonance to show have a time in all, which the log tells; how it is shared shows in its square alone, as
/// does the coupling that an axis stated as rigid has anyway. `alike`: scores that differ by less are.
bool SameTiming(const Problem& problem, const Hypothesis& best, const Hypothesis& r, double alike);

}  // namespace contour::diagnosis
