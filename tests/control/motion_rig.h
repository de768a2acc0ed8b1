#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "control/motion_monitor.h"

namespace contour {

inline constexpr double kPeriod_s = 1e-3;

inline MonitoredAxis Axis(double counts_per_mm = 209715.2) {
  MonitoredAxis a;
  a.motor_mass_kg = 79.0;
  a.table_mass_kg = 10.0;
  a.stiffness_N_m = 40e6;
  a.Fs_N = 50.0;
  a.Fc_N = 40.0;
  a.sigma0_N_m = 5e6;
  a.sigma2_Ns_m = 500.0;
  a.slide_m_s = 0.01;
  a.force_limit_N = 1885.0;
  a.external_force_N = 200.0;
  a.rated_force_N = 800.0;
  a.count_m = 1e-3 / counts_per_mm;
  a.loop_Hz = 40.0;
  return a;
}

/// A rigid axis with Dahl friction, unlike anything the product has, under a proportional loop with
/// feed-forward; what its encoder tells and what its motor gives can be meddled with.
class Rig {
 public:
  explicit Rig(const MonitoredAxis& axis = Axis())
      : axis_(axis), mass_kg_(axis.motor_mass_kg + axis.table_mass_kg), monitor_(axis, {}, kPeriod_s) {}

  std::function<double(double)> tells = [](double p) { return p; };
  double torque_share = 1.0;
  bool reports = true;
  double external_N = 0.0;
  double mass_factor = 1.0;
  bool fresh = true;

  /// One period at this reference speed; what the monitor says.
  Reason Step(double speed_m_s) {
    // The plant, over the period that ends with this sample, under the force sent one period ago.
    const double given_N = torque_share * acting_N_;
    constexpr int kSub = 20;
    for (int i = 0; i < kSub; ++i) {
      const double dt = kPeriod_s / kSub;
      const double g = v_ * z_ > 0.0 ? 1.0 - std::abs(z_) * axis_.sigma0_N_m / (1.05 * axis_.Fc_N) : 1.0;
      z_ += v_ * g * dt;
      const double friction_N = axis_.sigma0_N_m * z_ + 500.0 * v_;
      v_ += (given_N + external_N - friction_N) / (mass_factor * mass_kg_) * dt;
      p_ += v_ * dt;
    }
    const double read_m = std::floor(tells(p_) / axis_.count_m + 0.5) * axis_.count_m;
    MotionSample s;
    s.enabled = true;
    s.fresh = fresh;
    s.position_m = read_m;
    s.sent_force_N = sent_N_;
    s.reported_force_N = reports ? given_N : acting_N_;
    s.reference_m = reference_m_;
    const Reason reason = monitor_.Step(s);
    // The loop, on what it is told.
    const double w = 2.0 * 3.14159265 * axis_.loop_Hz;
    const double error_m = reference_m_ - read_m;
    const double told_v = (read_m - read_before_m_) / kPeriod_s;
    read_before_m_ = read_m;
    integral_m_s_ += error_m * kPeriod_s;
    const double wanted_N =
        mass_kg_ * (w * w * (error_m + 20.0 * integral_m_s_) + 1.4 * w * (speed_m_s - told_v)) +
        mass_kg_ * (speed_m_s - speed_before_m_s_) / kPeriod_s;
    speed_before_m_s_ = speed_m_s;
    acting_N_ = sent_N_;
    sent_N_ = std::clamp(wanted_N, -axis_.force_limit_N, axis_.force_limit_N);
    reference_m_ += speed_m_s * kPeriod_s;
    return reason;
  }

  /// Up to this speed at 1 m/s^2 and on for a while; no alarm is expected.
  void RunUp(double speed_m_s, int periods = 400) {
    for (int i = 0; i < periods; ++i) {
      const double now_m_s = std::min(speed_m_s, 1e-3 * i);
      ASSERT_EQ(Step(now_m_s), Reason::kNone) << "period " << i;
    }
  }

  /// Periods until an alarm, with its reason; the true departure from the path by then is `away_m`.
  Reason Until(double speed_m_s, int limit, int& periods, double& away_m) {
    const double begin_m = p_ - reference_m_;
    for (periods = 1; periods <= limit; ++periods) {
      const Reason r = Step(speed_m_s);
      away_m = std::abs(p_ - reference_m_ - begin_m);
      if (r != Reason::kNone) return r;
    }
    return Reason::kNone;
  }

  [[nodiscard]] double position_m() const { return p_; }
  MotionMonitor& monitor() { return monitor_; }

 private:
  MonitoredAxis axis_;
  double mass_kg_;
  MotionMonitor monitor_;
  double p_ = 0.0, v_ = 0.0, z_ = 0.0;
  double sent_N_ = 0.0, acting_N_ = 0.0;
  double reference_m_ = 0.0, read_before_m_ = 0.0, integral_m_s_ = 0.0, speed_before_m_s_ = 0.0;
};

}  // namespace contour
