#include <gtest/gtest.h>

#include "config/load_machine.h"
#include "daemon/make_log_header.h"
#include "daemon/program_limits.h"
#include "tests/closed_loop/test_machine.h"
#include "tests/daemon/program/keeps_limits.h"
#include "tests/support/scratch_directory.h"
#include "tools/replay/replay_run.h"
#include "tools/simulate/run_log.h"

namespace contour::test {
namespace {

const std::string kMachine = std::string(CONTOUR_CONFIG_DIR) + "/xy_emulated.yaml";

/// Largest distance of the true table from the path while a program runs, and the points that it followed.
struct Seen {
  double peak_m = 0.0;
  double peak_while_paused_m = 0.0;
  std::uint64_t paused_cycles = 0;
  std::uint64_t cycles = 0;
};

/// A circle of 10 mm at 3 m/min, with whatever `during` does before each cycle.
Seen RunWith(const std::function<void(VirtualMachine&, std::uint64_t cycle)>& during, RunLog* log = nullptr) {
  const EmulatedMachineFile file = LoadEmulatedMachine(kMachine, {});
  VirtualMachine machine(file, ControllerName::kFull);
  if (log != nullptr) machine.SetRecorder([log](const CycleEntry& entry) { log->Add(entry); });
  machine.BringUp();
  machine.Enable();
  machine.Start(Circle(10.0, 4, 0.7957747155));
  LimitWatch watch(ProgramLimits(file.machine), 1e-3);
  Seen seen;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow* truth) {
    const CycleRecord& r = entry.output.record;
    if (r.state != MachineState::kRunning || truth == nullptr) return;
    PerAxis<ReferencePoint> axes;
    PerAxis<double> table;
    for (std::size_t i = 0; i < r.axes.size(); ++i) {
      axes.push_back(r.axes[i].reference);
      table.push_back(truth->axes[i].table_position_m);
    }
    watch.Add(axes);
    const double error_m = machine.plan()->Distance_m(table);
    if (machine.plan()->Scored(r.path_time_s)) seen.peak_m = std::max(seen.peak_m, error_m);
    if (r.pace == 0.0 && r.path_time_s > 0.1) {
      ++seen.paused_cycles;
      seen.peak_while_paused_m = std::max(seen.peak_while_paused_m, error_m);
    }
  });
  bool ran = false;
  for (; seen.cycles < 60'000; ++seen.cycles) {
    during(machine, seen.cycles);
    machine.Tick();
    const MachineState state = machine.record().state;
    ran = ran || state == MachineState::kRunning;
    if (ran && state != MachineState::kRunning) break;
  }
  EXPECT_EQ(machine.record().state, MachineState::kReady);
  EXPECT_EQ(machine.record().reason, Reason::kProgramEnd);
  watch.ExpectKept();
  return seen;
}

TEST(Pause, LeavesNoMarkAndReplaysBitForBit) {
  const Seen without = RunWith([](VirtualMachine&, std::uint64_t) {});
  ScratchDirectory scratch;
  const std::filesystem::path file = scratch.path() / "paused.lcmlog";
  {
    const MachineSource source = ReadSource(kMachine, {});
    RunLog log(file, MakeLogHeader(source, LoadMachine(source), "virtual", 0));
    // In every quadrant of the second turn, at a reversal too, and slowly over another part.
    const Seen with = RunWith(
        [](VirtualMachine& machine, std::uint64_t cycle) {
          switch (cycle) {
            case 1800:
            case 3100:
            case 4467:
            case 6010:
              return machine.SetPace(0.0);
            case 2500:
            case 4000:
            case 5200:
            case 9000:
              return machine.SetPace(1.0);
            case 7000:
              return machine.SetPace(0.35);
            default:
              return;
          }
        },
        &log);
    log.Close();
    EXPECT_GT(with.paused_cycles, 1000u);
    EXPECT_GT(with.cycles, without.cycles + 2500);
    EXPECT_LT(with.peak_while_paused_m, 1e-6);
    EXPECT_LT(with.peak_m, 1.2 * without.peak_m + 0.1e-6) << without.peak_m;
  }
  LogReader log(file);
  const ReplayReport report = Replay(log, {});
  EXPECT_EQ(report.verdict, ReplayVerdict::kSame) << report.message;
}

TEST(Pause, AStopEndsAPausedProgramAndRunIsRefusedMeanwhile) {
  const EmulatedMachineFile file = LoadEmulatedMachine(kMachine, {});
  VirtualMachine machine(file, ControllerName::kFull);
  machine.BringUp();
  machine.Enable();
  machine.Start(Circle(10.0, 4, 0.7957747155));
  for (int i = 0; i < 2000; ++i) machine.Tick();
  machine.SetPace(0.0);
  for (int i = 0; i < 5000; ++i) machine.Tick();
  ASSERT_EQ(machine.record().state, MachineState::kRunning);
  EXPECT_EQ(machine.record().pace, 0.0);
  const double place_m = machine.record().axes[0].reference.position_m;
  const std::uint32_t refused = machine.mailbox().Post(RequestKind::kRun, 99);
  for (int i = 0; i < 5; ++i) machine.Tick();
  EXPECT_EQ(machine.record().acknowledged, refused);
  EXPECT_FALSE(machine.record().acknowledged_ok);
  machine.mailbox().PostStop();
  for (int i = 0; i < 300; ++i) machine.Tick();
  EXPECT_EQ(machine.record().state, MachineState::kReady);
  EXPECT_EQ(machine.record().reason, Reason::kOperatorStop);
  EXPECT_EQ(machine.record().axes[0].reference.position_m, place_m);
}

// While the pace changes, and between a law of time and the next.
TEST(Pause, AStopAtAnyTimeEndsOnThePath) {
  for (int after = 0; after < 260; after += 20) {
    const EmulatedMachineFile file = LoadEmulatedMachine(kMachine, {});
    VirtualMachine machine(file, ControllerName::kFull);
    machine.BringUp();
    machine.Enable();
    machine.Start(Circle(10.0, 4, 0.7957747155));
    for (int i = 0; i < 1500; ++i) machine.Tick();
    machine.SetPace(after % 40 == 0 ? 0.0 : 0.4);
    for (int i = 0; i < after; ++i) machine.Tick();
    machine.mailbox().PostStop();
    double off_m = 0.0;
    for (int i = 0; i < 400 && machine.record().state != MachineState::kReady; ++i) {
      machine.Tick();
      PerAxis<double> reference;
      for (const AxisRecord& a : machine.record().axes) reference.push_back(a.reference.position_m);
      off_m = std::max(off_m, machine.plan()->Distance_m(reference));
    }
    EXPECT_EQ(machine.record().state, MachineState::kReady) << after;
    EXPECT_EQ(machine.record().reason, Reason::kOperatorStop) << after;
    EXPECT_LT(off_m, 1e-9) << after;
  }
}

}  // namespace
}  // namespace contour::test
