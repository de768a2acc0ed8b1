#include "tests/analysis/identification/generated_axis.h"

#include <cmath>
#include <numbers>
#include <random>

#include "tools/plant_emulator/axis_plant.h"
#include "tools/plant_emulator/current_loop.h"

namespace contour::test {
namespace {

constexpr double kPeriod_s = 1e-3;
constexpr int kSteps = 32;  ///< of the plant, per period
constexpr double kCounts = 1048576.0;
constexpr double kPause_s = 0.2;
constexpr double kRamp_s = 0.05;
constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// Way at time t of a stroke of this length and speed, with sin^2 ramps.
double StrokeWay(double t, double length, double speed) {
  const double ramp = std::min(kRamp_s, length / speed);
  const double whole = length / speed + ramp;
  if (t <= 0.0) return 0.0;
  if (t >= whole) return length;
  const auto up = [&](double s) {  // way during the ramp: integral of v sin^2(pi s / 2 ramp)
    return speed * (0.5 * s - ramp / kTwoPi * std::sin(std::numbers::pi * s / ramp));
  };
  if (t < ramp) return up(t);
  if (t > whole - ramp) return length - up(whole - t);
  return up(ramp) + speed * (t - ramp);
}
double StrokeTime(double length, double speed) { return length / speed + std::min(kRamp_s, length / speed); }

}  // namespace

plant::AxisParameters PlainAxis() {
  EmulatedAxisConfig config;
  config.motor_inertia_kgm2 = 5e-5;
  config.table_mass_kg = 10;
  config.screw_stiffness_N_um = 40;
  config.screw_damping_Ns_m = 1100;
  config.start_variation_mm = 0.0;
  config.friction.Fs_plus_N = 52;
  config.friction.Fs_minus_N = 47;
  config.friction.Fc_plus_N = 42;
  config.friction.Fc_minus_N = 36;
  config.friction.vs_mm_s = 2;
  config.friction.sigma0_N_m = 5e6;
  config.friction.sigma1_Ns_m = 3000;
  config.friction.sigma1_decay_mm_s = 2;
  config.friction.sigma2_Ns_m = 500;
  config.friction.position_amplitude_rel = 0.0;
  config.friction.ripple_amplitude_rel = 0.0;
  EmulatedAxisPlacement place;
  place.name = "x";
  place.node_id = 1;
  place.lead_mm = 5;
  place.rated_torque_Nm = 0.637;
  place.peak_torque_Nm = 1.91;
  place.encoder_counts_per_rev = kCounts;
  plant::AxisParameters p = plant::MakeAxisParameters(config, place, 1, 0.0, 0);
  p.start_bristle_N = 0.0;
  return p;
}

identify::TableAxis Exactly(const plant::AxisParameters& p) {
  identify::TableAxis a;
  a.two_inertia = a.friction_on_load = true;
  a.radius_m_rad = p.radius_m_rad;
  a.turn_m = kTwoPi * p.radius_m_rad;
  a.motor_inertia = p.motor_inertia_kgm2 / (p.radius_m_rad * p.radius_m_rad);
  a.load_inertia = p.table_mass_kg;
  a.stiffness = p.stiffness_N_m;
  a.damping = p.damping_Ns_m;
  const plant::FrictionParameters& f = p.friction.base;
  a.friction = {f.plus.Fc_N, f.minus.Fc_N, f.plus.Fs_N,   f.minus.Fs_N,       f.vs_m_s,
                1.0,         f.sigma0_N_m, f.sigma1_Ns_m, f.sigma1_decay_m_s, f.sigma2_Ns_m};
  a.delay_s = kPeriod_s;
  a.lag_s = p.lag_s;
  return a;
}

identify::Measured GeneratedAxis::Drive(double seconds, const Path& position_m, const Path& extra_N) const {
  plant::AxisPlant plant(truth);
  plant::CurrentLoop current(truth.lag_s);
  std::mt19937 random(12345);
  std::normal_distribution<double> normal;
  const double count_m = kTwoPi * truth.radius_m_rad / kCounts;
  const double unit_N = 1e-3 * truth.rated_torque_Nm / truth.radius_m_rad;
  const double mass =
      truth.table_mass_kg + truth.motor_inertia_kgm2 / (truth.radius_m_rad * truth.radius_m_rad);
  const double bandwidth = kTwoPi * 25.0;
  identify::Measured data;
  data.period_s = kPeriod_s;
  data.position_step_m = count_m;
  double command_N = 0.0;
  double integral = 0.0;
  double before_m = 0.0;
  const auto rows = static_cast<int>(seconds / kPeriod_s);
  for (int k = 0; k < rows; ++k) {
    const double t = k * kPeriod_s;
    const double seen_m =
        count_m * std::floor(plant.motor_position_m() / count_m + 0.5 + noise_lsb * normal(random));
    if (k == 0) before_m = seen_m;
    const double speed = (seen_m - before_m) / kPeriod_s;
    before_m = seen_m;
    const double wanted_speed = (position_m(t + kPeriod_s) - position_m(t - kPeriod_s)) / (2.0 * kPeriod_s);
    const double error = position_m(t) - seen_m;
    integral += error * kPeriod_s;
    const double force =
        mass * bandwidth * (bandwidth * (error + 0.3 * bandwidth * integral) + 1.4 * (wanted_speed - speed)) +
        extra_N(t);
    data.force_N.push_back(unit_N * std::round(force / unit_N));
    data.position_m.push_back(seen_m);
    data.present.push_back(1);
    if (scale) data.table_m.push_back(1e-8 * std::round(plant.table_position_m() / 1e-8));
    // Row k's command acts one period later: now that of the row before.
    const double noise_N = torque_noise_N > 0.0 ? torque_noise_N * normal(random) : 0.0;
    current.SetCommand((command_N + noise_N) * truth.radius_m_rad);
    for (int i = 0; i < kSteps; ++i) plant.Step(kPeriod_s / kSteps, current.StepMean_Nm(kPeriod_s / kSteps));
    command_N = data.force_N.back();
  }
  return data;
}

double StrokesDuration_s(double stroke_m, const std::vector<double>& speeds_m_s) {
  double sum = kPause_s;
  for (const double v : speeds_m_s) sum += 2.0 * (StrokeTime(stroke_m, v) + kPause_s);
  return sum;
}

GeneratedAxis::Path Strokes(double stroke_m, std::vector<double> speeds_m_s) {
  return [stroke_m, speeds = std::move(speeds_m_s)](double t) {
    t -= kPause_s;
    for (const double v : speeds) {
      const double one = StrokeTime(stroke_m, v) + kPause_s;
      if (t < one) return StrokeWay(t, stroke_m, v);
      if (t < 2.0 * one) return stroke_m - StrokeWay(t - one, stroke_m, v);
      t -= 2.0 * one;
    }
    return 0.0;
  };
}

const identify::Measured& SlidingRecord() {
  static const identify::Measured record = [] {
    const std::vector<double> speeds = {0.5e-3, 1e-3, 2e-3, 5e-3, 10e-3, 20e-3, 50e-3};
    GeneratedAxis axis{PlainAxis()};
    return axis.Drive(StrokesDuration_s(5e-3, speeds), Strokes(5e-3, speeds), [](double) { return 0.0; });
  }();
  return record;
}

const identify::Measured& Everything() {
  static const identify::Measured record = [] {
    const std::vector<double> speeds = {1e-3, 3e-3, 10e-3, 50e-3};
    const double strokes_s = StrokesDuration_s(5e-3, speeds);
    const auto strokes = Strokes(5e-3, speeds);
    GeneratedAxis axis{PlainAxis()};
    return axis.Drive(
        strokes_s + 14.0,
        [=](double t) {
          if (t < strokes_s) return strokes(t);
          const double s = t - strokes_s;
          if (s < 6.0) return (s < 2.0 ? 4e-6 : s < 4.0 ? 15e-6 : 0.2e-3) * std::sin(kTwoPi * s);
          return s < 9.0 ? 0.0 : 5e-3 * (s - 9.0);
        },
        [=](double t) {
          const double s = t - strokes_s;
          if (s < 6.0) return 0.0;
          if (s < 9.0) return 8.0 * std::sin(kTwoPi * (10.0 * (s - 6.0) + 15.0 * (s - 6.0) * (s - 6.0)));
          const double c = std::fmod(s - 9.0, 2.5);
          return 60.0 * std::sin(kTwoPi * (100.0 * c + 76.0 * c * c));
        });
  }();
  return record;
}

}  // namespace contour::test
