#include "daemon/program/corner_blend.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace contour {
namespace {

// Half the turning angle: below, nothing is gained by rounding; above (170 degrees), the path comes back.
constexpr double kLeastSine = 0.005;
constexpr double kLeastCosine = 0.087;
// Shares of the largest jm that are tried for the fastest blend.
constexpr int kShares = 20;

PerAxis<double> Unit(const PerAxis<double>& a, double sign, const PerAxis<double>& b, double& norm) {
  PerAxis<double> v(a.size());
  double squared = 0.0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    v[i] = a[i] + sign * b[i];
    squared += v[i] * v[i];
  }
  norm = std::sqrt(squared);
  if (norm > 0.0)
    for (double& x : v) x /= norm;
  return v;
}

/// Largest x with share_i x <= (limit_i - taken_i) on every axis.
template <class Room>
double Largest(const PerAxis<double>& share, Room&& room) {
  double largest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < share.size(); ++i)
    if (share[i] != 0.0) largest = std::min(largest, std::max(0.0, room(i)) / std::abs(share[i]));
  return largest;
}

}  // namespace

double CornerBlend::cut_m() const {
  const double jn_over_k = jerk_n_m_s3_ * cos_ / sin_;
  return std::pow(half_s_, 3) * (0.5 * jn_over_k + jerk_m_m_s3_ * 2.0 / 3.0) / cos_;
}

PassingState CornerBlend::leg() const {
  return {half_s_ * half_s_ * (0.5 * jerk_n_m_s3_ / sin_ + jerk_m_m_s3_ / cos_),
          jerk_m_m_s3_ * half_s_ / cos_};
}

double CornerBlend::deviation_m() const {
  return std::pow(half_s_, 3) * (cos_ * jerk_n_m_s3_ + sin_ * jerk_m_m_s3_) / 6.0;
}

CornerBlend CornerBlend::Scaled(double factor) const {
  CornerBlend scaled = *this;
  scaled.half_s_ *= factor;
  return scaled;
}

void CornerBlend::LimitTime(const BlendLeg& before, const BlendLeg& after, double deviation_m,
                            const PerAxis<PlanLimits>& limits) {
  // All quantities are powers of tau: take their values at tau = 1 s.
  half_s_ = 1.0;
  const PassingState unit = leg();
  const double acceleration = jerk_n_m_s3_ + sin_ / cos_ * jerk_m_m_s3_;
  double half = std::cbrt(deviation_m / this->deviation_m());
  half =
      std::min(half, Largest(n_, [&](std::size_t i) { return limits[i].acceleration_m_s2; }) / acceleration);
  for (const BlendLeg* l : {&before, &after}) {
    const double run_out_s = unit.acceleration_m_s2 / l->ramp.jerk_m_s3;
    const double run_out_m = run_out_s * (unit.speed_m_s + run_out_s * unit.acceleration_m_s2 / 3.0);
    if (unit.acceleration_m_s2 > 0.0)
      half = std::min(half, l->ramp.acceleration_m_s2 / unit.acceleration_m_s2);
    half = std::min({half, std::sqrt(l->cruise_m_s / LowestPeak_m_s(unit, l->ramp)),
                     std::cbrt(l->straight_m / cut_m()), std::cbrt(l->room_m / (cut_m() + run_out_m))});
  }
  half_s_ = half;
}

double CornerBlend::Lost_s(const BlendLeg& l) const {
  const JerkRamp up(leg(), l.cruise_m_s, l.ramp);
  return half_s_ + up.duration_s() - (cut_m() + up.length_m()) / l.cruise_m_s;
}

std::optional<CornerBlend> CornerBlend::Fastest(const BlendLeg& before, const BlendLeg& after,
                                                const PerAxis<double>& corner_m, double deviation_m,
                                                const PerAxis<PlanLimits>& limits) {
  CornerBlend blend;
  blend.corner_m_ = corner_m;
  blend.m_ = Unit(after.direction, 1.0, before.direction, blend.cos_);
  blend.n_ = Unit(after.direction, -1.0, before.direction, blend.sin_);
  blend.cos_ *= 0.5;
  blend.sin_ *= 0.5;
  if (blend.sin_ < kLeastSine || blend.cos_ < kLeastCosine) return std::nullopt;
  // The corner itself is passed at h = deviation / c; in a sharp one it shall not be missed by more than
  // twice the deviation.
  deviation_m *= std::min(1.0, 2.0 * blend.cos_);
  const double largest_jm = Largest(blend.m_, [&](std::size_t i) { return limits[i].jerk_m_s3; });
  std::optional<CornerBlend> best;
  double best_s = std::numeric_limits<double>::infinity();
  for (int k = 0; k <= kShares; ++k) {
    blend.jerk_m_m_s3_ = largest_jm * k / kShares;
    blend.jerk_n_m_s3_ = Largest(blend.n_, [&](std::size_t i) {
      return limits[i].jerk_m_s3 - blend.jerk_m_m_s3_ * std::abs(blend.m_[i]);
    });
    blend.LimitTime(before, after, deviation_m, limits);
    const double lost_s = blend.Lost_s(before) + blend.Lost_s(after);
    if (lost_s < best_s) {
      best_s = lost_s;
      best = blend;
    }
  }
  return best;
}

void CornerBlend::At(double since_begin_s, PerAxis<ReferencePoint>& axes) const {
  const double t = std::clamp(since_begin_s - half_s_, -half_s_, half_s_);
  const double k = sin_ / cos_;
  const double jm = jerk_m_m_s3_, jn = jerk_n_m_s3_;
  const double a = half_s_ * (jn + k * jm);
  const double vc = 0.5 * half_s_ * half_s_ * (jn / k + jm);
  const double h = half_s_ * half_s_ * a / 6.0;
  const double size = std::abs(t);
  const double along[3] = {t * (vc + jm * t * t / 6.0), vc + 0.5 * jm * t * t, jm * t};
  const double across[3] = {h + t * t * (0.5 * a - jn * size / 6.0), t * (a - 0.5 * jn * size),
                            a - jn * size};
  axes.resize(corner_m_.size());
  for (std::size_t i = 0; i < axes.size(); ++i) {
    axes[i] = {};
    axes[i].position_m = corner_m_[i] + along[0] * m_[i] + across[0] * n_[i];
    axes[i].velocity_m_s = along[1] * m_[i] + across[1] * n_[i];
    axes[i].acceleration_m_s2 = along[2] * m_[i] + across[2] * n_[i];
  }
}

}  // namespace contour
