#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "control/cnc_config.h"
#include "control/monitor_config.h"
#include "control/supervision_config.h"
#include "core/friction_kind.h"
#include "core/visit.h"

namespace contour {

/// Limits of one axis as the machine file states them (`axes.<name>.limits`). Field names are the YAML keys.
struct AxisLimits {
  std::array<double, 2> position_mm{-100.0, 100.0};
  double velocity_mm_s = 0.0;
  double acceleration_mm_s2 = 0.0;
  double jerk_mm_s3 = 0.0;
  double torque_Nm = 0.0;
  double torque_rate_Nm_s = 0.0;
  double following_error_mm = 0.0;
  double safe_travel_mm = 0.0;
  double external_force_N = 0.0;
  double slowest_feed_mm_s = 0.0;
  double unreferenced_travel_mm = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("position_mm", position_mm, kAny, "lowest and highest position of the table");
    v.Required("velocity_mm_s", velocity_mm_s, kPositive, "highest speed of a path");
    v.Required("acceleration_mm_s2", acceleration_mm_s2, kPositive, "highest acceleration of a path");
    v.Required("jerk_mm_s3", jerk_mm_s3, kPositive, "highest jerk of a path");
    v.Required("torque_Nm", torque_Nm, kPositive, "highest motor torque, either sign");
    v.Optional("torque_rate_Nm_s", torque_rate_Nm_s, kNotNegative, "highest change of torque; 0: no limit");
    v.Required("following_error_mm", following_error_mm, kPositive,
               "fault above this distance to the reference");
    v.Required("safe_travel_mm", safe_travel_mm, kPositive,
               "travel allowed to experiments, stops, and whatever goes wrong until the torque is off");
    v.Optional("external_force_N", external_force_N, kNotNegative,
               "largest force on the table besides friction (cutting, weight); 0: a quarter of rated force");
    v.Optional("slowest_feed_mm_s", slowest_feed_mm_s, kNotNegative,
               "from this speed of the axis on safe_travel_mm must be kept with a frozen encoder; 0: from "
               "where one shows within 30 ms");
    v.Optional(
        "unreferenced_travel_mm", unreferenced_travel_mm, kNotNegative,
        "of an axis without drive.absolute_encoder that was not told yet where it is: programs may take "
        "it so far to either side of where it was enabled; 0: no programs before `contour reference`");
  }
};

/// The same in SI, forces seen at the table (F = T / R).
struct AxisLimitsSi {
  double position_min_m = 0.0;
  double position_max_m = 0.0;
  double velocity_m_s = 0.0;
  double acceleration_m_s2 = 0.0;
  double jerk_m_s3 = 0.0;
  double torque_Nm = 0.0;
  double torque_rate_Nm_s = std::numeric_limits<double>::infinity();
  double force_N = 0.0;
  double force_rate_N_s = std::numeric_limits<double>::infinity();
  double following_error_m = 0.0;
  double safe_travel_m = 0.0;
  double external_force_N = 0.0;
  double unreferenced_travel_m = 0.0;
};

constexpr AxisLimitsSi ToSi(const AxisLimits& c, double radius_m_rad) noexcept {
  const double rate = c.torque_rate_Nm_s > 0.0 ? c.torque_rate_Nm_s : std::numeric_limits<double>::infinity();
  return {c.position_mm[0] * 1e-3,
          c.position_mm[1] * 1e-3,
          c.velocity_mm_s * 1e-3,
          c.acceleration_mm_s2 * 1e-3,
          c.jerk_mm_s3 * 1e-3,
          c.torque_Nm,
          rate,
          c.torque_Nm / radius_m_rad,
          rate / radius_m_rad,
          c.following_error_mm * 1e-3,
          c.safe_travel_mm * 1e-3,
          c.external_force_N,
          c.unreferenced_travel_mm * 1e-3};
}

/// PID with feed-forward, stated as pole frequencies so that one tuning fits axes of any mass.
struct PidConfig {
  double bandwidth_Hz = 30.0;
  double damping = 0.75;
  double integral_Hz = 14.0;
  double derivative_filter_Hz = 400.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("bandwidth_Hz", bandwidth_Hz, Range{0.1, 500.0},
               "natural frequency of position and velocity gain");
    v.Optional("damping", damping, Range{0.1, 10.0}, "damping ratio of position and velocity gain");
    v.Optional("integral_Hz", integral_Hz, Range{0.0, 200.0}, "corner frequency of the integral action");
    v.Optional("derivative_filter_Hz", derivative_filter_Hz, Range{1.0, 5000.0},
               "corner of the velocity filter");
  }
};

/// Drive cascade: the drive closes the loop on the target position.
struct CspConfig {
  bool torque_offset = false;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("torque_offset", torque_offset, kAny,
               "send the feed-forward torque as torque offset (0x60B2)");
  }
};

