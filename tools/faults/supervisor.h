#pragma once

#include <string_view>
#include <vector>

#include "core/reason.h"
#include "core/watch.h"
#include "tools/faults/fault.h"
#include "tools/faults/fault_case.h"
#include "tools/faults/phase.h"

namespace contour::faults {

/// A supervisor that --without can switch off, and the fault that shows what it is good for: with it the
/// machine stops by its reason, without it the campaign fails.
struct Supervisor {
  Watch watch;
  std::string_view what;
  Fault fault;
  Phase phase = Phase::kConstant;
  double feed_mm_s = 50.0;
  Reason reason = Reason::kNone;  ///< stricter than the fault's row, where several may give theirs
  WatchesOff nearer;              ///< see this fault sooner: switched off with it and without it
  bool scale = false;             ///< shown on axes with a linear scale
};
const std::vector<Supervisor>& Supervisors();
/// Null when there is none of that name.
const Supervisor* FindSupervisor(std::string_view name);
/// The runs that show what it is good for: its fault and phase at its feed.
PlanRequest ProofOf(const Supervisor& supervisor);

}  // namespace contour::faults
