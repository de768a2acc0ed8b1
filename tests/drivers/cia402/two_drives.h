#pragma once

#include <array>
#include <cstdint>
#include <numbers>
#include <span>

#include "drivers/can/loopback_bus.h"
#include "drivers/cia402/drive_master.h"
#include "tests/drivers/cia402/fake_slave.h"

namespace contour::test {

inline constexpr double kRated_Nm = 0.637;
inline constexpr double kRadPerCount = 2.0 * std::numbers::pi / 1048576.0;

inline DriveConfig Drive(int node_id) {
  DriveConfig d;
  d.bus = "main";
  d.node_id = node_id;
  d.rated_torque_Nm = kRated_Nm;
  d.peak_torque_Nm = 1.91;
  d.encoder_counts_per_rev = 1048576;
  d.identity = IdentityConfig{0x1234, 0x5678, 1};
  return d;
}

inline MasterConfig TwoAxes() {
  MasterConfig c;
  c.axes = {{"x", 0, Drive(1), 1.5}, {"y", 0, Drive(2), 1.5}};
  BusConfig bus;
  bus.interface = "loopback";
  bus.listen_ms = 0.0;  // nobody else is there; tests of the listening itself say how long
  c.buses = {bus};
  return c;
}

/// Master and two fake slaves on a loopback bus; one Cycle is one millisecond.
class Machine {
 public:
  explicit Machine(const MasterConfig& config = TwoAxes())
      : master(config), setpoints(config.axes.size()), bus_(1'000'000, {&slave[0], &slave[1]}) {}

  void Cycle() {
    CycleInput& in = input_;
    in.cycle = ++cycle_;
    in.grid_time_ns = now_ns();
    in.frames.clear();
    in.buses.clear();
    std::array<StampedFrame, kMaxFramesPerCycle> received;
    const std::size_t n = bus_.Receive(now_ns(), received);
    for (std::size_t i = 0; i < n; ++i) {
      received[i].stamp_ns += stamp_offset_ns;
      in.frames.push_back(received[i]);
    }
    in.buses.push_back({bus_.State().up, false, 0});
    master.Receive(in);
    sent.clear();
    master.Send(setpoints, sent);
    for (const StampedFrame& f : sent) bus_.Send(now_ns(), std::span(&f.frame, 1));
  }
  void Cycles(int n) {
    for (int i = 0; i < n; ++i) Cycle();
  }
  /// Runs until bringing up has ended one way or the other.
  void BringUp() {
    master.StartBringUp();
    for (int i = 0; i < 5000 && !master.operational() && !master.bring_up_failed(); ++i) Cycle();
  }
  void Goal(DriveGoal goal) {
    for (AxisSetpoint& s : setpoints) s.goal = goal;
  }
  /// Cycles until both drives are at the goal, at most `limit`.
  int Reach(DriveGoal goal, int limit = 100) {
    Goal(goal);
    int n = 0;
    do {
      Cycle();
      ++n;
    } while (n < limit && !(master.status()[0].at_goal && master.status()[1].at_goal));
    return n;
  }
  [[nodiscard]] std::int64_t now_ns() const { return static_cast<std::int64_t>(cycle_) * 1'000'000; }
  [[nodiscard]] BringUpError error() const { return static_cast<BringUpError>(master.bring_up().error); }
  /// A frame of somebody else on the bus.
  void Inject(const CanFrame& frame) { bus_.Inject(now_ns(), frame); }
  [[nodiscard]] bool SentSync() const {
    for (const StampedFrame& f : sent)
      if (f.frame == SyncFrame()) return true;
    return false;
  }
  /// A frame of somebody else that is on the wire at the next grid point, and has hardly begun.
  void BeginFrame(const CanFrame& frame) { bus_.Inject(now_ns() + 999'000, frame); }
  /// From now on the bus tells when our SYNCs were on the wire.
  void TellOfSync() { bus_.TellOf(cob::kSync); }
  void SetLink(bool up) { bus_.SetLink(now_ns(), up); }
  void Skip(std::uint64_t cycles) { cycle_ += cycles; }

  std::array<FakeSlave, 2> slave{FakeSlave(1), FakeSlave(2)};
  DriveMaster master;
  PerAxis<AxisSetpoint> setpoints;
  DriveMaster::Frames sent;
  std::int64_t stamp_offset_ns = 0;

 private:
  LoopbackBus bus_;
  CycleInput input_;
  std::uint64_t cycle_ = 0;
};

}  // namespace contour::test
