#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tools/validation/family/family_machine.h"

namespace contour {

/// A controller, and the mode of the drives it is run in.
struct FamilyEntry {
  std::string controller;
  std::string mode;  ///< cst or csp
};

/// A program, then six seconds of hold, on one machine.
struct FamilyCell {
  FamilySetting setting;
  FamilyEntry entry;
  char program = 'B';  ///< a letter of FamilyPrograms()
  std::uint64_t seed = 1;
  bool hold = true;  ///< afterwards
};

struct FamilyResult {
  double wind_up_um = 0.0;  ///< the machine's F / K, unvaried
  double peak_um = 0.0;     ///< at the table, circles after the first turn, others from 1 s on
  double rms_um = 0.0;
  double hold_pp_um = 0.0;  ///< of the table's worst axis, in the last three seconds of hold
  /// Of the estimate of friction while the program is scored, axes together: share of the time in which it is
  /// off by less than two of its standard deviations, and these (rms) over the error's rms. 0: no estimate.
  double friction_inside_rel = 0.0;
  double friction_std_over_error = 0.0;
  double disturbance_inside_rel = 0.0;  ///< the same of the disturbance, as if no force came from outside
  double disturbance_std_over_error = 0.0;
  /// Of the screw's stiffness at the end of the program, on the axis that is farther off in standard
  /// deviations: these, and both relative to the truth.
  double stiffness_error_stds = 0.0;
  double stiffness_error_rel = 0.0;
  double stiffness_std_rel = 0.0;
  std::string failure{};  ///< why the machine stopped; empty: it did not
  bool refused = false;   ///< before motion, by its checks
};

/// B, C and S with their texts in YAML.
std::string FamilyProgram(char letter);

/// Of every tuning: no seed of a comparison.
inline constexpr std::uint64_t kTuningSeed = 101;

/// The machine file of a cell. Throws ConfigError for what its checks refuse.
EmulatedMachineFile LoadFamilyCell(const std::string& folder, const FamilyCell& cell);

/// Runs the daemon's cycle on the emulated machine in virtual time. A machine that is refused or stops is a
/// result; a program or name that does not exist throws ConfigError.
FamilyResult RunFamilyCell(const std::string& folder, const FamilyCell& cell);

/// All of them on so many threads, in their order. `done` has the number finished, one call at a time.
std::vector<FamilyResult> RunFamily(const std::string& folder, const std::vector<FamilyCell>& cells, int jobs,
                                    const std::function<void(std::size_t)>& done = {});

}  // namespace contour
