#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "control/qp_problem.h"
#include "control/riccati.h"
#include "control/working_set.h"

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

/// Solves QpProblem. First a primal-dual active set method (Hintermueller, Ito and Kunisch, SIAM J. Optim.
/// 13(3), 2002) which is done after one pass when the active bounds were guessed right, then, when it
/// circles, a projected Newton method with epsilon-active set (Bertsekas, SIAM J. Control Optim. 20(2),
/// 1982): every iterate feasible, cost never rising. Rate limits: when the solution without them breaks one,
/// a primal active set method over both kinds of bounds, feasible and descending likewise. Every step solves
/// its equality-constrained problem by Riccati recursion. Fixed size; Solve neither allocates nor throws.
///
/// Bounds must leave room: lowest <= highest, and the bounds of a stage within reach of those of the stage
/// before. Where `previous` is out of reach of stage 0 the step limit gives way there.
template <std::size_t Axes>
class QpSolver {
 public:
  using Problem = QpProblem<Axes>;
  using Inputs = typename Riccati<Axes>::Inputs;
  using Active = ActiveSet<Axes>;

  /// `active`: in, a guess (e.g. the last solution's, one stage on); out, the solution's. Folds the step
  /// bound of stage 0 into its value bound.
  QpReport Solve(Problem& problem, int iteration_cap, Active& active, Inputs& input) noexcept;

 private:
  using Holding = typename Riccati<Axes>::Holding;

  struct Blocking {
    double length = 1.0;  ///< share of the way that is free
    std::size_t stage = 0, axis = 0;
    ActiveBounds bound;
  };

  // The best feasible point met so far.
  void Forget() noexcept;
  void RememberClipped(const Problem& problem, const Inputs& input) noexcept;

  // Bounds on values only.
  bool PrimalDual(const Problem& problem, int cap, Active& active, Inputs& input, QpReport& report) noexcept;
  void ProjectedNewton(const Problem& problem, int cap, Active& active, QpReport& report) noexcept;
  std::size_t UpdateActive(const Problem& problem, const Inputs& input, const Inputs& gradient,
                           Active& active) const noexcept;
  void HoldValues(const Problem& problem, const Active& active) noexcept;

  // Bounds on steps too.
  [[nodiscard]] bool StepsWithin(const Problem& problem, const Inputs& input) const noexcept;
  bool PrimalDualWithSteps(const Problem& problem, int cap, Active& active, Inputs& input,
                           QpReport& report) noexcept;
  void PrimalActiveSet(const Problem& problem, int cap, Active& active, QpReport& report) noexcept;
  bool UpdateWithSteps(const Problem& problem, const Inputs& input, Active& active) noexcept;
  bool DropWorst(const Problem& problem, Active& active) noexcept;
  [[nodiscard]] Blocking FindBlocking(const Problem& problem, const Active& active, const Inputs& from,
                                      const Inputs& to) const noexcept;
  void SolveHeld(const Problem& problem, const Active& active, Inputs& input) noexcept;

  Riccati<Axes> riccati_;
  Holding holding_{};
  Inputs gradient_{};
  Inputs target_{};
  Inputs trial_{};
  Inputs best_{};
  Active best_active_{};
  double best_cost_ = 0.0;
  Multipliers<Axes> multipliers_{};
};

}  // namespace contour
