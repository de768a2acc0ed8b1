#include "daemon/program/torque_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "config/number_text.h"

namespace contour {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
/// Long against the axis's own modes, short against any experiment.
constexpr double kFade_s = 0.1;
/// Instants of one repetition of a multisine at which its peak is looked for, per period of its highest line.
constexpr double kSamplesPerPeriod = 16.0;

double SmoothStep(double u) {
  const double x = std::clamp(u, 0.0, 1.0);
  return x * x * (3.0 - 2.0 * x);
}

/// What is set once per cycle is another torque, of a lower frequency, from half the cycle's rate on.
void RequireBelowHalfTheRate(const TorqueSignal& signal, double cycle_s) {
  if (signal.kind == TorqueSignalKind::kPulses || !(cycle_s > 0.0)) return;
  const double half_rate_hz = 0.5 / cycle_s;
  if (signal.frequency_max_hz < half_rate_hz) return;
  throw ProgramError(signal.highest_where + ": torque.frequency_max_hz: found " +
                     RoundedText(signal.frequency_max_hz) + ", expected less than " +
                     RoundedText(half_rate_hz) + ", half the cycle's rate: the torque is set once per cycle");
}

}  // namespace

TorquePlan::TorquePlan(std::shared_ptr<const MotionPlan> inner, const TorqueSignal& signal, std::size_t axis,
                       const PerAxis<PlanLimits>& limits, const std::string& origin)
    : inner_(std::move(inner)), signal_(signal), axis_(axis) {
  RequireBelowHalfTheRate(signal, limits[axis].cycle_s);
  if (signal.kind == TorqueSignalKind::kMultisine) {
    const double ratio = signal.frequency_max_hz / signal.frequency_min_hz;
    for (int k = 0; k < signal.lines; ++k) {
      const double place = signal.lines > 1 ? static_cast<double>(k) / (signal.lines - 1) : 0.0;
      // Schroeder's phases keep the peak low (as in oscillation_plan.cc).
      lines_.push_back({kTurn_rad * signal.frequency_min_hz * std::pow(ratio, place),
                        -std::numbers::pi * k * (k + 1) / signal.lines});
    }
  }
  const PlanLimits& l = limits[axis];
  if (!(peak_Nm() <= l.torque_Nm)) {
    char text[160];
    std::snprintf(text, sizeof text, ": axis %s: extra torque of %.4g Nm is beyond the limit of %.4g Nm",
                  l.axis.c_str(), peak_Nm(), l.torque_Nm);
    throw ProgramError(origin + text);
  }
}

double TorquePlan::peak_Nm() const {
  if (signal_.kind != TorqueSignalKind::kMultisine) return signal_.amplitude_Nm;
  const double step_s = 1.0 / (kSamplesPerPeriod * signal_.frequency_max_hz);
  double peak = 0.0;
  for (double t = 0.0; t <= duration_s(); t += step_s) peak = std::max(peak, std::abs(Signal(t)));
  return peak;
}

double TorquePlan::Signal(double time_s) const {
  double sum = 0.0;
  switch (signal_.kind) {
    case TorqueSignalKind::kMultisine:
      for (const Line& line : lines_) sum += std::sin(line.rate_rad_s * time_s + line.phase_rad);
      break;
    case TorqueSignalKind::kChirp: {
      const double t = std::fmod(time_s, signal_.period_s);
      const double growth = (signal_.frequency_max_hz - signal_.frequency_min_hz) / signal_.period_s;
      sum = std::sin(kTurn_rad * (signal_.frequency_min_hz + 0.5 * growth * t) * t);
      break;
    }
    case TorqueSignalKind::kPulses: {
      const double quarter = std::fmod(time_s, signal_.period_s) / signal_.width_s;
      // Every other group is upside down, so that both directions are met alike.
      const double sign = std::fmod(time_s, 2.0 * signal_.period_s) < signal_.period_s ? 1.0 : -1.0;
      if (quarter < 1.0 || (quarter >= 3.0 && quarter < 4.0)) sum = sign;
      if (quarter >= 1.0 && quarter < 3.0) sum = -sign;
      break;
    }
  }
  return signal_.amplitude_Nm * sum;
}

void TorquePlan::At(double time_s, PerAxis<ReferencePoint>& axes) const {
  inner_->At(time_s, axes);
  const double left_s = duration_s() - time_s;
  if (time_s <= 0.0 || left_s <= 0.0) return;
  axes[axis_].extra_torque_Nm += Signal(time_s) * SmoothStep(time_s / kFade_s) * SmoothStep(left_s / kFade_s);
}

}  // namespace contour
