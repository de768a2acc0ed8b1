#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "analysis/drive_loop/drive_record.h"
#include "analysis/recording/axis_log.h"
#include "config/machine_config.h"
#include "daemon/control_socket/control_client.h"
#include "design/commission_plan.h"
#include "tools/contour/commission_options.h"

namespace contour {

/// Throws std::runtime_error where a stop is requested (stop_signals.h): interrupted, and `what` of it.
void ThrowIfInterrupted(const std::string& what = "nothing was written");

/// The machine stopped by itself, which may be its loop's doing.
class MachineStopped : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Whether the axis's drive closes its loop.
bool DriveLeads(const MachineConfig& machine, const std::string& axis);

/// What the operator allowed goes for the axis that was asked for.
CommissionLimits LimitsFor(const MachineConfig& machine, const std::string& axis,
                           const CommissionOptions& options);

/// The motions from where the axis stands, within those limits.
CommissionPlan PlanFor(const MachineConfig& machine, const nlohmann::json& status, const std::string& axis,
                       const CommissionOptions& options);

/// What an axis did.
struct CommissionRecord {
  diagnosis::AxisLog log;
  std::vector<DriveSample> drive_samples;
  std::uint64_t lost_cycles = 0;
};

/// Attends and enables the machine, moves the axis within what the plan allows, takes the torque off. Throws,
/// with the torque off, where something is not as it should be; MachineStopped where it ended in a fault.
CommissionRecord Record(ControlClient& client, const MachineConfig& machine, const CommissionPlan& plan);

}  // namespace contour
