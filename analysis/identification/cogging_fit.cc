#include "analysis/identification/cogging_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace contour::identify {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Poles and slots of servo motors make 6 to some 50 waves a turn; 1 and 2 are friction's, too.
constexpr int kLowest = 3;
constexpr int kHighest = 60;
/// Beyond it the averages over time leave little of a wave, and the screw begins to matter.
constexpr double kFastest_Hz = 40.0;
constexpr std::size_t kFewestRows = 400;
/// A wave is one when it explains so many times what the others do at the median, and is so large a share of
/// friction: the friction's own ripple leaves as much.
constexpr double kBeyondOthers = 25.0;
constexpr double kLeastShare = 0.01;

struct Row {
  double angle, force_N, hz_per_order;
};

/// What force is left when the sliding fit, its turn and its place are taken off.
std::vector<Row> Rest(const std::vector<Instant>& instants, const TableAxis& axis, const SlidingFit& s) {
  std::vector<const Instant*> slow;
  for (const Instant& i : instants)
    if (Slides(i) && std::fabs(i.velocity_m_s) / axis.turn_m * kLowest < kFastest_Hz) slow.push_back(&i);
  std::vector<Row> rows;
  if (slow.size() < kFewestRows) return rows;
  constexpr Eigen::Index kBase = 8;
  MatrixXd x(static_cast<Eigen::Index>(slow.size()), kBase);
  VectorXd force(x.rows());
  for (Eigen::Index k = 0; k < x.rows(); ++k) {
    const Instant& i = *slow[static_cast<std::size_t>(k)];
    const bool up = i.velocity_m_s > 0.0;
    const double sign = up ? 1.0 : -1.0;
    const double turn = 2.0 * std::numbers::pi * i.position_m / axis.turn_m;
    const double fading = std::exp(-std::pow(std::fabs(i.velocity_m_s) / s.vs_m_s, axis.friction.exponent));
    const double level = up ? s.Fc_plus_N + (s.Fs_plus_N - s.Fc_plus_N) * fading
                            : s.Fc_minus_N + (s.Fs_minus_N - s.Fc_minus_N) * fading;
    force(k) = i.force_N - s.mass_kg * i.acceleration_m_s2 - s.sigma2_Ns_m * i.velocity_m_s - sign * level;
    x.row(k) << 1.0, sign, sign * std::cos(turn), sign * std::sin(turn), sign * std::cos(2.0 * turn),
        sign * std::sin(2.0 * turn), sign * i.position_m / axis.turn_m, i.velocity_m_s / s.vs_m_s;
  }
  const VectorXd left = force - x * x.colPivHouseholderQr().solve(force);
  for (Eigen::Index k = 0; k < x.rows(); ++k) {
    const Instant& i = *slow[static_cast<std::size_t>(k)];
    rows.push_back({2.0 * std::numbers::pi * i.position_m / axis.turn_m, left(k),
                    std::fabs(i.velocity_m_s) / axis.turn_m});
  }
  return rows;
}

/// What an average over `window_s` leaves of a wave.
double Left(double hz, double window_s) {
  const double x = std::numbers::pi * hz * window_s;
  return x < 1e-6 ? 1.0 : std::sin(x) / x;
}

struct Found {
  MotorWave wave;
  double explained = 0.0;  ///< share of the variance of the rows it could be seen in
};

Found FitOrder(const std::vector<Row>& rows, int order, double window_s) {
  double cc = 1e-12, ss = 1e-12, cs = 0.0, cy = 0.0, sy = 0.0, yy = 1e-300;
  for (const Row& r : rows) {
    const double hz = order * r.hz_per_order;
    if (hz > kFastest_Hz) continue;
    const double left = Left(hz, window_s);
    const double c = left * std::cos(order * r.angle), s = left * std::sin(order * r.angle);
    cc += c * c;
    ss += s * s;
    cs += c * s;
    cy += c * r.force_N;
    sy += s * r.force_N;
    yy += r.force_N * r.force_N;
  }
  const double det = cc * ss - cs * cs;
  // The drive gives what the motor does not: a wave that accelerates is missing in the force.
  const double c = (cy * ss - sy * cs) / det, s = (sy * cc - cy * cs) / det;
  return {{static_cast<double>(order), -c, -s}, (c * cy + s * sy) / yy};
}

}  // namespace

std::array<MotorWave, kMostWaves> FindCogging(const std::vector<Instant>& instants, const TableAxis& axis,
                                              const SlidingFit& sliding, double window_s) {
  std::array<MotorWave, kMostWaves> found{};
  if (!sliding.found || axis.turn_m <= 0.0) return found;
  std::vector<Row> rows = Rest(instants, axis, sliding);
  const double least_N = kLeastShare * 0.5 * (sliding.Fc_plus_N + sliding.Fc_minus_N);
  for (MotorWave& wave : found) {
    if (rows.empty()) break;
    std::vector<double> explained;
    Found best;
    for (int order = kLowest; order <= kHighest; ++order) {
      const Found f = FitOrder(rows, order, window_s);
      explained.push_back(f.explained);
      if (f.explained > best.explained) best = f;
    }
    std::nth_element(explained.begin(), explained.begin() + static_cast<std::ptrdiff_t>(explained.size() / 2),
                     explained.end());
    const double usual = explained[explained.size() / 2];
    if (best.explained < kBeyondOthers * usual || std::hypot(best.wave.cosine_N, best.wave.sine_N) < least_N)
      break;
    wave = best.wave;
    for (Row& r : rows) {
      const double left = Left(wave.order * r.hz_per_order, window_s);
      r.force_N += left * (wave.cosine_N * std::cos(wave.order * r.angle) +
                           wave.sine_N * std::sin(wave.order * r.angle));
    }
  }
  return found;
}

}  // namespace contour::identify
