#pragma once

#include <cmath>
#include <functional>

#include "core/cycle_record.h"
#include "core/mechanics.h"
#include "daemon/program/motion_plan.h"
#include "daemon/program/path_generator.h"

namespace contour::test {

inline constexpr double kPeriod_s = 1e-3;
inline constexpr double kScaleZero_m = 0.3172;  ///< by which the scales count from elsewhere
inline const MechanicsConfig kScrew{5.0, 5e-5, 10.0, 40.0, 1100.0};

/// Where the table is when the reference has come to these points: by index, newest last.
using Table = std::function<PerAxis<double>(const std::vector<PathPoint>& told, std::size_t now)>;

inline std::vector<PathPoint> PointsOf(PathGenerator& generator) {
  std::vector<PathPoint> points;
  for (PathPoint p; generator.Next(p);) points.push_back(p);
  return points;
}

/// The row of a cycle in which the program ran. The motor is where it was told to be and the screw is wound
/// up by a constant 40 N; the scale says where the table is.
inline CycleRecord RowAt(const std::vector<PathPoint>& told, std::size_t index, const Table& table) {
  CycleRecord r;
  r.cycle = 100 + index;
  r.state = MachineState::kRunning;
  r.program_id = told[index].program_id;
  r.path_time_s = kPeriod_s * static_cast<double>(index);
  const PerAxis<double> table_m = table(told, index);
  const Mechanics m = ToSi(kScrew);
  const double windup_m = 40.0 / m.stiffness_N_m;
  for (std::size_t i = 0; i < told[index].axes.size(); ++i) {
    AxisRecord a;
    a.reference = told[index].axes[i];
    a.feedback.fresh = a.feedback.valid = a.feedback.has_scale = true;
    a.feedback.table_position_m = table_m[i] + kScaleZero_m;
    a.feedback.torque_Nm = 40.0 * m.radius_m_rad;
    a.position_m = a.reference.position_m + windup_m;
    r.axes.push_back(a);
  }
  return r;
}

}  // namespace contour::test
