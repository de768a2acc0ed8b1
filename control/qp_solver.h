#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "control/qp_problem.h"
#include "control/riccati.h"

namespace contour {

/// How far the solver got. Whatever it says, the inputs are finite and within all bounds.
enum class QpStatus : std::uint8_t {
  kOptimal,  ///< every optimality condition holds
  kCap,      ///< iteration cap: feasible, and no worse than any iterate before
  kStalled,  ///< no further descent within rounding; feasible
};

struct QpReport {
  QpStatus status = QpStatus::kOptimal;
  int iterations = 0;  ///< Riccati passes
};

/// Which bounds of an input are active: -1 lowest, +1 highest, 0 none.
struct ActiveBounds {
  std::int8_t value = 0;  ///< of u_j
  std::int8_t step = 0;   ///< of u_j - u_{j-1}
};

/// Solves QpProblem. First a primal-dual active set method (Hintermueller, Ito and Kunisch, SIAM J. Optim.
/// 13(3), 2002) which is done after one pass when the active bounds were guessed right, then, when it
/// circles, a projected Newton method with epsilon-active set (Bertsekas, SIAM J. Control Optim. 20(2),
/// 1982): every iterate feasible, cost never rising. Rate limits: when the solution without them breaks one,
/// a primal active set method over both kinds of bounds, feasible and descending likewise. Every step solves
/// its equality-constrained problem by Riccati recursion. Fixed size; Solve neither allocates nor throws.
///
/// Bounds must leave room: lowest <= highest, and steps from `previous` must be able to reach the bounds of
/// stage 0; otherwise the step limit gives way there.
template <std::size_t Axes>
class QpSolver {
 public:
  using Problem = QpProblem<Axes>;
  using Inputs = typename Riccati<Axes>::Inputs;
  using Active = std::array<std::array<ActiveBounds, Axes>, kMaxHorizon>;

  /// `active`: in, a guess (e.g. the last solution's, one stage on); out, the solution's.
  QpReport Solve(const Problem& problem, int iteration_cap, Active& active, Inputs& input) noexcept;

 private:
  using Holding = typename Riccati<Axes>::Holding;

  bool PrimalDual(const Problem& problem, int cap, Active& active, Inputs& input, QpReport& report) noexcept;
  void ProjectedNewton(const Problem& problem, int cap, Active& active, Inputs& input,
                       QpReport& report) noexcept;
  void HoldValues(const Problem& problem, const Active& active) noexcept;
  std::size_t UpdateActive(const Problem& problem, const Inputs& input, const Inputs& gradient,
                           Active& active) const noexcept;

  Riccati<Axes> riccati_;
  Holding holding_{};
  Inputs gradient_{};
  Inputs target_{};
  Inputs trial_{};
};

}  // namespace contour
