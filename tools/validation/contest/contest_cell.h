#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/controller_name.h"
#include "daemon/program/program.h"
#include "tools/machine/load_emulated_machine.h"

namespace contour {

/// One run of the contest.
struct ContestCell {
  ControllerName controller = ControllerName::kFull;
  std::string program_name;
  std::string machine_name;
  std::uint64_t seed = 1;
  Program program;
  int passes = 1;                                      ///< runs of it; the last is scored
  std::shared_ptr<const EmulatedMachineFile> machine;  ///< but for the seed
  std::uint64_t source = 0;                            ///< stands for the texts of program and machine
};

/// What came of it. Errors are those at the table; infinite when the machine stopped on the way.
struct CellResult {
  double peak_um = 0.0;
  double rms_um = 0.0;
  double encoder_peak_um = 0.0;
  std::optional<double> circular_deviation_um;
  std::vector<double> window_peak_um;  ///< table, per turn or per eighth of the program; scored part
  std::string failure;                 ///< why the machine stopped; empty: it did not

  [[nodiscard]] bool failed() const { return !failure.empty(); }
};

/// Runs the daemon's cycle on the emulated machine in virtual time, as `contour simulate` does.
CellResult RunCell(const ContestCell& cell);

/// Does the error grow from turn to turn? The last peak is more than twice the first, and more than twice
/// the one after the worst, where that is not the last itself; it is above half a micrometre, and larger than
/// the one before, which is larger than the one before that.
bool Growing(const CellResult& result);

}  // namespace contour
