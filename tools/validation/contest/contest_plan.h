#pragma once

#include <string>
#include <vector>

#include "tools/validation/contest/contest_cell.h"
#include "tools/validation/contest/contest_config.h"

namespace contour {

/// What of the contest is run.
struct ContestChoice {
  std::vector<std::string> controllers;
  std::vector<std::string> programs;
  std::vector<std::string> machines;
  std::vector<std::int64_t> seeds;
};

/// Everything, or what `short` lists.
ContestChoice DefaultChoice(const ContestConfig& config, bool shorter);

/// Throws ConfigError naming the first unknown controller, program or machine, and the known ones.
void CheckChoice(const ContestConfig& config, const ContestChoice& choice);

/// The same for a list of controllers that an option gives.
void CheckControllers(const ContestConfig& config, const std::vector<std::string>& controllers,
                      const std::string& option);

/// The assignments of a machine and a program on a machine file, as `contour simulate --set` takes them.
std::vector<std::string> Assignments(const std::string& machine_file, const ContestMachine& machine,
                                     const ContestProgram& program);

/// The cells of a choice, program by program, machine by machine, seed by seed, controllers innermost.
/// `extra`: assignments for all of them.
std::vector<ContestCell> PlanCells(const ContestConfig& config, const ContestChoice& choice,
                                   const std::string& machine_file, const std::vector<std::string>& extra);

/// Cells of any programs on any machines: tuning has its own, and nobody enters in a way of his own there.
std::vector<ContestCell> PlanCells(const std::vector<ContestProgram>& programs,
                                   const std::vector<ContestMachine>& machines,
                                   const std::vector<std::int64_t>& seeds,
                                   const std::vector<std::string>& controllers,
                                   const std::string& machine_file, const std::vector<std::string>& extra,
                                   const std::vector<ContestEntry>& entries = {});

}  // namespace contour
