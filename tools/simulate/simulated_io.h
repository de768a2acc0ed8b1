#pragma once

#include <cmath>

#include "daemon/rt/io_source.h"
#include "drivers/modbus/io_config.h"
#include "tools/plant_emulator/emulated_machine.h"

namespace contour {

/// What the Modbus server of the emulated machine would say, without a network: circuits closed, the screw's
/// temperature of the first axis in whole counts.
class SimulatedIo final : public IoSource {
 public:
  SimulatedIo(const TemperatureInputConfig& sensor, const EmulatedMachine& machine)
      : sensor_(sensor), machine_(machine) {}

  IoInput Read(std::int64_t) noexcept override {
    IoInput io;
    io.configured = io.fresh = io.emergency_stop_ok = io.enable_chain_ok = true;
    const auto& axes = machine_.truth().axes;
    const double true_degC = axes.empty() ? sensor_.offset_degC : axes[0].temperature_degC;
    const double counts = std::round((true_degC - sensor_.offset_degC) / sensor_.degC_per_count);
    io.screw_temperature_degC = sensor_.offset_degC + counts * sensor_.degC_per_count;
    return io;
  }

 private:
  TemperatureInputConfig sensor_;
  const EmulatedMachine& machine_;
};

}  // namespace contour
