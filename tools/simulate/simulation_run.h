#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/metrics/run_metrics.h"
#include "core/controller_name.h"
#include "daemon/program/part_of_program.h"
#include "daemon/program/program.h"
#include "daemon/program_tally.h"
#include "daemon/telemetry/log_header.h"
#include "tools/machine/load_emulated_machine.h"

namespace contour {

/// The feed from a time on.
struct FeedFrom {
  double time_s = 0.0;  ///< since the program began to run
  double feed = 1.0;    ///< 1 as programmed, 0 to 2
};

struct SimulationRequest {
  EmulatedMachineFile file;
  ControllerName controller = ControllerName::kFull;
  Program program;
  /// G-code, read anew for where the machine stands before each pass; `program` has its name.
  std::optional<std::string> gcode;
  PartOfProgram part{};       ///< of it
  std::filesystem::path log;  ///< of every cycle, for replay; empty: none
  LogHeader log_header;
  std::vector<FeedFrom> feeds;  ///< in order of time; of every pass
  int passes = 1;               ///< runs of the program, one after the other; the files are of the last
  std::filesystem::path out;    ///< directory for cycles.csv and metrics.json; made when missing
};

/// What came of it, of the last pass.
struct SimulationResult {
  RunMetrics metrics;
  TallyOfProgram tally;
};

/// Bring-up, enable, the program to its end, all in virtual time; then the files. With more passes than one
/// also passes.csv, one row each. Throws std::runtime_error
/// when the machine stops otherwise or a file cannot be written, ProgramError when the program does not fit
/// the machine.
SimulationResult RunSimulation(const SimulationRequest& request);

}  // namespace contour
