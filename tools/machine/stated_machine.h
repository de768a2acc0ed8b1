#pragma once

#include "config/machine_config.h"
#include "tools/plant_emulator/emulator_config.h"

namespace contour {

/// How far an emulated axis is off what the file states, as factors.
struct OffStated {
  double inertia = 1.0;  ///< of motor and table
  double stiffness = 1.0;
};

/// An emulated machine whose axes are what the file's models state, but for these factors; in the middle of
/// their strokes. Of extensions it has what is another number of the model.
EmulatorConfig StatedMachine(const MachineConfig& machine, const OffStated& off = {});

}  // namespace contour
