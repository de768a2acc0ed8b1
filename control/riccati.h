#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "control/qp_problem.h"
#include "core/wide_vectors.h"

namespace contour {

/// How an input is held while the others are optimised.
enum class Hold : std::uint8_t {
  kFree,   ///< chosen by the optimum
  kFixed,  ///< u_j = value
  kTied,   ///< u_j = u_{j-1} + value
};

template <std::size_t Axes>
struct HeldInputs {
  std::array<Hold, Axes> how{};
  AxisVector<Axes> value{};
};

/// Optimum of a QpProblem with given inputs held and no other bound, by one backward Riccati pass and one
/// roll-out: dynamic programming over the horizon, e.g. Rawlings, Mayne and Diehl, Model Predictive Control,
/// 2nd ed., ch. 8.8, with held inputs folded into the value function. Cost is linear in the horizon; nothing
/// is allocated.
template <std::size_t Axes>
class Riccati {
 public:
  using Problem = QpProblem<Axes>;
  using Inputs = std::array<AxisVector<Axes>, kMaxHorizon>;
  using Holding = std::array<HeldInputs<Axes>, kMaxHorizon>;

  /// Backward pass over stages top .. 0; those above are taken from the last call with the same problem.
  /// With top = horizon - 1 everything is computed anew.
  void Factor(const Problem& problem, const Holding& holding, std::size_t top) noexcept;

  /// The optimum of the factored problem, and the derivative of the cost by every fixed input (0 for the
  /// others).
  void RollOut(const Problem& problem, const Holding& holding, Inputs& input,
               Inputs& gradient) const noexcept;

  /// Curvature of the cost-to-go in an input; positive.
  [[nodiscard]] double curvature(std::size_t stage, std::size_t axis) const noexcept {
    return policy_[stage].curvature[axis];
  }

 private:
  static constexpr std::size_t kStates = 2 * Axes;
  using SquareBlock = std::array<AxisVector<Axes>, Axes>;

  // 1/2 s' P s + h' s.
  struct Value {
    SquareBlock pp{}, pv{}, vv{};  // position-position, position-velocity, velocity-velocity
    AxisVector<Axes> p{}, v{};
  };
  // What tied inputs add, in the inputs q of the stage before: q' C s + 1/2 q' Q q + l' q.
  struct Ties {
    SquareBlock qp{}, qv{}, qq{};
    AxisVector<Axes> q{};
  };
  // What a stage's step needs of the dynamics; the same for all stages.
  struct Coefficients {
    AxisVector<Axes> a, e, c;   // position from velocity, velocity kept, position from command
    AxisVector<Axes> b_p, b_v;  // next drift position and velocity from command
  };
  // Free: u_i = on_position p + on_velocity v + on_input u + offset, inputs after i and held ones only.
  // Fixed: the same expression is the derivative by u_i, all inputs.
  struct Policy {
    SquareBlock on_position{}, on_velocity{}, on_input{};
    AxisVector<Axes> offset{};
    AxisVector<Axes> curvature{};
    bool all_free = false;  ///< on_input is not used
  };
  // Quadratic form over (inputs u, state s) before the inputs are chosen; that of s alone stands in Value.
  struct StageForm {
    SquareBlock uu, up, uv;  // [input axis][input, position or velocity axis]
    AxisVector<Axes> u;
  };

  void FactorStage(const Problem& problem, const HeldInputs<Axes>& held, std::size_t j) noexcept;
  void BuildForm(const Problem& problem, std::size_t j, StageForm& form, Value& value) const noexcept;
  static void AddTies(const Problem& problem, const Coefficients& k, const Ties& next, std::size_t j,
                      StageForm& form) noexcept;
  // Two axes, neither held.
  [[nodiscard]] static bool FreePair(const HeldInputs<Axes>& held) noexcept {
    return Axes == 2 && held.how[0] == Hold::kFree && held.how[Axes - 1] == Hold::kFree;
  }
  // FactorStage from stage j, of which FreePair is true, down to the last one of which it is; returns that
  // one. BuildForm and ChooseAll of two axes in one, on blocks.
  std::size_t FactorFreePairs(const Problem& problem, const Holding& holding, std::size_t j) noexcept;
  // The same. (Which translation fits is only known in the file that has them.)
  CONTOUR_WIDE_VECTORS std::size_t FactorBlocks(const Problem& problem, const Holding& holding,
                                                std::size_t j) noexcept;
  std::size_t RollOutFreePairs(const Problem& problem, std::size_t j, DriftState<Axes>& s, Inputs& input,
                               Inputs& gradient) const noexcept;
  static void ChooseAll(const StageForm& form, Value& value, Policy& policy) noexcept;
  static void ChooseFree(const HeldInputs<Axes>& held, StageForm& form, Value& value,
                         Policy& policy) noexcept;
  static bool FoldHeld(const HeldInputs<Axes>& held, const StageForm& form, Value& value, Policy& policy,
                       Ties& ties) noexcept;
  static Value TerminalValue(const Problem& problem) noexcept;

  Coefficients coefficients_{};
  std::array<Value, kMaxHorizon + 1> value_{};
  std::array<Policy, kMaxHorizon> policy_{};
  std::array<bool, kMaxHorizon + 1> has_ties_{};
  std::array<Ties, kMaxHorizon> ties_{};
};

/// State after interval j when `input` acts in it, without the defect of the interval after.
template <std::size_t Axes>
inline DriftState<Axes> Advance(const QpProblem<Axes>& problem, const DriftState<Axes>& s, std::size_t j,
                                const AxisVector<Axes>& input) noexcept {
  DriftState<Axes> next;
  const bool last = j + 1 >= problem.horizon;
  for (std::size_t i = 0; i < Axes; ++i) {
    const AxisDynamics& d = problem.dynamics[i];
    const double error = s.position[i] + d.position_from_command * input[i];
    const double velocity = s.velocity[i] + d.velocity_from_command * input[i];
    next.position[i] = error + d.position_from_velocity * velocity + d.position_from_previous * input[i];
    next.velocity[i] = d.velocity_kept * velocity + d.velocity_from_previous * input[i];
    if (!last) {
      next.position[i] += problem.stage[j + 1].position_defect[i];
      next.velocity[i] += problem.stage[j + 1].velocity_defect[i];
    }
  }
  return next;
}

/// Cost of any inputs.
template <std::size_t Axes>
double Cost(const QpProblem<Axes>& problem, const typename Riccati<Axes>::Inputs& input) noexcept;

/// Derivative of the cost by every input, by roll-out and adjoint.
template <std::size_t Axes>
void Gradient(const QpProblem<Axes>& problem, const typename Riccati<Axes>::Inputs& input,
              typename Riccati<Axes>::Inputs& gradient) noexcept;

}  // namespace contour
