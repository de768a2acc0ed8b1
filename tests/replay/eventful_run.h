#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "tools/simulate/virtual_machine.h"

namespace contour::test {

/// I/O that a test switches.
class SwitchedIo final : public IoSource {
 public:
  IoInput Read(std::int64_t) noexcept override { return input; }
  IoInput input{true, true, true, true, 20.0};
};

/// A machine in virtual time to which everything happens that a cycle must cope with: programs, stops, a bus
/// that goes down, an emergency stop, a following error, a drive that fails, resets.
class EventfulRun {
 public:
  EventfulRun(const EmulatedMachineFile& file, ControllerName controller);

  VirtualMachine& machine() { return machine_; }
  void Tick(int cycles);
  /// False when the state does not come within `limit` cycles.
  bool TickUntil(MachineState state, int limit = 5000);
  void BringUp();
  void Enable();
  /// Begins a program (YAML) and gives it so many cycles.
  void Start(const std::string& program, int cycles);
  void Stop();
  void Disable();
  void LoseBus();
  void EmergencyStop();
  void LoseIo();
  void FailDrive();
  void FollowingError();
  /// After a fault: to Idle.
  void Reset();
  void Terminate();

  /// All reasons that were seen.
  [[nodiscard]] const std::set<Reason>& reasons() const { return reasons_; }

 private:
  [[noreturn]] void Fail(const std::string& what) const;

  SwitchedIo io_;
  VirtualMachine machine_;
  std::set<Reason> reasons_;
};

/// One after the other, until so many cycles have run, and an orderly end. The machine is on from cycle 1.
void RunEverything(EventfulRun& run, std::uint64_t cycles);

}  // namespace contour::test
