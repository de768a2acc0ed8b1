#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "control/qp_problem.h"
#include "control/riccati.h"

namespace contour {

/// Which bounds of an input are active: -1 lowest, +1 highest, 0 none.
struct ActiveBounds {
  std::int8_t value = 0;  ///< of u_j
  std::int8_t step =
      0;  ///< of u_j - u_{j-1}; never at stage 0, whose step bound is folded into its value bound
};

template <std::size_t Axes>
using ActiveSet = std::array<std::array<ActiveBounds, Axes>, kMaxHorizon>;

// Bounds on values and on steps of the inputs, axis by axis. Active steps chain neighbouring inputs into runs
// that move together; a run with an active value (its anchor) does not move at all. A second anchor in a run
// would be redundant, so a working set has at most one per run: its constraints are then linearly
// independent.

/// Folds the step bound of stage 0 into its value bound; where they leave no room the value bound wins.
/// Idempotent.
template <std::size_t Axes>
void FoldFirstStep(QpProblem<Axes>& problem) noexcept;

/// How the inputs are held while exactly the bounds in `active` are equalities.
template <std::size_t Axes>
void HoldActive(const QpProblem<Axes>& problem, const ActiveSet<Axes>& active,
                typename Riccati<Axes>::Holding& holding) noexcept;

/// Lagrange multipliers of the active bounds at a point where the held problem is solved; `gradient` is the
/// derivative of the cost by every input. A multiplier has the sign of its bound when the bound is rightly
/// active.
template <std::size_t Axes>
struct Multipliers {
  typename Riccati<Axes>::Inputs value;
  typename Riccati<Axes>::Inputs step;
};
template <std::size_t Axes>
void FindMultipliers(const QpProblem<Axes>& problem, const ActiveSet<Axes>& active,
                     const typename Riccati<Axes>::Inputs& gradient, Multipliers<Axes>& multipliers) noexcept;

/// Moves inputs into all bounds, forward in time, and says which bounds it met. The result is a working set.
template <std::size_t Axes>
void ClipForward(const QpProblem<Axes>& problem, typename Riccati<Axes>::Inputs& input,
                 ActiveSet<Axes>& active) noexcept;

/// Removes what makes an active set dependent (second anchors in a run).
template <std::size_t Axes>
void MakeIndependent(const QpProblem<Axes>& problem, ActiveSet<Axes>& active) noexcept;

}  // namespace contour
