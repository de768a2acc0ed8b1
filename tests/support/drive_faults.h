#pragma once

#include <cstddef>
#include <cstdint>

#include "tools/plant_emulator/emulated_axis.h"
#include "tools/plant_emulator/emulated_machine.h"

namespace contour {

/// Breaks drives of an emulated machine.
class DriveFaults {
 public:
  /// EMCY with this code, fault reaction, Fault.
  static void Inject(EmulatedMachine& machine, std::size_t axis, std::uint16_t error_code) noexcept {
    machine.axis(axis).InjectFault(error_code);
  }
};

}  // namespace contour
