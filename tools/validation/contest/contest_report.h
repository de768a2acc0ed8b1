#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "tools/validation/contest/contest_verdict.h"

namespace contour {

/// One row per run.
void WriteContestCsv(std::ostream& out, const std::vector<Heat>& heats);

/// The table: a row per program and machine, medians over the seeds, the best in bold; then the aims, where
/// `full` loses, and whether the rivals reach their figures. `command` is what made it.
void WriteContestMarkdown(std::ostream& out, const std::vector<Heat>& heats, const Verdict& verdict,
                          const std::string& command);

/// The aims and the losses, for a terminal.
std::string VerdictText(const Verdict& verdict);

}  // namespace contour
