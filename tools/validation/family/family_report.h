#pragma once

#include <ostream>
#include <vector>

#include "tools/validation/family/family_run.h"

namespace contour {

/// One row per run.
void WriteFamilyCsv(std::ostream& out, const std::vector<FamilyCell>& cells,
                    const std::vector<FamilyResult>& results);

/// A row per machine and variation, a column per controller and mode: peaks of the programs at the table over
/// F / K, and the largest swing of the holds, medians over the seeds. "stopped" when any seed's machine did.
void WriteFamilyTable(std::ostream& out, const std::vector<FamilyCell>& cells,
                      const std::vector<FamilyResult>& results);

/// How many times the error of `full` that of `cnc` is, machine by machine, `full` in the mode that draws the
/// better C (the better first program where C did not run); then the medians. Nothing when either did not
/// run.
void WriteFamilyRatios(std::ostream& out, const std::vector<FamilyCell>& cells,
                       const std::vector<FamilyResult>& results);

}  // namespace contour
