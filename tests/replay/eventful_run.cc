#include "tests/replay/eventful_run.h"

#include <stdexcept>

#include "daemon/program/path_generator.h"
#include "tests/support/drive_faults.h"

namespace contour::test {
namespace {

constexpr const char* kCircle = "{shape: circle, radius_mm: 10, turns: 50, feed_mm_min: 900}";
constexpr const char* kSmallCircle = "{shape: circle, radius_mm: 0.1, turns: 2, frequency_hz: 1}";
constexpr const char* kFastLine = "{shape: line, dx_mm: 30, dy_mm: 0, feed_mm_min: 15000}";

}  // namespace

EventfulRun::EventfulRun(const EmulatedMachineFile& file, ControllerName controller)
    : machine_(file, controller) {
  machine_.SetIo(io_);
}

void EventfulRun::Tick(int cycles) {
  for (int i = 0; i < cycles; ++i) {
    machine_.Tick();
    reasons_.insert(machine_.record().reason);
  }
}

bool EventfulRun::TickUntil(MachineState state, int limit) {
  for (int i = 0; i < limit; ++i) {
    Tick(1);
    if (machine_.record().state == state) return true;
  }
  return false;
}

void EventfulRun::Fail(const std::string& what) const {
  const CycleRecord& r = machine_.record();
  throw std::runtime_error(what + ": the machine is " + std::string(Name(r.state)) + ", " +
                           std::string(Name(r.reason)) + ", in cycle " + std::to_string(r.cycle));
}

void EventfulRun::BringUp() {
  if (!TickUntil(MachineState::kIdle)) Fail("bring-up");
}

void EventfulRun::Enable() {
  machine_.mailbox().Post(RequestKind::kEnable);
  if (!TickUntil(MachineState::kReady)) Fail("enabling");
}

void EventfulRun::Start(const std::string& program, int cycles) {
  machine_.Start(ParseProgram(program, "program of the test", ProgramFormat::kYaml));
  TickUntil(MachineState::kRunning, 3000);
  Tick(cycles);
}

void EventfulRun::Stop() {
  machine_.mailbox().PostStop();
  Tick(150);
}

void EventfulRun::Disable() {
  machine_.mailbox().Post(RequestKind::kDisable);
  TickUntil(MachineState::kIdle);
}

void EventfulRun::LoseBus() {
  machine_.bus(0).SetLink(machine_.last().input.grid_time_ns, false);
  Tick(400);
  machine_.bus(0).SetLink(machine_.last().input.grid_time_ns, true);
  Tick(50);
}

void EventfulRun::EmergencyStop() {
  io_.input.emergency_stop_ok = false;
  Tick(200);
  io_.input.emergency_stop_ok = true;
}

void EventfulRun::LoseIo() {
  io_.input.fresh = false;
  Tick(200);
  io_.input.fresh = true;
}

void EventfulRun::FailDrive() {
  DriveFaults::Inject(machine_.emulated(), 1, 0x3210);
  Tick(200);
}

// Points that no program of this machine could hold: several times the acceleration there is torque for.
void EventfulRun::FollowingError() {
  constexpr std::uint32_t kProgram = 77;
  PerAxis<double> start_m;
  PerAxis<PlanLimits> limits;
  for (std::size_t i = 0; i < machine_.axis_names().size(); ++i) {
    start_m.push_back(machine_.record().axes[i].reference.position_m);
    limits.push_back({machine_.axis_names()[i], -0.2, 0.2, 0.25, 40.0, 8000.0});
  }
  PathGenerator generator(ParseProgram(kFastLine, "line of the test", ProgramFormat::kYaml), start_m, limits,
                          1e-3, kProgram);
  machine_.mailbox().Post(RequestKind::kRun, kProgram);
  PathPoint point;
  bool held = generator.Next(point);
  for (int i = 0; i < 3000 && machine_.record().state != MachineState::kFaulted; ++i) {
    while (held && machine_.mailbox().PushPathPoint(point)) held = generator.Next(point);
    Tick(1);
  }
  Tick(100);
}

void EventfulRun::Reset() {
  machine_.mailbox().Post(RequestKind::kReset);
  if (!TickUntil(MachineState::kIdle)) Fail("reset");
}

void EventfulRun::Terminate() {
  machine_.mailbox().PostTerminate();
  for (int i = 0; i < 3000 && !machine_.last().output.finished; ++i) Tick(1);
}

void RunEverything(EventfulRun& run, std::uint64_t cycles) {
  using Event = void (EventfulRun::*)();
  static constexpr Event kFaults[] = {&EventfulRun::LoseBus, &EventfulRun::EmergencyStop,
                                      &EventfulRun::FollowingError, &EventfulRun::FailDrive,
                                      &EventfulRun::LoseIo};
  run.BringUp();
  for (int round = 0; run.machine().record().cycle + 5000 < cycles; ++round) {
    run.Enable();
    run.Start(kCircle, 700);
    run.Stop();
    run.Start(kSmallCircle, 2500);
    const Event fault = kFaults[round % 5];
    if (fault != &EventfulRun::FollowingError) run.Start(kCircle, 300 + 37 * round);
    (run.*fault)();
    run.Reset();
    run.Enable();
    run.Start(kCircle, 211);
    run.Disable();
  }
  run.Enable();
  run.Start(kCircle, 0);
  while (run.machine().record().cycle + 500 < cycles) run.Tick(1);
  run.Terminate();
}

}  // namespace contour::test
