#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/controller_name.h"
#include "core/cycle_record.h"
#include "daemon/learning/program_learning.h"
#include "daemon/path_feeder.h"
#include "daemon/program/placed_program.h"
#include "daemon/program/program.h"
#include "daemon/rt/command_mailbox.h"
#include "daemon/rt/cycle.h"
#include "daemon/rt/cycle_config.h"
#include "daemon/rt/cycle_runner.h"
#include "drivers/can/bus_node.h"
#include "drivers/can/loopback_bus.h"
#include "tools/machine/load_emulated_machine.h"
#include "tools/plant_emulator/emulated_machine.h"

namespace contour {

/// What stands around the cycle besides the emulated machine, for experiments with faults.
struct Surroundings {
  /// More participants of each bus, by the bus's number. They must outlive the machine.
  std::vector<std::vector<BusNode*>> nodes{};
  /// What the cycle is given for the master's end of a bus; it must outlive the machine.
  std::function<FrameBus*(std::size_t bus, LoopbackBus& inner)> wrap{};
  /// Changes what the cycle is made of, besides the machine file.
  std::function<void(CycleConfig&)> configure{};
  /// Requests are taken at once, as in real time, instead of when the machine has settled.
  bool prompt = false;
};

/// The daemon's own cycle on an emulated machine in virtual time: loopback buses, no threads, no waiting. The
/// same machine file, program and seed give the same cycles every time, on every host. A temperature sensor
/// of the machine file shows the emulated screw's; other inputs are closed.
class VirtualMachine {
 public:
  /// Sees every cycle with the truth of the instant its feedback was latched at (null before there is any).
  using Observer = std::function<void(const CycleEntry& entry, const TruthRow* truth)>;

  VirtualMachine(const EmulatedMachineFile& file, ControllerName controller,
                 EmulatedClock clock = EmulatedClock::kSync, const Surroundings& surroundings = {});
  ~VirtualMachine();

  void SetObserver(Observer observer) { observer_ = std::move(observer); }
  /// Sees every cycle, besides the observer.
  void SetRecorder(std::function<void(const CycleEntry& entry)> record) { record_ = std::move(record); }

  /// Brings the drives up and waits until the machine is Idle and at rest. Throws std::runtime_error with the
  /// reason.
  void BringUp();
  /// Enables and waits until the machine holds.
  void Enable();
  /// Asks for a program and supplies its points from now on; the caller ticks. Gives the request's sequence.
  /// `feed`: that it begins with, 1 as programmed.
  std::uint32_t Start(const Program& program, double feed = 1.0);
  /// As Start() would plan it.
  [[nodiscard]] std::shared_ptr<const MotionPlan> PlanOf(const Program& program) const;
  /// Programs count from where the machine stands now, instead of each from where it begins.
  void SetZero();
  /// G-code for where the machine stands. Throws ProgramError.
  [[nodiscard]] Program ReadGcode(const std::string& text, const std::string& name,
                                  const PartOfProgram& part = {}) const;
  /// Runs a program to its end, learning as the machine file says: by its name and place a program is known.
  /// Throws std::runtime_error with the reason when the machine stops otherwise.
  void Run(const Program& program, double feed = 1.0);
  /// The same of a plan that PlanOf() has given, with the machine where it stood then.
  void Run(const Program& program, std::shared_ptr<const MotionPlan> plan, double feed);
  /// The feed that the program shall go to; 1 as programmed, 0 a pause, 2 at most.
  void SetPace(double feed) { feeder_.SetPace(feed); }
  /// One more cycle, whatever the state.
  void Tick();
  /// So many grid points go by without a cycle, as on an overloaded host. What time does to the plant
  /// meanwhile is for EmulatedClock::kWall to show; with kSync it stands still.
  void SkipGridPoints(std::uint64_t count) { index_ += count; }

  /// Whether the frames of the last cycle left late, which virtual time never does by itself.
  void TellLate(bool late) { cycle_.TellLate(late); }

  CommandMailbox& mailbox() { return mailbox_; }
  LoopbackBus& bus(std::size_t i) { return *buses_[i]; }
  EmulatedMachine& emulated() { return emulated_; }
  void SetIo(IoSource& io);
  [[nodiscard]] const CycleEntry& last() const { return *entry_; }
  [[nodiscard]] const CycleRecord& record() const { return entry_->output.record; }
  /// Of the last program run.
  [[nodiscard]] std::shared_ptr<const MotionPlan> plan() const { return plan_; }
  [[nodiscard]] const std::vector<std::string>& axis_names() const { return axis_names_; }

 private:
  class TruthMemory;

  [[nodiscard]] PerAxis<double> StandsAt_m() const;
  [[nodiscard]] Placement PlaceNow() const;
  std::uint32_t Start(const Program& program, std::shared_ptr<const MotionPlan> plan, double feed);
  void TickUntilSettled(MachineState wanted, const char* doing);
  [[noreturn]] void Fail(const std::string& doing) const;

  std::vector<std::string> axis_names_;
  std::vector<std::string> bus_names_;
  PerAxis<PlanLimits> limits_;
  EventUse events_;
  bool block_delete_;
  std::string tool_table_;
  EmulatedMachine emulated_;
  std::unique_ptr<TruthMemory> truths_;
  std::vector<std::unique_ptr<LoopbackBus>> buses_;
  std::vector<FrameBus*> bus_pointers_;
  CommandMailbox mailbox_;
  Cycle cycle_;
  std::unique_ptr<IoSource> io_;
  std::unique_ptr<CycleRunner> runner_;
  PathFeeder feeder_;
  ProgramLearning learning_;
  std::int64_t period_ns_;
  std::uint64_t index_ = 0;
  std::uint32_t program_id_ = 0;
  bool settling_ = false;
  bool prompt_;
  std::unique_ptr<CycleEntry> entry_;
  std::shared_ptr<const MotionPlan> plan_;
  std::optional<PerAxis<double>> zero_m_;
  Observer observer_;
  std::function<void(const CycleEntry&)> record_;
};

}  // namespace contour
