#pragma once

#include <memory>
#include <vector>

#include "daemon/rt/telemetry_queue.h"
#include "tools/faults/fault_case.h"
#include "tools/faults/intruder.h"
#include "tools/faults/meddling_bus.h"
#include "tools/plant_emulator/random.h"
#include "tools/plant_emulator/tampering.h"
#include "tools/simulate/virtual_machine.h"

namespace contour::faults {

/// Breaks a virtual machine, and mends it.
class Injection {
 public:
  Injection(const FaultCase& c, const MachineConfig& machine, plant::Random& random);

  /// What the machine is to be built with.
  [[nodiscard]] Surroundings surroundings();
  void Attach(VirtualMachine& machine) { machine_ = &machine; }

  void Break();
  void Mend();
  /// Every cycle: the log is emptied, unless that is what is broken.
  void AfterCycle(const CycleEntry& entry);

  /// Somebody else commands the drives now, whatever this machine wants.
  [[nodiscard]] bool foreign_setpoints() const noexcept {
    return broken_ && c_.fault == Fault::kForeignSetpoint;
  }

 private:
  [[nodiscard]] std::int64_t now_ns() const { return machine_->last().input.grid_time_ns; }
  [[nodiscard]] std::uint16_t Id(std::uint16_t base) const {
    return static_cast<std::uint16_t>(base + drive_.node_id);
  }
  int Draw(int from, int to);  // both included
  [[nodiscard]] double CountsPerMm() const;
  void BreakFrames(Meddling meddling) { buses_[bus_]->Begin(meddling); }
  void BreakBus();
  void BreakDrive(plant::EmulatedAxis& axis);
  void BreakEncoder(plant::EmulatedAxis& axis);
  void BreakScale(plant::Tampering& scale);
  void Intrude();
  void Flood(bool forever);

  FaultCase c_;
  const MachineConfig& config_;
  const AxisConfig& axis_;
  const DriveConfig& drive_;
  std::size_t bus_;
  plant::Random& random_;
  VirtualMachine* machine_ = nullptr;
  std::vector<std::unique_ptr<Intruder>> intruders_;
  std::vector<std::unique_ptr<MeddlingBus>> buses_;
  std::unique_ptr<TelemetryQueue> queue_;
  bool broken_ = false;
};

}  // namespace contour::faults
