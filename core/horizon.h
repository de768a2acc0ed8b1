#pragma once

#include "core/axis.h"
#include "core/fixed_vector.h"

namespace contour {

/// Longest MPC horizon N; the reference is handed over for three more points.
inline constexpr std::size_t kMaxHorizon = 40;
inline constexpr std::size_t kMaxHorizonPoints = kMaxHorizon + 8;

/// Reference of one axis: element j belongs to t(k-1+j). Element 0 is the instant of the newest feedback,
/// element 1 is t(k), when the torque now being computed starts to act, and so on, one period apart.
using AxisHorizon = FixedVector<ReferencePoint, kMaxHorizonPoints>;

/// Friction expected along an AxisHorizon, same indices. Positive opposes positive motion.
struct FrictionAhead {
  double node_N = 0.0;  ///< at t(k-1+j)
  double mid_N = 0.0;   ///< mean over [t(k-1+j), t(k+j))
  double lead_m = 0.0;  ///< by how much the motor must lead the table beside the wind-up, at t(k-1+j)
};
using FrictionPreview = FixedVector<FrictionAhead, kMaxHorizonPoints>;

}  // namespace contour
