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

}  // namespace contour