/// One tuning of the MPC. Weights are stated as the bandwidths of the unconstrained loop they lead to.
struct MpcConfig {
  std::int32_t horizon = 20;
  double contour_bandwidth_Hz = 35.0;
  double lag_bandwidth_Hz = 24.0;
  double rest_velocity_um_s = 10.0;
  std::int32_t iteration_cap = 30;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("horizon", horizon, Range{1.0, 40.0}, "cycles predicted");
    v.Optional("contour_bandwidth_Hz", contour_bandwidth_Hz, Range{0.1, 300.0},
               "weight of the error across the path");
    v.Optional("lag_bandwidth_Hz", lag_bandwidth_Hz, Range{0.1, 300.0}, "weight of the error along the path");
    v.Optional("rest_velocity_um_s", rest_velocity_um_s, kPositive,
               "path speed below which all directions weigh the same");
    v.Optional("iteration_cap", iteration_cap, Range{1.0, 1000.0}, "solver iterations allowed per cycle");
  }
};

/// Planning of what is followed where the reference asks for more than the torque can do (`full` only).
struct PlannerConfig {
  bool enabled = true;
  std::int32_t horizon = 30;
  double contour_bandwidth_Hz = 250.0;
  double lag_bandwidth_Hz = 25.0;
  double torque_share = 0.6;
  std::int32_t iteration_cap = 60;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("enabled", enabled, kAny, "plan corners that ask for more torque than there is");
    v.Optional("horizon", horizon, Range{5.0, 40.0}, "cycles planned");
    v.Optional("contour_bandwidth_Hz", contour_bandwidth_Hz, Range{0.1, 300.0},
               "weight of the planned error across the path");
    v.Optional("lag_bandwidth_Hz", lag_bandwidth_Hz, Range{0.1, 300.0},
               "weight of the planned error along the path");
    v.Optional("torque_share", torque_share, Range{0.05, 1.0},
               "share of torque_Nm to accelerate with; the rest is for friction and feedback");
    v.Optional("iteration_cap", iteration_cap, Range{1.0, 1000.0}, "solver iterations allowed per cycle");
  }
};

/// What the guard does beyond the axis limits.
struct GuardConfig {
  std::int32_t stale_cycles = 3;
  double overspeed_factor = 1.2;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("stale_cycles", stale_cycles, Range{1.0, 3.0},
               "fault after this many cycles without feedback");
    v.Optional("overspeed_factor", overspeed_factor, Range{1.0, 2.0},
               "fault above this multiple of velocity_mm_s");
  }
};

/// Tuning of every controller (`control:` of the machine file); every key is optional.
struct ControllerConfig {
  PidConfig pid;
  CspConfig csp;
  CncConfig cnc;
  // As stiff as stays stable with 30 % more or less inertia and one more cycle of delay: estimates that are
  // fed forward close a loop of their own and take their share of the margin.
  MpcConfig mpc{.contour_bandwidth_Hz = 42.0};
  MpcConfig mpc_observer{.contour_bandwidth_Hz = 28.0, .lag_bandwidth_Hz = 20.0};
  MpcConfig mpc_srukf4{.contour_bandwidth_Hz = 42.0};
  MpcConfig mpc_ekf7;
  MpcConfig mpc_srukf7;
  MpcConfig full;
  PlannerConfig planner;
  GuardConfig guard;
  SupervisionConfig supervision;
  MonitorConfig monitor;
  FrictionKind friction = FrictionKind::kSrukf;
  bool friction_stated = true;  ///< by the machine file; no key of it

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("pid", pid, "PID with feed-forward");
    v.Optional("csp", csp, "the drive's own position cascade");
    v.Optional("cnc", cnc, "the drive's own position cascade, with what numerical controls compensate");
    v.Optional("mpc", mpc, "MPC without compensation");
    v.Optional("mpc_observer", mpc_observer, "MPC with disturbance observer");
    v.Optional("mpc_srukf4", mpc_srukf4, "MPC with the 4-state friction filter");
    v.Optional("mpc_ekf7", mpc_ekf7, "MPC with the 7-state EKF");
    v.Optional("mpc_srukf7", mpc_srukf7, "MPC with the 7-state SRUKF");
    v.Optional(
        "full", full,
        "MPC with friction preview and wind-up compensation: in torque mode with friction: srukf. With "
        "friction: linear it has no effect (axes.<name>.loop is that loop's tuning); in csp only the "
        "slowest swing that is watched goes by it");
    v.Optional(
        "friction", friction, kAny,
        "what `full` knows friction by: srukf, states of its filter beside one rigid mass; linear, "
        "learnt along the reference, outside a loop that knows motor and table apart (torque mode: "
        "goes by axes.<name>.loop). In a file that does not say it is linear in torque mode (srukf where no "
        "loop is found at once and the filter serves: modes of motor against table above 300 Hz, times 1 ms "
        "over the cycle where that is longer); in csp linear where the table on its screw, the motor held, "
        "swings below 110 Hz, with a linear scale, or where a count of the encoder is more than Coulomb "
        "friction moves the axis by in a cycle, srukf elsewhere");
    v.Optional("planner", planner, "planning of corners");
    v.Optional("guard", guard, "torque guard");
    v.Optional("supervision", supervision, "how the machine watches its own control");
    v.Optional("monitor", monitor, "what motion and torque may contradict each other by");
  }
};

}  // namespace contour
