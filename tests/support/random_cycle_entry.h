#pragma once

#include <bit>
#include <cstdint>
#include <random>

#include "core/cycle_record.h"

namespace contour::test {

/// Cycle entries whose every field is random, doubles over all bit patterns (NaNs with payload and denormals
/// too), so that a field that is forgotten or changed on the way through a file or a socket shows.
class RandomCycleEntry {
 public:
  explicit RandomCycleEntry(std::uint64_t seed) : random_(seed) {}

  /// Consistent only in what readers check: cycle number and grid time, and no skipped grid points.
  CycleEntry Next(std::uint64_t cycle, std::size_t axes) {
    CycleEntry e;
    FillInput(e.input, axes);
    FillOutput(e.output, axes);
    // Within two seconds of the grid point, so that differences of them are numbers, too.
    for (std::int64_t* ns :
         {&e.timing.wakeup_late_ns, &e.timing.received_ns, &e.timing.stepped_ns, &e.timing.sent_ns,
          &e.timing.estimated_ns, &e.timing.decided_ns, &e.timing.after_send_ns, &e.timing.run_delay_ns})
      *ns = Int<std::int32_t>();
    e.timing.late = Bool();
    e.timing.cause = static_cast<LateCause>(Below(kLateCauses));
    e.timing.page_faults = Int<std::uint32_t>();
    e.timing.involuntary_switches = Int<std::uint32_t>();
    e.timing.voluntary_switches = Int<std::uint32_t>();
    e.input.cycle = e.output.record.cycle = cycle;
    e.input.grid_time_ns = e.output.record.grid_time_ns = static_cast<std::int64_t>(cycle) * 1'000'000;
    return e;
  }

 private:
  template <class T>
  T Int() {
    return static_cast<T>(random_());
  }
  double Double() { return std::bit_cast<double>(random_()); }
  bool Bool() { return (random_() & 1u) != 0; }
  std::size_t Below(std::size_t n) { return static_cast<std::size_t>(random_() % n); }

  void Fill(ReferencePoint& p) { p = {Double(), Double(), Double(), Double(), Double()}; }
  void Fill(StampedFrame& f) {
    f.frame.id = static_cast<std::uint16_t>(Below(0x800));
    f.frame.length = static_cast<std::uint8_t>(Below(9));
    for (auto& byte : f.frame.data) byte = Int<std::uint8_t>();
    f.bus = Int<std::uint8_t>();
    f.stamp_ns = Int<std::int64_t>();
  }
  void Fill(IoInput& io) { io = {Bool(), Bool(), Bool(), Bool(), Double()}; }

  void FillInput(CycleInput& in, std::size_t axes) {
    for (auto n = Below(kMaxFramesPerCycle + 1); n > 0; --n) {
      StampedFrame f;
      Fill(f);
      in.frames.push_back(f);
    }
    for (auto n = Below(kMaxBuses + 1); n > 0; --n)
      in.buses.push_back(BusInput{Bool(), Bool(), Int<std::uint32_t>()});
    for (auto n = Below(kMaxPathPointsPerCycle + 1); n > 0; --n) {
      PathPoint p;
      p.program_id = Int<std::uint32_t>();
      p.last = Bool();
      if (Bool()) p.index = Below(std::size_t{1} << 50);
      p.law = Int<std::uint32_t>();
      p.line = Int<std::uint32_t>();
      p.program_time_s = Double();
      p.axes.resize(axes);
      for (auto& axis : p.axes) Fill(axis);
      in.path.push_back(p);
    }
    in.request = {static_cast<RequestKind>(Below(7)), Int<std::uint32_t>(), Int<std::uint32_t>()};
    Fill(in.io);
  }

  void FillOutput(CycleOutput& out, std::size_t axes) {
    for (auto n = Below(kMaxFramesSentPerCycle + 1); n > 0; --n) {
      StampedFrame f;
      Fill(f);
      out.frames.push_back(f);
    }
    out.finished = Bool();
    out.quiescent = Bool();
    out.settling = Bool();
    CycleRecord& r = out.record;
    r.sync_number = Int<std::uint64_t>();
    r.feedback_sync = Int<std::uint64_t>();
    r.state = static_cast<MachineState>(Below(8));
    r.reason = static_cast<Reason>(Below(101));
    r.reason_axis = Int<std::uint8_t>();
    r.acknowledged = Int<std::uint32_t>();
    r.acknowledged_ok = Bool();
    r.program_id = Int<std::uint32_t>();
    r.path_time_s = Double();
    r.contour_error_m = Double();
    r.lag_error_m = Double();
    r.path_points_waiting = Int<std::uint16_t>();
    r.solver_iterations = Int<std::uint16_t>();
    r.stale_cycles = Int<std::uint64_t>();
    Fill(r.io);
    r.bring_up = {Int<std::uint8_t>(),  Int<std::uint8_t>(), Int<std::uint8_t>(),  Int<std::uint8_t>(),
                  Int<std::uint16_t>(), Int<std::uint8_t>(), Int<std::uint32_t>(), Int<std::uint32_t>(),
                  Int<std::uint32_t>(), Int<std::uint32_t>()};
    r.axes.resize(axes);
    for (auto& axis : r.axes) Fill(axis);
  }

  void Fill(AxisRecord& a) {
    a.feedback = {Double(), Double(), Double(), Int<std::uint16_t>(), static_cast<DriveState>(Below(9)),
                  Bool(),   Bool(),   Bool(),   Int<std::uint32_t>()};
    Fill(a.reference);
    for (double* d : {&a.estimate.position_m,
                      &a.estimate.velocity_m_s,
                      &a.estimate.predicted_position_m,
                      &a.estimate.predicted_velocity_m_s,
                      &a.estimate.friction_N,
                      &a.estimate.friction_std_N,
                      &a.estimate.bristle_N,
                      &a.estimate.g_plus_N,
                      &a.estimate.g_minus_N,
                      &a.estimate.disturbance_N,
                      &a.estimate.disturbance_std_N,
                      &a.estimate.stiffness_N_m,
                      &a.estimate.stiffness_std_N_m,
                      &a.estimate.sigma0_N_m,
                      &a.estimate.innovation_m,
                      &a.estimate.innovation_std_m,
                      &a.position_m,
                      &a.following_error_m,
                      &a.feedforward_Nm,
                      &a.wanted_torque_Nm,
                      &a.torque_Nm,
                      &a.target_position_rad})
      *d = Double();
    a.estimate.limit = static_cast<Reason>(Below(101));
    a.estimate.diverged = Bool();
    a.goal = static_cast<DriveGoal>(Below(5));
    a.limit = static_cast<Reason>(Below(101));
    a.emergency_code = Int<std::uint16_t>();
  }

  std::mt19937_64 random_;
};

}  // namespace contour::test
