#pragma once

#include <cstddef>

#include "tools/plant_emulator/emulated_axis.h"
#include "tools/plant_emulator/emulated_machine.h"

namespace contour {

/// The way of contour_faults into an emulated machine's drives.
class MachineTamper {
 public:
  [[nodiscard]] static plant::EmulatedAxis& Axis(EmulatedMachine& machine, std::size_t axis) noexcept {
    return machine.axis(axis);
  }
};

}  // namespace contour
