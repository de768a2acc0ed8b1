#include "tools/machine/placements.h"

namespace contour {

std::vector<EmulatedAxisPlacement> EmulatedPlacements(const MachineConfig& machine) {
  std::vector<EmulatedAxisPlacement> out;
  for (const auto& [name, axis] : machine.axes) {
    EmulatedAxisPlacement p;
    p.name = name;
    p.bus = BusIndex(machine, axis.drive.bus);
    p.node_id = static_cast<std::uint8_t>(axis.drive.node_id);
    p.lead_mm = axis.model.mechanics.lead_mm;
    p.rated_torque_Nm = axis.drive.rated_torque_Nm;
    p.peak_torque_Nm = axis.drive.peak_torque_Nm;
    p.encoder_counts_per_rev = static_cast<double>(axis.drive.encoder_counts_per_rev);
    if (axis.drive.linear_scale) p.scale_counts_per_mm = axis.drive.linear_scale->counts_per_mm;
    out.push_back(p);
  }
  return out;
}

}  // namespace contour
