#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "estimator/axis_estimator.h"

namespace contour::test {

/// A ball-screw axis for tests of the estimator: two inertias, drive lag, LuGre friction that varies over
/// stroke and turn. Integrated by the classical fourth-order Runge-Kutta in steps of 10 us, the bristle
/// displacement as a plain state: no code or scheme in common with the estimator.
struct ScrewAxis {
  double lead_m = 5e-3;
  double motor_mass_kg = 5e-5 / (lead_m / 2 / std::numbers::pi) / (lead_m / 2 / std::numbers::pi);
  double table_mass_kg = 10.0;
  double stiffness_N_m = 40e6;
  double damping_Ns_m = 1100.0;
  double lag_s = 0.2e-3;
  double Fs[2] = {52.0, 47.0};  // plus, minus
  double Fc[2] = {42.0, 36.0};
  double vs_m_s = 2e-3;
  double sigma0_N_m = 5e6;
  double sigma1_Ns_m = 3000.0;
  double vd_m_s = 2e-3;
  double sigma2_Ns_m = 500.0;
  double stroke_part = 0.2;
  double ripple_part = 0.08;
  double extra_force_N = 0.0;  // pushes against positive motion, at the table
  bool stuck = false;

  struct State {
    double motor_m = 0, motor_m_s = 0, table_m = 0, table_m_s = 0, bristle_m = 0, force_N = 0;
  };
  State s;

  [[nodiscard]] double Friction(const State& a) const {
    const int dir = a.table_m_s >= 0 ? 0 : 1;
    const double g = Level(a, dir);
    const double z_rate = a.table_m_s - sigma0_N_m * std::abs(a.table_m_s) * a.bristle_m / g;
    const double q = a.table_m_s / vd_m_s;
    return sigma0_N_m * a.bristle_m + sigma1_Ns_m * std::exp(-q * q) * z_rate + sigma2_Ns_m * a.table_m_s;
  }
  [[nodiscard]] double Level(const State& a, int dir) const {
    const double g = Fc[dir] + (Fs[dir] - Fc[dir]) * std::exp(-std::abs(a.table_m_s) / vs_m_s);
    const double angle = 2 * std::numbers::pi * a.table_m / lead_m;
    return std::max(1e-9, g * (1 + stroke_part * a.table_m / 0.4) *
                              (1 + ripple_part * std::sin(angle + 0.4 + 1.9 * dir)));
  }
  [[nodiscard]] double friction_N() const { return Friction(s) + extra_force_N; }

  [[nodiscard]] State Rate(const State& a, double command_N) const {
    State r;
    r.force_N = (command_N - a.force_N) / lag_s;
    if (stuck) return r;
    const double spring =
        stiffness_N_m * (a.motor_m - a.table_m) + damping_Ns_m * (a.motor_m_s - a.table_m_s);
    r.motor_m = a.motor_m_s;
    r.motor_m_s = (a.force_N - spring) / motor_mass_kg;
    r.table_m = a.table_m_s;
    r.table_m_s = (spring - Friction(a) - extra_force_N) / table_mass_kg;
    const int dir = a.table_m_s >= 0 ? 0 : 1;
    r.bristle_m = a.table_m_s - sigma0_N_m * std::abs(a.table_m_s) * a.bristle_m / Level(a, dir);
    return r;
  }

  static State Add(const State& a, double h, const State& r) {
    return {a.motor_m + h * r.motor_m,     a.motor_m_s + h * r.motor_m_s, a.table_m + h * r.table_m,
            a.table_m_s + h * r.table_m_s, a.bristle_m + h * r.bristle_m, a.force_N + h * r.force_N};
  }

  void Step(double command_N, double period_s) {
    const double h = 10e-6;
    const int n = static_cast<int>(std::lround(period_s / h));
    for (int i = 0; i < n; ++i) {
      const State k1 = Rate(s, command_N), k2 = Rate(Add(s, h / 2, k1), command_N);
      const State k3 = Rate(Add(s, h / 2, k2), command_N), k4 = Rate(Add(s, h, k3), command_N);
      s = Add(Add(Add(Add(s, h / 6, k1), h / 3, k2), h / 3, k3), h / 6, k4);
    }
  }
};

/// Encoder of 2^20 counts per turn with 0.3 counts of noise.
struct Encoder {
  double count_m = 5e-3 / 1048576;
  std::mt19937 random{1};
  double Read(double position_m) {
    std::normal_distribution<double> noise(0.0, 0.3);
    return std::round(position_m / count_m + noise(random)) * count_m;
  }
};

/// What a machine file would say of ScrewAxis: every friction value at least 10 % off, K 10 %, J 5 %.
inline Mechanics WrongMechanics() {
  const ScrewAxis a;
  const double table = 0.97 * a.table_mass_kg;
  return {a.lead_m / 2 / std::numbers::pi, 1.05 * a.motor_mass_kg + table, table, 0.9 * a.stiffness_N_m,
          1000.0};
}

inline FrictionConfig WrongFriction() {
  FrictionConfig f;
  f.Fs_plus_N = 45;
  f.Fs_minus_N = 41;
  f.Fc_plus_N = 36;
  f.Fc_minus_N = 41;
  f.vs_mm_s = 2.3;
  f.sigma0_N_m = 4.2e6;
  f.sigma1_Ns_m = 2500;
  f.sigma1_decay_mm_s = 2.3;
  f.sigma2_Ns_m = 560;
  return f;
}

/// A position loop around the axis: proportional plus derivative feedback on the estimate, friction preview
/// and mass fed forward. Keeps the timing of the real cycle: feedback of t(k-1), torque over [t(k), t(k+1)).
/// For kFullInCascade a drive closes the loop itself, eight times per cycle, and reports its torque.
class Loop {
 public:
  Loop(EstimatorKind kind, const Mechanics& mechanics, const FrictionConfig& friction,
       const EstimatorConfig& config)
      : mechanics_(mechanics),
        cascade_(kind == EstimatorKind::kFullInCascade),
        estimator(kind, mechanics, friction, config, 1e-3, 0.2e-3, 5e-3 / 1048576) {
    estimator.Reset(0.0);
  }

