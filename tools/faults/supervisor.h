#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "daemon/rt/cycle_config.h"
#include "tools/faults/fault.h"
#include "tools/faults/phase.h"

namespace contour::faults {

/// A supervisor that --without can switch off, to show that the campaign misses it.
struct Supervisor {
  std::string_view name;
  std::string_view what;
  void (*off)(CycleConfig&);
  Fault missed;  ///< one that nobody else notices, or only under another name
  Phase where = Phase::kConstant;
  double feed_mm_s = 50.0;
  bool alone = true;  ///< false: others notice the same in time and with a reason of the row
};
const std::vector<Supervisor>& Supervisors();
/// Null when there is none of that name.
const Supervisor* FindSupervisor(std::string_view name);

}  // namespace contour::faults
