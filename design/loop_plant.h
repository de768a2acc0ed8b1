#pragma once

#include <Eigen/Dense>
#include <complex>
#include <vector>

#include "core/two_inertia_loop.h"
#include "design/loop_member.h"

namespace contour {

/// Matrices of a loop in discrete time; they live on the stack.
inline constexpr int kMostClosedStates = 32;
using LoopMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMostClosedStates,
                                 kMostClosedStates>;
using Complex = std::complex<double>;

/// x' = a x + b u, y = c x + d u over one period.
struct LinearSystem {
  LoopMatrix a, b, c, d;
};

/// A member of the uncertainty set from the command of the loop (force, in units of `force_N`) and a force on
/// the table (same unit) to the positions of motor and table in metres.
struct LoopPlant {
  LinearSystem system;  ///< inputs: command, force that opposes positive motion; outputs: p1, p2
  double force_N = 0.0;
};
LoopPlant MakePlant(const LoopMember& member, double period_s, double force_N);

/// The loop's own part, from the positions of motor and table to its command in units of `force_N`.
LinearSystem MakeController(const TwoInertiaLoop& loop, double force_N);

/// Response of one input to all outputs at z = exp(i 2 pi f T), for frequencies in units of 1 / T.
std::vector<std::array<Complex, 2>> Response(const LinearSystem& system, Eigen::Index input,
                                             const std::vector<double>& frequencies);
/// Response of both inputs to the one output.
std::vector<std::array<Complex, 2>> ResponseToBoth(const LinearSystem& system,
                                                   const std::vector<double>& frequencies);

}  // namespace contour
