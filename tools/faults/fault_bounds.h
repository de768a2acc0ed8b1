#pragma once

#include "config/machine_config.h"
#include "tools/faults/fault_case.h"

namespace contour::faults {

/// What the machine file promises of an axis when something breaks.
struct RunBound {
  double departure_m = 0.0;  ///< from the commanded path, until the torque is off
  double time_s = 0.0;       ///< from the fault to no torque, or rest
};

/// Of the travel, what a scale or an encoder that counts too little leaves out.
inline constexpr double kCountsMissing_rel = 0.02;

/// Encoder and motor faults, which only what the axis does can show.
bool ShownByMotion(Fault fault);
/// The axis stands, or moves so slowly that its torque cannot tell what stands.
bool Crawls(const MachineConfig& machine, const FaultCase& c);
/// How far the encoder jumps in this case.
double JumpSize_mm(const MachineConfig& machine, const FaultCase& c);
/// Whether that is more than is promised to be seen, at every speed that the axis may have.
bool JumpIsSeen(const MachineConfig& machine, const FaultCase& c);

/// For the axis that is broken, at the feed of the run.
RunBound RunBoundOf(const MachineConfig& machine, const FaultCase& c);
/// For an axis that stops because another one is broken.
RunBound BoundOfOthers(const MachineConfig& machine, const FaultCase& c, std::size_t axis);

}  // namespace contour::faults
