#pragma once

#include <string>
#include <vector>

#include "core/reason.h"
#include "core/states.h"
#include "tools/faults/fault_case.h"
#include "tools/faults/supervisor.h"
#include "tools/machine/load_emulated_machine.h"

namespace contour::faults {

/// What came of one run, by the emulator's truth.
struct RunResult {
  FaultCase c;
  bool stopped = false;           ///< the machine went to Faulted because of it
  Reason reason = Reason::kNone;  ///< of the stop
  std::uint8_t where = 0xFF;
  bool warned = false;       ///< the row's warning was seen
  double departure_m = 0.0;  ///< largest, until the torque was off
  double departure_bound_m = 0.0;
  double time_s = 0.0;  ///< until torque off or rest; of runs that stopped
  double time_bound_s = 0.0;
  std::vector<std::string> violations;  ///< broken invariants, in words

  [[nodiscard]] double DepartureShare() const { return departure_m / departure_bound_m; }
};

struct RunRequest {
  const EmulatedMachineFile* file = nullptr;
  std::uint64_t campaign_seed = 1;
  /// The supervisor in question: runs of its proof must give its reason. Null: none.
  const Supervisor* supervisor = nullptr;
  bool without = false;  ///< it is switched off
  /// The same machine as its file has it in csp (MachineInMode). Null: `file` with another mode.
  const EmulatedMachineFile* in_csp = nullptr;

  [[nodiscard]] const EmulatedMachineFile& In(DriveMode mode) const noexcept {
    return mode == DriveMode::kCsp && in_csp != nullptr ? *in_csp : *file;
  }
};

/// Bring-up, the machine's life to the phase, the fault, what becomes of it, the fault mended, reset, enable.
/// In virtual time; the same request gives the same result.
RunResult RunFault(const FaultCase& c, const RunRequest& request);

}  // namespace contour::faults