  /// One cycle; `reference(t)` gives a ReferencePoint.
  template <class Reference>
  AxisEstimate Step(Reference&& reference) {
    const double t = static_cast<double>(cycle) * 1e-3;
    AxisHorizon h;
    for (int j = 0; j < 6; ++j) h.push_back(reference(t - 1e-3 + 1e-3 * j));
    AxisEstimator::Input in;
    in.position_m = measured_m;
    in.fresh = fresh;
    in.force_N = past_N;
    in.commanded_velocity_m_s = h[0].velocity_m_s;
    in.commanded_acceleration_m_s2 = h[0].acceleration_m_s2;
    in.at_rest = h[0].velocity_m_s == 0.0;
    in.enabled = cycle > 0;
    estimate = estimator.Update(in);
    estimator.PreviewFriction(h, h.size(), preview);
    true_friction_N = sampled_friction_N;

    const double w = 2 * std::numbers::pi * bandwidth_Hz;
    const double m = mechanics_.mass_kg;
    double u = m * 0.5 * (h[1].acceleration_m_s2 + h[2].acceleration_m_s2) + preview[1].mid_N;
    u += m * w * w * (h[1].position_m - estimate.predicted_position_m) +
         2 * m * w * (h[1].velocity_m_s - estimate.predicted_velocity_m_s);
    u = std::clamp(u, -1500.0, 1500.0);
    const double step_N = 0.637e-3 / mechanics_.radius_m_rad;  // one per mille of the rated torque
    u = std::round(u / step_N) * step_N;

    measured_m = encoder.Read(axis.s.motor_m);
    sampled_friction_N = axis.friction_N();
    if (cascade_) {
      const double reported_N = std::round(axis.s.force_N / step_N) * step_N;
      past_N = {reported_N, 0.5 * (reported_N + past_N[0]), past_N[0]};
      Hold(h, preview[1].mid_N);
    } else {
      axis.Step(u, 1e-3);
      past_N = {u, past_N[0], past_N[1]};
    }
    ++cycle;
    return estimate;
  }

 private:
  void Hold(const AxisHorizon& h, double offset_N) {
    constexpr int kTicks = 8;
    constexpr double kDrive_Hz = 80.0;
    const double w = 2 * std::numbers::pi * kDrive_Hz, tick_s = 1e-3 / kTicks;
    for (int i = 0; i < kTicks; ++i) {
      const double part = static_cast<double>(i) / kTicks;
      const double position_m = h[1].position_m + part * (h[2].position_m - h[1].position_m);
      const double velocity_m_s = h[1].velocity_m_s + part * (h[2].velocity_m_s - h[1].velocity_m_s);
      const double error_m = position_m - axis.s.motor_m, error_m_s = velocity_m_s - axis.s.motor_m_s;
      const double wanted_m_s2 = h[1].acceleration_m_s2 + w * w * error_m + 2 * w * error_m_s;
      axis.Step(std::clamp(offset_N + mechanics_.mass_kg * wanted_m_s2, -1500.0, 1500.0), tick_s);
    }
  }

  Mechanics mechanics_;
  bool cascade_;

 public:
  AxisEstimator estimator;
  ScrewAxis axis;
  Encoder encoder;
  AxisEstimate estimate;
  FrictionPreview preview;
  double bandwidth_Hz = 35.0;
  double measured_m = 0.0;
  bool fresh = true;
  std::array<double, 3> past_N{};
  double sampled_friction_N = 0.0;
  double true_friction_N = 0.0;  ///< at the instant the estimate belongs to
  long cycle = 0;
};

/// Sine from rest, amplitude reached smoothly in the first half second; zero before `start_s`.
struct SmoothSine {
  double amplitude_m = 100e-6;
  double frequency_Hz = 0.785;
  double start_s = 0.2;
  double stop_s = 1e9;
  [[nodiscard]] ReferencePoint operator()(double t) const {
    t = std::min(t, stop_s) - start_s;
    if (t <= 0.0) return {};
    const double w = 2 * std::numbers::pi * frequency_Hz;
    const double ramp = 0.5;
    // Phase: constant angular acceleration, then constant angular velocity.
    const double phase = t < ramp ? 0.5 * w * t * t / ramp : w * (t - 0.5 * ramp);
    const double rate = t < ramp ? w * t / ramp : w;
    const double second = t < ramp ? w / ramp : 0.0;
    ReferencePoint r{amplitude_m * (1.0 - std::cos(phase)), amplitude_m * std::sin(phase) * rate,
                     amplitude_m * (std::cos(phase) * rate * rate + std::sin(phase) * second)};
    if (t >= stop_s - start_s) r.velocity_m_s = r.acceleration_m_s2 = 0.0;
    return r;
  }
};

}  // namespace contour::test
