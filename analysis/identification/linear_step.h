#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "analysis/identification/table_axis.h"

namespace contour::identify {

/// Shorter lags of the torque are simulated as this.
inline constexpr double kShortestLag_s = 5e-6;

/// Everything linear over a step, with the current loop df/dt = (command - f) / lag in it: exact.
struct LinearStep {
  Eigen::Matrix4d a;
  Eigen::Vector4d table;    ///< per N at the mass that rubs
  Eigen::Vector4d delayed;  ///< per N behind the lag at the beginning
  Eigen::Vector4d command;  ///< per N commanded
  Eigen::Vector4d motor;    ///< per N at the motor, at once
  double lag_left = 0.0;
};
LinearStep Over(const TableAxis& axis, double viscous_Ns_m, double step_s);

inline constexpr int kSubSteps = 5;  ///< of a period, where nothing else is asked for

/// Sub-steps of a period, one of them cut in two where the command changes.
struct PeriodSteps {
  struct Piece {
    double step_s = 0.0;
    LinearStep linear;
    bool older = false;        ///< before the delay's edge, where the older command acts
    bool ends_substep = true;  ///< the delay does not cut it
  };
  std::size_t whole_delay = 0;
  std::vector<Piece> pieces;
  [[nodiscard]] bool SameCuts(const PeriodSteps& other) const;
};
/// `axis` without what swings on its table.
PeriodSteps StepsOf(const TableAxis& axis, double period_s, int substeps);

}  // namespace contour::identify
