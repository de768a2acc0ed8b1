#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "control/axis_dynamics.h"
#include "core/horizon.h"

namespace contour {

/// A value per axis of one coupled group.
template <std::size_t Axes>
using AxisVector = std::array<double, Axes>;

/// State of a group, deviations from the reference: drift_position[i] and drift_velocity[i] are where axis i
/// would be at the end of the interval if the command of the interval were its feed-forward value. The
/// command of the interval before and every known force are in it already, so that two numbers per axis are
/// the whole state:
///
///   error_j   = drift_position_j + position_from_command u_j      deviation at the end of interval j
///   v         = drift_velocity_j + velocity_from_command u_j
///   drift_position_{j+1} = error_j + position_from_velocity v + position_from_previous u_j +
///   position_defect_{j+1} drift_velocity_{j+1} = velocity_kept v + velocity_from_previous u_j +
///   velocity_defect_{j+1}
template <std::size_t Axes>
struct DriftState {
  AxisVector<Axes> position{};
  AxisVector<Axes> velocity{};
};

/// One interval of the horizon.
template <std::size_t Axes>
struct QpStage {
  std::array<AxisVector<Axes>, Axes> weight{};  ///< symmetric, positive semidefinite, of error_j
  AxisVector<Axes> position_defect{};           ///< by which the reference misses the model; stage 0: unused
  AxisVector<Axes> velocity_defect{};
  AxisVector<Axes> lowest{};  ///< bounds of u_j
  AxisVector<Axes> highest{};
  AxisVector<Axes> lowest_step{};  ///< bounds of u_j - u_{j-1}; used with `has_rate_limit`
  AxisVector<Axes> highest_step{};
};

/// minimise  sum_j 1/2 error_j' weight_j error_j + 1/2 sum_i effort_i u_ji^2  +  1/2 s_N' terminal s_N
/// over u_0 .. u_{N-1} within the bounds. terminal is ordered position 0.., velocity 0.. .
template <std::size_t Axes>
struct QpProblem {
  static constexpr std::size_t kStates = 2 * Axes;

  std::size_t horizon = 0;
  std::array<AxisDynamics, Axes> dynamics{};
  AxisVector<Axes> effort{};
  DriftState<Axes> start;
  AxisVector<Axes> previous{};  ///< u_{-1}, for the rate limit of stage 0
  std::array<bool, Axes> has_rate_limit{};
  std::array<QpStage<Axes>, kMaxHorizon> stage{};
  std::array<std::array<double, kStates>, kStates> terminal{};
};

}  // namespace contour
