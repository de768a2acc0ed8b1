#include "analysis/identification/follow_gain.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/identification/linear_step.h"
#include "analysis/prediction_error/steady_gain.h"

namespace contour::identify {
namespace {

constexpr double kFollow_Hz = 60.0;
/// Of a value that is rounded, and noisy by about as much: standard deviation over its step.
constexpr double kRoundedNoise = 0.4;

/// `ratio`: movement in a period by a disturbance, of the noise of a reading. `on_motor` is the share of that
/// disturbance's variance that acts there.
FollowGain SteadyFollowGain(const TableAxis& axis, double period_s, double ratio, double on_table,
                            double on_motor) {
  const LinearStep d = Over(axis, 0.0, period_s);
  const double noise_m = period_s * period_s / axis.mass_kg() / ratio;
  const Eigen::Vector4d motor = d.command + d.delayed;
  const Eigen::Matrix4d q = on_table * d.table * d.table.transpose() + on_motor * motor * motor.transpose();
  const int n = axis.two_inertia ? 4 : 2;
  FollowGain gain = FollowGain::Zero();
  gain.head(n) = diagnosis::SteadyGain(d.a.topLeftCorner(n, n), q.topLeftCorner(n, n), noise_m * noise_m,
                                       1e6 * q.topLeftCorner(n, n));
  return gain;
}

}  // namespace

FollowGain MakeFollowGain(const TableAxis& axis, double period_s, double bandwidth_Hz) {
  // A disturbance of 1 N for a period; the noise then sets the bandwidth: omega^2 T^2 = ratio of the two.
  const double omega_t = std::min(1.0, 2.0 * std::numbers::pi * bandwidth_Hz * period_s);
  return SteadyFollowGain(axis, period_s, omega_t * omega_t, 1.0, 0.1);
}

double ReportStep_N(const Measured& data) {
  double step_N = data.report_step_N;
  if (!data.led_by_drive() || step_N > 0.0) return step_N;
  for (std::size_t k = 1; k < data.size(); ++k) {
    const double change_N = std::fabs(data.reported_N[k] - data.reported_N[k - 1]);
    if (change_N > 1e-9 && (step_N == 0.0 || change_N < step_N)) step_N = change_N;
  }
  return step_N;
}

FollowGain FollowGainFor(const TableAxis& axis, const Measured& data, double factor) {
  const double least = std::min(1.0, 2.0 * std::numbers::pi * kFollow_Hz * factor * data.period_s);
  if (!data.led_by_drive()) return SteadyFollowGain(axis, data.period_s, least * least, 1.0, 0.1);
  const double noise_m = kRoundedNoise * data.position_step_m;
  const double move_m = kRoundedNoise * ReportStep_N(data) * data.period_s * data.period_s / axis.mass_kg();
  const double ratio = factor * factor * std::max(least * least, move_m / std::max(noise_m, 1e-12));
  return SteadyFollowGain(axis, data.period_s, ratio, 0.1, 1.0);
}

}  // namespace contour::identify
