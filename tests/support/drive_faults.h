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
  /// EMCY and nothing else: the drive goes on.
  static void Report(EmulatedMachine& machine, std::size_t axis, std::uint16_t error_code,
                     std::uint8_t error_register) noexcept {
    machine.axis(axis).SendEmergency(error_code, error_register);
  }
  /// The encoder stands where it is, and the motor gives no torque; the drive reports none either.
  static void Freeze(EmulatedMachine& machine, std::size_t axis) noexcept {
    machine.axis(axis).tampering().Freeze();
    machine.axis(axis).tampering().WeakenTorque(0.0, true);
  }
  /// The encoder counts from elsewhere.
  static void Displace(EmulatedMachine& machine, std::size_t axis, std::int64_t counts) noexcept {
    machine.axis(axis).tampering().Jump(counts);
  }
  /// So much is added to the torque that it is sent, from the next SYNC on: for measurements.
  static void Push(EmulatedMachine& machine, std::size_t axis, double torque_Nm) noexcept {
    machine.axis(axis).tampering().PushTarget(torque_Nm);
  }
  /// The drive's supply fails for a moment: it forgets what it was told, and says boot-up.
  static void Restart(EmulatedMachine& machine, std::size_t axis) noexcept {
    machine.axis(axis).InterruptSupply();
  }
};

}  // namespace contour
