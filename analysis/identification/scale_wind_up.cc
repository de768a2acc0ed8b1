#include "analysis/identification/scale_wind_up.h"

#include <cmath>

#include "analysis/identification/kinematics.h"

namespace contour::identify {

ScrewWindUp FitWindUp(const std::vector<Measured>& records, const TableAxis& axis) {
  // motor - table = S / K + constant, S the force through the screw; blocks of a second have a constant each,
  // so that the lead's error does not matter.
  ScrewWindUp fit;
  double ss = 0.0, sd = 0.0;
  struct Block {
    double ss, sd;
  };
  std::vector<Block> blocks;
  for (const Measured& d : records) {
    if (d.table_m.empty()) continue;
    const auto instants = Kinematics(d, axis.delay_s, axis.lag_s, 4, 4);
    for (std::size_t i = 0; i < instants.size();) {
      const double begin = instants[i].time_s;
      double n = 0.0, s1 = 0.0, d1 = 0.0, s2 = 0.0, sd2 = 0.0;
      for (; i < instants.size() && instants[i].time_s < begin + 1.0; ++i) {
        const double table = d.table_m[instants[i].row];
        if (!std::isfinite(table)) continue;
        const double force = instants[i].force_N - axis.motor_inertia * instants[i].acceleration_m_s2;
        const double wind_up = instants[i].position_m - table;
        n += 1.0;
        s1 += force;
        d1 += wind_up;
        s2 += force * force;
        sd2 += force * wind_up;
      }
      if (n < 20.0) continue;
      blocks.push_back({s2 - s1 * s1 / n, sd2 - s1 * d1 / n});
      ss += blocks.back().ss;
      sd += blocks.back().sd;
    }
  }
  if (blocks.size() < 4 || sd <= 0.0 || ss < 100.0 * static_cast<double>(blocks.size())) return fit;
  const double compliance = sd / ss;
  double scatter = 0.0;
  for (const Block& b : blocks) scatter += std::pow(b.sd - compliance * b.ss, 2);
  fit.found = true;
  fit.stiffness_N_m = 1.0 / compliance;
  fit.sigma_rel = std::sqrt(scatter) / sd;
  return fit;
}

}  // namespace contour::identify
