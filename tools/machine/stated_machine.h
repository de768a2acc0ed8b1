#pragma once

#include "config/machine_config.h"
#include "tools/plant_emulator/emulator_config.h"

namespace contour {

/// How far every emulated axis is off what the file states of it, in standard deviations of its own.
struct OffStated {
  double inertia = 0.0;  ///< of motor and table, by what is known worse
  double stiffness = 0.0;
};

/// An emulated machine whose axes are what the file's models state, but for that; in the middle of their
/// strokes. Of extensions it has what is another number of the model, and cogging.
EmulatorConfig StatedMachine(const MachineConfig& machine, const OffStated& off = {});

}  // namespace contour
