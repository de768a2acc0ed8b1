// The stopping bounds that `contour check` prints, against the emulated machine at full speed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "config/stopping.h"
#include "tests/closed_loop/test_machine.h"
#include "tests/support/drive_faults.h"

namespace contour::test {
namespace {

class SwitchedIo final : public IoSource {
 public:
  IoInput Read(std::int64_t) noexcept override { return input; }
  IoInput input{true, true, true, true, 20.0};
};

struct Measured {
  double time_s = 0.0;
  std::vector<double> travel_mm;
};

/// Both axes near their velocity limit on a straight line when something happens.
class StopBounds : public ::testing::TestWithParam<int> {
 protected:
  StopBounds()
      : file_(ExampleMachine({"emulator.seed=" + std::to_string(GetParam())})),
        machine_(file_, ControllerName::kFull) {
    machine_.SetIo(io_);
    machine_.BringUp();
    machine_.Enable();
    Start();
  }

  void Start() {
    const Program line = ParseProgram("{shape: line, dx_mm: 150, dy_mm: 150, feed_mm_min: 21000}",
                                      "line of the test", ProgramFormat::kYaml);
    PerAxis<double> start_m;
    for (const AxisRecord& a : machine_.record().axes) start_m.push_back(a.reference.position_m);
    PerAxis<PlanLimits> limits;
    for (const char* name : {"x", "y"}) limits.push_back({name, -0.2, 0.2, 0.25, 5.0, 200.0});
    generator_ = std::make_unique<PathGenerator>(line, start_m, limits, 1e-3, 1);
    machine_.mailbox().Post(RequestKind::kRun, 1);
    held_ = generator_->Next(point_);
    for (int i = 0; i < 1000 && AxisSpeed() < 0.245; ++i) Tick();
    ASSERT_GT(AxisSpeed(), 0.245);
  }

  void Tick() {
    while (held_ && machine_.mailbox().PushPathPoint(point_)) held_ = generator_->Next(point_);
    machine_.Tick();
  }

  double AxisSpeed() {
    double speed_m_s = 0.0;
    for (const AxisTruth& a : Truth().axes) speed_m_s = std::max(speed_m_s, std::abs(a.table_velocity_m_s));
    return speed_m_s;
  }

  const TruthRow& Truth() { return machine_.emulated().truth(); }

  [[nodiscard]] bool Stopped(bool off) {
    bool stopped = AxisSpeed() < 1e-4;
    for (const AxisTruth& a : Truth().axes)
      stopped = stopped &&
                (!off || (a.drive_state != DriveState::kOperationEnabled &&
                          a.drive_state != DriveState::kQuickStopActive && std::abs(a.torque_Nm) < 1e-6));
    return stopped;
  }

  /// From now to rest, `off`: and no torque; for good, so the machine is watched for a while longer.
  Measured Measure(bool off) {
    const double begin_s = Truth().time_s;
    std::vector<double> begin_m;
    for (const AxisTruth& a : Truth().axes) begin_m.push_back(a.table_position_m);
    Measured m{0.0, std::vector<double>(begin_m.size(), 0.0)};
    for (int i = 0; i < 400; ++i) {
      Tick();
      for (std::size_t a = 0; a < begin_m.size(); ++a)
        m.travel_mm[a] =
            std::max(m.travel_mm[a], 1e3 * std::abs(Truth().axes[a].table_position_m - begin_m[a]));
      if (!Stopped(off)) m.time_s = Truth().time_s - begin_s;
    }
    EXPECT_TRUE(Stopped(off));
    return m;
  }

  /// `added_s`: what the bound holds for the inputs that this test sets at once.
  void ExpectWithin(const std::string& way, const Measured& m, double added_s = 0.0) {
    for (const StopWay& bound : StopWays(file_.machine)) {
      if (bound.name != way) continue;
      double time_s = 0.0;
      for (std::size_t a = 0; a < m.travel_mm.size(); ++a) {
        time_s = std::max(time_s, bound.axes[a].time_s - added_s);
        EXPECT_LE(m.travel_mm[a], bound.axes[a].travel_mm - 250.0 * added_s) << way << ", axis " << a;
        // At constant speed the torque that a silent master leaves behind is far from the limit that the
        // bound reckons with.
        EXPECT_GT(m.travel_mm[a], 0.3 * (bound.axes[a].travel_mm - 250.0 * added_s))
            << way << ": a bound far too wide";
      }
      EXPECT_LE(m.time_s, time_s) << way;
      EXPECT_GT(m.time_s, 0.3 * time_s) << way << ": a bound far too wide";
      return;
    }
    FAIL() << "no bound for " << way;
  }

  EmulatedMachineFile file_;
  SwitchedIo io_;
  VirtualMachine machine_;
  std::unique_ptr<PathGenerator> generator_;
  PathPoint point_;
  bool held_ = false;
};

TEST_P(StopBounds, OperatorStop) {
  machine_.mailbox().PostStop();
  ExpectWithin("operator stop", Measure(false));
}

TEST_P(StopBounds, Terminate) {
  machine_.mailbox().PostTerminate();
  ExpectWithin("SIGTERM, SIGINT", Measure(true));
}

TEST_P(StopBounds, DriveFault) {
  DriveFaults::Inject(machine_.emulated(), 1, 0x3210);
  ExpectWithin("fault (quick stop)", Measure(true));
}

TEST_P(StopBounds, EmergencyStop) {
  io_.input.emergency_stop_ok = false;
  ExpectWithin("emergency-stop input", Measure(true), 0.12);
}

TEST_P(StopBounds, EnableChain) {
  io_.input.enable_chain_ok = false;
  ExpectWithin("enable-chain input", Measure(true), 0.12);
}

TEST_P(StopBounds, IoOld) {
  io_.input.fresh = false;
  ExpectWithin("Modbus server silent", Measure(true), 0.1);
}

TEST_P(StopBounds, BusDown) {
  machine_.bus(0).SetLink(machine_.last().input.grid_time_ns, false);
  ExpectWithin("bus lost (interface down)", Measure(true));
}

INSTANTIATE_TEST_SUITE_P(Seeds, StopBounds, ::testing::Values(1, 2, 3));

}  // namespace
}  // namespace contour::test
