#pragma once

#include <filesystem>

#include "core/controller_name.h"
#include "daemon/program/program.h"
#include "daemon/telemetry/log_header.h"
#include "tools/machine/load_emulated_machine.h"

namespace contour {

struct SimulationRequest {
  EmulatedMachineFile file;
  ControllerName controller = ControllerName::kFull;
  Program program;
  std::filesystem::path log;  ///< of every cycle, for replay; empty: none
  LogHeader log_header;
  int passes = 1;             ///< runs of the program, one after the other; the files are of the last
  std::filesystem::path out;  ///< directory for cycles.csv and metrics.json; made when missing
};

/// Bring-up, enable, the program to its end, all in virtual time; then the files. With more passes than one
/// also passes.csv, one row each. Throws std::runtime_error
/// when the machine stops otherwise or a file cannot be written, ProgramError when the program does not fit
/// the machine.
void RunSimulation(const SimulationRequest& request);

}  // namespace contour
