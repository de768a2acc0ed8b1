#include "control/torque_constant_watch.h"

#include <cmath>

namespace contour {
namespace {

// Friction of a real axis varies by position, and is what makes a sample uncertain.
constexpr double kFrictionNoise = 0.5;
// Share of what was learnt that is forgotten with every sample: some thousand samples count.
constexpr double kForget = 1e-3;
constexpr double kSure = 3.0;  // standard deviations

}  // namespace

TorqueConstantWatch::TorqueConstantWatch(double friction_N, double speed_m_s, double allowed_rel) noexcept
    : noise_N2_(kFrictionNoise * friction_N * kFrictionNoise * friction_N),
      allowed_log_(std::log1p(allowed_rel)),
      theta_{1.0, friction_N, 0.0},
      prior_{1.0, friction_N * friction_N, friction_N * friction_N / (speed_m_s * speed_m_s)} {
  for (std::size_t i = 0; i < 3; ++i) p_[i][i] = prior_[i];
}

void TorqueConstantWatch::Learn(double force_N, double inertial_N, double velocity_m_s) noexcept {
  const std::array<double, 3> x{inertial_N, velocity_m_s < 0.0 ? -1.0 : 1.0, velocity_m_s};
  std::array<double, 3> px{};
  double variance = noise_N2_;
  double error = force_N;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) px[i] += p_[i][j] * x[j];
    variance += x[i] * px[i];
    error -= theta_[i] * x[i];
  }
  for (std::size_t i = 0; i < 3; ++i) {
    theta_[i] += px[i] / variance * error;
    for (std::size_t j = 0; j < 3; ++j) p_[i][j] -= px[i] * px[j] / variance;
    // Forgetting by what the prior knew, so that nothing winds up where nothing is excited.
    p_[i][i] += kForget * (prior_[i] - p_[i][i]);
  }
  changed_ = Changed();
}

bool TorqueConstantWatch::Changed() const noexcept {
  const double off = std::abs(std::log(theta_[0] > 1e-3 ? theta_[0] : 1e-3));
  const double sd = std::sqrt(p_[0][0]) / (theta_[0] > 1e-3 ? theta_[0] : 1e-3);
  return off - kSure * sd > allowed_log_;
}

}  // namespace contour
