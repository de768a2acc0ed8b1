#include "analysis/identification/kinematics.h"

#include <cmath>

namespace contour::identify {
namespace {

/// Speeds below this are rest: the sign of the velocity is that of the last motion.
constexpr double kStanding_m_s = 2e-6;

struct Row {
  double velocity = 0.0, acceleration = 0.0, force = 0.0;
};

/// The command that acts over period k, the piece of the older one in it and the lag mixed in to first order.
double Acting(const Measured& d, std::size_t k, std::size_t whole, double older_share) {
  const auto at = [&](std::size_t back) { return d.force_N[k >= back ? k - back : 0]; };
  return (1.0 - older_share) * at(whole) + older_share * at(whole + 1);
}

}  // namespace

std::vector<Instant> Kinematics(const Measured& d, double delay_s, double lag_s, int half_width,
                                std::size_t stride, const std::vector<double>& direct_N) {
  const double t = d.period_s;
  const double in_periods = (delay_s + lag_s) / t;
  const auto whole = static_cast<std::size_t>(in_periods + 1e-9);
  const double share = in_periods - static_cast<double>(whole);
  const std::size_t n = d.size();
  std::vector<Instant> out;
  const auto half = static_cast<std::size_t>(half_width);
  if (n < 2 * half + 4) return out;
  std::vector<Row> rows(n);
  std::vector<std::size_t> good(n + 1, 0);  // how many complete rows before
  for (std::size_t k = 0; k < n; ++k) {
    const bool whole_row = k > 0 && k + 1 < n && d.present[k - 1] && d.present[k] && d.present[k + 1];
    good[k + 1] = good[k] + (whole_row ? 1 : 0);
    if (!whole_row) continue;
    rows[k].velocity = (d.position_m[k + 1] - d.position_m[k - 1]) / (2.0 * t);
    rows[k].acceleration = (d.position_m[k + 1] - 2.0 * d.position_m[k] + d.position_m[k - 1]) / (t * t);
    rows[k].force = 0.5 * (Acting(d, k - 1, whole, share) + Acting(d, k, whole, share));
    if (!direct_N.empty()) rows[k].force += direct_N[k];
  }
  double reversal_m = d.position_m[0];
  int direction = 0;
  const double width = static_cast<double>(2 * half + 1);
  for (std::size_t k = half; k + half < n; ++k) {
    if (good[k + half + 1] - good[k - half] != 2 * half + 1) {
      reversal_m = d.position_m[k];
      direction = 0;
      continue;
    }
    Instant i;
    for (std::size_t j = k - half; j <= k + half; ++j) {
      i.velocity_m_s += rows[j].velocity / width;
      i.acceleration_m_s2 += rows[j].acceleration / width;
      i.force_N += rows[j].force / width;
    }
    i.row = k;
    i.time_s = static_cast<double>(k) * t;
    i.position_m = d.position_m[k];
    const int now = i.velocity_m_s > kStanding_m_s ? 1 : i.velocity_m_s < -kStanding_m_s ? -1 : direction;
    if (now != direction) {
      direction = now;
      reversal_m = i.position_m;
    }
    i.since_reversal_m = std::fabs(i.position_m - reversal_m);
    if (k % stride == 0) out.push_back(i);
  }
  return out;
}

}  // namespace contour::identify
