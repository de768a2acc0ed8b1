#include "daemon/make_cycle_config.h"

#include <algorithm>

namespace contour {
namespace {

CycleAxisConfig MakeAxis(const std::string& name, const AxisConfig& axis, const EstimatorConfig& estimator) {
  CycleAxisConfig out;
  out.name = name;
  out.mechanics = ToSi(axis.model.mechanics);
  out.friction = axis.model.friction;
  out.estimator = estimator;
  out.limits = axis.limits;
  out.lag_s = axis.drive.lag_ms * 1e-3;
  out.encoder_counts_per_rev = static_cast<double>(axis.drive.encoder_counts_per_rev);
  return out;
}

}  // namespace

CycleConfig MakeCycleConfig(const MachineConfig& machine, ControllerName controller) {
  CycleConfig out;
  out.cycle_us = static_cast<std::uint32_t>(machine.machine.cycle_us);
  out.controller = controller;
  out.control = machine.control;
  out.master.cycle_us = out.cycle_us;
  for (const auto& [name, bus] : machine.buses) out.master.buses.push_back(bus);
  for (const auto& [name, axis] : machine.axes) {
    out.axes.push_back(MakeAxis(name, axis, machine.estimator));
    AxisDriveConfig drive{name, static_cast<std::uint8_t>(BusIndex(machine, axis.drive.bus)), axis.drive,
                          std::min(axis.limits.torque_Nm, axis.drive.peak_torque_Nm)};
    drive.drive.mode = controller == ControllerName::kCsp ? DriveMode::kCsp : DriveMode::kCst;
    out.master.axes.push_back(drive);
  }
  return out;
}

}  // namespace contour
