#include "analysis/identification/sliding_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

namespace contour::identify {
namespace {

/// Sliding for certain: this fast, and this far from the last reversal (a bristle is a few um long).
constexpr double kSlowest_m_s = 20e-6;
constexpr double kBeyondPresliding_m = 100e-6;
constexpr double kSlowestStribeck_m_s = 0.1e-3;
constexpr double kFastestStribeck_m_s = 30e-3;
constexpr int kStribeckSteps = 48;
constexpr std::size_t kFewest = 300;
/// What counts as constant speed, and how much of it makes a point.
constexpr double kConstantSpeed_1_s = 0.2;
constexpr double kConstantSpeed_m_s2 = 2e-3;
constexpr double kShortestTravel_m = 0.15e-3;

constexpr Eigen::Index kColumns = 12;

/// Columns: a, v, level +, level -, Stribeck +, Stribeck -, turn cos/sin of each direction, place of each.
Eigen::MatrixXd Regressors(const std::vector<const Instant*>& rows, double vs, double exponent, double radius,
                           double middle_m, double half_m) {
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows.size()), kColumns);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const Instant& i = *rows[r];
    const auto k = static_cast<Eigen::Index>(r);
    const bool up = i.velocity_m_s > 0.0;
    const double sign = up ? 1.0 : -1.0;
    const double angle = i.position_m / radius;
    x(k, 0) = i.acceleration_m_s2;
    x(k, 1) = i.velocity_m_s;
    x(k, up ? 2 : 3) = sign;
    x(k, up ? 4 : 5) = sign * std::exp(-std::pow(std::fabs(i.velocity_m_s) / vs, exponent));
    x(k, up ? 6 : 8) = sign * std::cos(angle);
    x(k, up ? 7 : 9) = sign * std::sin(angle);
    x(k, up ? 10 : 11) = sign * (i.position_m - middle_m) / half_m;
  }
  return x;
}

/// Levels that oppose motion, from the coefficients of a regression. Sliding does not tell levels that differ
/// between the directions from a constant force; but where the force does not oppose one direction at all,
/// something pulls (a weight): then the difference is taken for that.
bool TakeLevels(const Eigen::VectorXd& b, SlidingFit& fit) {
  const double least = std::min({b(2), b(3), b(2) + b(4), b(3) + b(5)});
  const double offset_N = least > 0.0 ? 0.0 : 0.5 * (b(3) - b(2));
  const double plus_N = b(2) + offset_N, minus_N = b(3) - offset_N;
  if (!(std::min({b(0), plus_N, minus_N, plus_N + b(4), minus_N + b(5)}) > 0.0)) return false;
  fit.found = true;
  fit.offset_N = offset_N;
  fit.mass_kg = b(0);
  fit.sigma2_Ns_m = std::max(0.0, b(1));
  fit.Fc_plus_N = plus_N;
  fit.Fc_minus_N = minus_N;
  fit.Fs_plus_N = plus_N + std::max(0.0, b(4));
  fit.Fs_minus_N = minus_N + std::max(0.0, b(5));
  return true;
}

}  // namespace

bool Slides(const Instant& i) {
  return std::fabs(i.velocity_m_s) > kSlowest_m_s && i.since_reversal_m > kBeyondPresliding_m;
}

SlidingFit FitSliding(const std::vector<Instant>& instants, double exponent, double radius_m_rad) {
  SlidingFit fit;
  std::vector<const Instant*> rows;
  double low = 1e300;
  double high = -1e300;
  std::size_t up = 0;
  for (const Instant& i : instants) {
    if (!Slides(i)) continue;
    rows.push_back(&i);
    low = std::min(low, i.position_m);
    high = std::max(high, i.position_m);
    up += i.velocity_m_s > 0.0 ? 1 : 0;
  }
  if (up < kFewest || rows.size() - up < kFewest) {
    fit.why_not = "the axis does not slide long enough in both directions";
    return fit;
  }
  Eigen::VectorXd force(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t r = 0; r < rows.size(); ++r) force(static_cast<Eigen::Index>(r)) = rows[r]->force_N;
  double best = 1e300;
  for (int step = 0; step <= kStribeckSteps; ++step) {
    const double vs = kSlowestStribeck_m_s * std::pow(kFastestStribeck_m_s / kSlowestStribeck_m_s,
                                                      static_cast<double>(step) / kStribeckSteps);
    const Eigen::MatrixXd x =
        Regressors(rows, vs, exponent, radius_m_rad, 0.5 * (low + high), std::max(1e-6, 0.5 * (high - low)));
    Eigen::MatrixXd normal = x.transpose() * x;
    normal.diagonal().array() += 1e-9 * normal.diagonal().maxCoeff();
    const Eigen::VectorXd b = normal.ldlt().solve(x.transpose() * force);
    const double rest = (force - x * b).squaredNorm();
    if (rest >= best || !TakeLevels(b, fit)) continue;
    best = rest;
    fit.vs_m_s = vs;
    fit.residual_rms_N = std::sqrt(rest / static_cast<double>(rows.size()));
  }
  if (!fit.found) fit.why_not = "no friction that opposes motion fits the forces: are the signs right?";
  return fit;
}

std::vector<StribeckPoint> StribeckPoints(const std::vector<Instant>& instants, const TableAxis& axis) {
  struct Sum {
    double n = 0.0, speed = 0.0, force = 0.0, square = 0.0, travel = 0.0;
  };
  // Bins of a tenth of an octave: runs at one speed fall into one or two.
  std::map<int, Sum> sums;
  const Instant* before = nullptr;
  for (const Instant& i : instants) {
    const double speed = std::fabs(i.velocity_m_s);
    const double step_s = before != nullptr ? std::min(i.time_s - before->time_s, 0.1) : 0.0;
    before = &i;
    if (!Slides(i)) continue;
    if (std::fabs(i.acceleration_m_s2) > kConstantSpeed_1_s * speed + kConstantSpeed_m_s2) continue;
    const int bin = static_cast<int>(std::lround(5.0 * std::log2(speed / kSlowest_m_s))) + 1;
    Sum& s = sums[i.velocity_m_s > 0.0 ? bin : -bin];
    const double viscous = axis.friction.s2 * i.velocity_m_s;
    const double level = i.force_N + axis.offset - axis.mass_kg() * i.acceleration_m_s2 - viscous;
    const double friction =
        level / LevelFactor(axis, i.position_m, i.position_m, i.velocity_m_s > 0.0) + viscous;
    s.n += 1.0;
    s.speed += i.velocity_m_s;
    s.force += friction;
    s.square += friction * friction;
    s.travel += speed * step_s;
  }
  std::vector<StribeckPoint> points;
  for (const auto& [bin, s] : sums) {
    if (s.n < 10.0 || s.travel < kShortestTravel_m) continue;
    const double mean = s.force / s.n;
    points.push_back({s.speed / s.n, mean, std::sqrt(std::max(0.0, s.square / s.n - mean * mean)), s.travel});
  }
  return points;
}

}  // namespace contour::identify
