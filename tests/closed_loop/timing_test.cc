#include <gtest/gtest.h>

#include <map>

#include "daemon/make_cycle_config.h"
#include "drivers/cia301/messages.h"
#include "tests/closed_loop/test_machine.h"
#include "tests/support/allocation_guard.h"

namespace contour::test {
namespace {

/// Remembers the truth of every SYNC.
class TruthLog final : public TruthSink {
 public:
  void OnTruth(const TruthRow& row) noexcept override {
    if (!row.free_running) rows[row.sync_number] = row;
  }
  std::map<std::uint64_t, TruthRow> rows;
};

TEST(CycleTiming, FromSampleToTorqueIsExactlyOnePeriod) {
  const EmulatedMachineFile file =
      ExampleMachine({"emulator.axes.x.lag_ms=0.01", "emulator.axes.y.lag_ms=0.01"});
  VirtualMachine machine(file, ControllerName::kFull);
  TruthLog truths;
  machine.BringUp();
  machine.Enable();
  machine.emulated().SetTruthSink(&truths);
  std::map<std::uint64_t, std::pair<double, double>> sent;  // by SYNC: torque, feedback's SYNC
  std::map<std::uint64_t, double> position_rad;             // by SYNC that latched it
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow*) {
    const CycleRecord& r = entry.output.record;
    sent[r.sync_number] = {r.axes[0].torque_Nm, static_cast<double>(r.feedback_sync)};
    position_rad[r.feedback_sync] = r.axes[0].feedback.position_rad;
  });
  machine.Run(Circle(0.1, 2, 2.0));
  machine.emulated().SetTruthSink(nullptr);
  int compared = 0;
  int moved = 0;
  for (const auto& [sync, torque] : sent) {
    if (!truths.rows.contains(sync) || !truths.rows.contains(sync + 1) || !sent.contains(sync - 1)) continue;
    EXPECT_EQ(torque.second, static_cast<double>(sync - 1))
        << "the command of SYNC " << sync << " uses the sample before";
    if (truths.rows.contains(sync - 1) && position_rad.contains(sync - 1)) {
      EXPECT_NEAR(position_rad[sync - 1], truths.rows[sync - 1].axes[0].reported_position_rad, 1e-9);
    }
    // The lag is 10 us: one period after SYNC the torque is that of the command that this SYNC took over, not
    // the one before. A command that acted only 10 us later would be off by 1/e of the step.
    const double acting = truths.rows[sync + 1].axes[0].torque_Nm;
    EXPECT_NEAR(truths.rows[sync].axes[0].command_Nm, torque.first, 1e-12);
    EXPECT_NEAR(acting, torque.first, 1e-9);
    if (std::abs(torque.first - sent[sync - 1].first) > 1e-3) ++moved;
    ++compared;
  }
  EXPECT_GT(compared, 500);
  EXPECT_GT(moved, 50) << "the torque must change for this to prove anything";
}

// What the cycle is told of a SYNC has to be what the plant goes by: a plant that every SYNC steps by a
// period knows no late one, whatever was on the bus before it.
TEST(CycleTiming, ASyncIsToldToBeLateWhereItLatchesALaterPosition) {
  for (const EmulatedClock clock : {EmulatedClock::kSync, EmulatedClock::kWall}) {
    VirtualMachine machine(ExampleMachine(), ControllerName::kFull, clock);
    machine.BringUp();
    machine.Enable();
    double at_s = 0.0, latched_s = 0.0, latest_s = 0.0;
    int compared = 0;
    machine.SetObserver([&](const CycleEntry& entry, const TruthRow* truth) {
      double told_s = 1e-9 * static_cast<double>(entry.input.grid_time_ns);
      for (const StampedFrame& f : entry.input.frames)
        if (f.frame.id == cob::kOwnSync) told_s = 1e-9 * static_cast<double>(f.stamp_ns);
      ASSERT_NE(truth, nullptr);
      if (latched_s != 0.0) {
        EXPECT_NEAR(truth->time_s - latched_s, told_s - at_s, 1e-9);
        latest_s = std::max(latest_s, truth->time_s - latched_s - 1e-3);
        ++compared;
      }
      at_s = told_s;
      latched_s = truth->time_s;
    });
    machine.Run(Circle(10.0, 1, 0.8));
    EXPECT_GT(compared, 1000);
    if (clock == EmulatedClock::kSync)
      EXPECT_NEAR(latest_s, 0.0, 1e-9);
    else
      EXPECT_GT(latest_s, 1e-6) << "our own frames before it have stuff bits";
  }
}

