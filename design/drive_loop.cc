#include "design/drive_loop.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace contour {
namespace {

using Complex = std::complex<double>;

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kForceLag_s = 4e-3;
/// Peak of sensitivity that a well-set loop has at most.
constexpr double kMostPeak = 2.0;
constexpr double kLowest_Hz = 0.5, kHighest_Hz = 2000.0;
constexpr int kGrid = 1200;

Complex S(double frequency_Hz) { return {0.0, kTwoPi * frequency_Hz}; }

std::vector<double> Grid() {
  std::vector<double> out;
  for (int i = 0; i < kGrid; ++i)
    out.push_back(kLowest_Hz * std::pow(kHighest_Hz / kLowest_Hz, static_cast<double>(i) / (kGrid - 1)));
  return out;
}

struct Worst {
  double peak = 0.0, at_Hz = 0.0;
};

Worst PeakOf(const TwoInertiaAxis& axis, const DriveLoop& loop) {
  Worst out;
  const DriveLoopOn on(axis, loop);
  for (const double f : Grid()) {
    const double peak = 1.0 / std::abs(1.0 + on.Gain(f));
    if (peak > out.peak) out = {peak, f};
  }
  return out;
}

DriveLoop Scaled(DriveLoop loop, double factor) {
  loop.velocity_Ns_m *= factor;
  loop.position_1_s *= factor;
  loop.integral_1_s *= factor;
  return loop;
}

double GainRoom(const TwoInertiaAxis& axis, const DriveLoop& loop) {
  double low = 0.05, high = 20.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = std::sqrt(low * high);
    (PeakOf(axis, Scaled(loop, middle)).peak <= kMostPeak ? low : high) = middle;
  }
  return std::sqrt(low * high);
}

/// Largest travel after a step through the lag, by the inverse Fourier sum of its response: a step that comes
/// and goes, each half long enough for the loop to settle.
double StepPeak_m(const DriveLoopOn& on, double step_N) {
  constexpr double kHalf_s = 1.0;
  constexpr int kHarmonics = 1501;
  constexpr int kInstants = 800;
  constexpr double kUntil_s = 0.2;
  std::vector<Complex> part;
  for (int n = 1; n < kHarmonics; n += 2) {
    const double f = n / (2.0 * kHalf_s);
    // Square wave between minus and plus a half: 2 / (pi n) sin.
    part.push_back(step_N * 2.0 / (std::numbers::pi * n) * on.ForceToTable(f) / (1.0 + S(f) * kForceLag_s));
  }
  double peak_m = 0.0, before_m = 0.0;
  for (int i = 0; i < kInstants; ++i) {
    const double t = kUntil_s * i / kInstants;
    double x = 0.0;
    for (std::size_t j = 0; j < part.size(); ++j)
      x += (part[j] * std::polar(1.0, kTwoPi * (2.0 * static_cast<double>(j) + 1.0) / (2.0 * kHalf_s) * t))
               .imag();
    if (i == 0) before_m = x;
    peak_m = std::max(peak_m, std::abs(x - before_m));
  }
  return peak_m;
}

}  // namespace

Complex DriveLoopOn::Motor(Complex s) const {
  const Complex screw = axis_.stiffness_N_m + axis_.damping_Ns_m * s;
  const Complex table = axis_.table_mass_kg * s * s + axis_.viscous_Ns_m * s;
  return axis_.motor_mass_kg * s * s + screw * table / (screw + table);
}

Complex DriveLoopOn::Feedback(Complex s) const {
  return loop_.velocity_Ns_m * (1.0 + loop_.integral_1_s / s) * (loop_.position_1_s + s) *
         std::exp(-s * loop_.late_s) / (1.0 + s * axis_.lag_s);
}

Complex DriveLoopOn::Gain(double frequency_Hz) const {
  const Complex s = S(frequency_Hz);
  return Feedback(s) / Motor(s);
}

Complex DriveLoopOn::OffsetToMotor(double frequency_Hz, double period_s) const {
  const Complex s = S(frequency_Hz);
  const Complex held = (1.0 - std::exp(-s * period_s)) / (s * period_s);
  return held * std::exp(-s * loop_.offset_late_s) / (1.0 + s * axis_.lag_s) / (Motor(s) + Feedback(s));
}

Complex DriveLoopOn::ForceToTable(double frequency_Hz) const {
  const Complex s = S(frequency_Hz);
  const Complex screw = axis_.stiffness_N_m + axis_.damping_Ns_m * s;
  const Complex motor = axis_.motor_mass_kg * s * s + Feedback(s);
  const Complex table = axis_.table_mass_kg * s * s + axis_.viscous_Ns_m * s;
  return 1.0 / (table + screw * motor / (screw + motor));
}

DriveLoopFigures FiguresOf(const TwoInertiaAxis& axis, const DriveLoop& loop, double step_N) {
  const DriveLoopOn on(axis, loop);
  DriveLoopFigures out;
  const auto [peak, peak_Hz] = PeakOf(axis, loop);
  out.peak = peak;
  out.peak_Hz = peak_Hz;
  out.phase_margin_deg = 180.0;
  double before = 1e300;
  double softest = 0.0;
  for (const double f : Grid()) {
    const Complex gain = on.Gain(f);
    if ((before >= 1.0) != (std::abs(gain) >= 1.0)) {
      out.phase_margin_deg =
          std::min(out.phase_margin_deg, std::abs(std::arg(-gain)) * 180.0 / std::numbers::pi);
      if (out.bandwidth_Hz == 0.0) out.bandwidth_Hz = f;
    }
    before = std::abs(gain);
    softest = std::max(softest, std::abs(on.ForceToTable(f)));
  }
  const auto stiffness_N_um = [&](double f) { return 1e-6 / std::abs(on.ForceToTable(f)); };
  out.stiffness_1Hz_N_um = stiffness_N_um(1.0);
  out.stiffness_10Hz_N_um = stiffness_N_um(10.0);
  out.least_stiffness_N_um = 1e-6 / softest;
  out.step_peak_m = StepPeak_m(on, step_N);
  out.gain_room = GainRoom(axis, loop);
  return out;
}

}  // namespace contour