/// Why the single axis does not come up; empty when it does.
std::string WhyNotUp(const std::vector<std::string>& overrides) {
  VirtualMachine machine(
      LoadEmulatedMachine(std::string(CONTOUR_CONFIG_DIR) + "/single_axis.yaml", overrides),
      ControllerName::kFull);
  try {
    machine.BringUp();
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return {};
}

TEST(CycleTiming, ADriveThatAnswersACycleLateFromTheStartIsNotEnabled) {
  for (const char* mode : {"cst", "csp"}) {
    for (const int period_us : {1000, 500}) {
      for (const double periods : {0.0, 1.05, 1.5, 2.05}) {
        const std::string why =
            WhyNotUp({"axes.x.drive.mode=" + std::string(mode),
                      "machine.cycle_us=" + std::to_string(period_us), "realtime.send_deadline_us=40",
                      "emulator.axes.x.answer_delay_us=" + std::to_string(periods * period_us)});
        SCOPED_TRACE(mode + (" " + std::to_string(period_us)) + " " + std::to_string(periods) + ": " + why);
        if (periods == 0.0)
          EXPECT_EQ(why, "");
        else
          EXPECT_NE(why.find("axis x: the drive's answers to SYNC (TPDO1) come later than a cycle"),
                    std::string::npos);
      }
    }
  }
}

/// Calls Step alone under the guard, through a bring-up, a program and a fault.
TEST(CycleAllocations, StepNeverTouchesTheHeap) {
  if (!AllocationGuard::kAvailable) GTEST_SKIP() << "the sanitizer owns the heap";
  for (const ControllerName controller :
       {ControllerName::kFull, ControllerName::kPid, ControllerName::kCsp, ControllerName::kMpcObserver,
        ControllerName::kMpcSrukf4, ControllerName::kMpcEkf7}) {
    const EmulatedMachineFile file = ExampleMachine();
    std::vector<CycleInput> inputs;
    {
      VirtualMachine machine(file, controller);
      machine.SetObserver([&](const CycleEntry& entry, const TruthRow*) { inputs.push_back(entry.input); });
      machine.BringUp();
      machine.Enable();
      machine.Run(Circle(0.1, 1, 2.0));
      machine.bus(0).SetLink(static_cast<std::int64_t>(inputs.size()) * 1'000'000, false);
      for (int i = 0; i < 20; ++i) machine.Tick();
    }
    Cycle cycle(MakeCycleConfig(file.machine, controller));
    CycleOutput out;
    std::size_t calls = 0;
    for (const CycleInput& in : inputs) {
      const AllocationGuard guard;
      cycle.Step(in, out);
      calls += guard.calls();
    }
    EXPECT_EQ(calls, 0u) << Name(controller);
    EXPECT_EQ(out.record.state, MachineState::kFaulted) << "the run must have gone through a fault";
  }
}

/// The cycle is a function of its inputs: the recorded inputs give the recorded outputs, bit for bit.
TEST(CycleReplay, RecordedInputsGiveTheRecordedTorques) {
  const EmulatedMachineFile file = ExampleMachine();
  std::vector<CycleInput> inputs;
  std::vector<double> torques;
  VirtualMachine machine(file, ControllerName::kFull);
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow*) {
    inputs.push_back(entry.input);
    for (const AxisRecord& a : entry.output.record.axes) torques.push_back(a.wanted_torque_Nm);
  });
  machine.BringUp();
  machine.Enable();
  machine.Run(Circle(0.1, 1, 2.0));
  Cycle cycle(MakeCycleConfig(file.machine, ControllerName::kFull));
  CycleOutput out;
  std::size_t k = 0;
  for (const CycleInput& in : inputs) {
    cycle.Step(in, out);
    for (const AxisRecord& a : out.record.axes)
      ASSERT_EQ(a.wanted_torque_Nm, torques[k++]) << "cycle " << in.cycle;
  }
}

}  // namespace
}  // namespace contour::test
