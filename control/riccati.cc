#include "control/riccati.h"

namespace contour {

template <std::size_t Axes>
typename Riccati<Axes>::Value Riccati<Axes>::TerminalValue(const Problem& problem) noexcept {
  Value value;
  for (std::size_t i = 0; i < Axes; ++i) {
    for (std::size_t k = 0; k < Axes; ++k) {
      value.pp[i][k] = problem.terminal[i][k];
      value.pv[i][k] = problem.terminal[i][Axes + k];
      value.vv[i][k] = problem.terminal[Axes + i][Axes + k];
    }
  }
  return value;
}

template <std::size_t Axes>
void Riccati<Axes>::Factor(const Problem& problem, const Holding& holding, std::size_t top) noexcept {
  if (top + 1 == problem.horizon) value_[problem.horizon] = TerminalValue(problem);
  for (std::size_t j = top + 1; j-- > 0;) FactorStage(problem, holding[j], j);
}

template <std::size_t Axes>
void Riccati<Axes>::FactorStage(const Problem& problem, const HeldInputs<Axes>& held,
                                std::size_t j) noexcept {
  const Value& next = value_[j + 1];
  const SquareBlock& weight = problem.stage[j].weight;
  const auto& dyn = problem.dynamics;

  // s_{j+1} = A s_j + B u_j + defect; b_p, b_v are the rows of B.
  AxisVector<Axes> a, e, c, b_p, b_v;
  for (std::size_t i = 0; i < Axes; ++i) {
    a[i] = dyn[i].position_from_velocity;
    e[i] = dyn[i].velocity_kept;
    c[i] = dyn[i].position_from_command;
    b_p[i] = c[i] + a[i] * dyn[i].velocity_from_command + dyn[i].position_from_previous;
    b_v[i] = e[i] * dyn[i].velocity_from_command + dyn[i].velocity_from_previous;
  }

  // Gradient of the value at the defect.
  AxisVector<Axes> h_p = next.p, h_v = next.v;
  if (j + 1 < problem.horizon) {
    const AxisVector<Axes>& defect_p = problem.stage[j + 1].position_defect;
    const AxisVector<Axes>& defect_v = problem.stage[j + 1].velocity_defect;
    for (std::size_t i = 0; i < Axes; ++i) {
      for (std::size_t k = 0; k < Axes; ++k) {
        h_p[i] += next.pp[i][k] * defect_p[k] + next.pv[i][k] * defect_v[k];
        h_v[i] += next.pv[k][i] * defect_p[k] + next.vv[i][k] * defect_v[k];
      }
    }
  }

  // P B, then the quadratic form over (u, s).
  SquareBlock w_p, w_v;  // [state axis][input axis]
  for (std::size_t k = 0; k < Axes; ++k) {
    for (std::size_t i = 0; i < Axes; ++i) {
      w_p[k][i] = next.pp[k][i] * b_p[i] + next.pv[k][i] * b_v[i];
      w_v[k][i] = next.pv[i][k] * b_p[i] + next.vv[k][i] * b_v[i];
    }
  }
  SquareBlock uu, up, uv;  // [input axis][input, position or velocity axis]
  AxisVector<Axes> u;
  for (std::size_t i = 0; i < Axes; ++i) {
    for (std::size_t k = 0; k < Axes; ++k) {
      uu[i][k] = b_p[i] * w_p[i][k] + b_v[i] * w_v[i][k] + c[i] * weight[i][k] * c[k];
      up[i][k] = w_p[k][i] + c[i] * weight[i][k];
      uv[i][k] = a[k] * w_p[k][i] + e[k] * w_v[k][i];
    }
    uu[i][i] += problem.effort[i];
    u[i] = b_p[i] * h_p[i] + b_v[i] * h_v[i];
  }
  if (next.tied) {
    AxisVector<Axes> defect_p{}, defect_v{};
    if (j + 1 < problem.horizon) {
      defect_p = problem.stage[j + 1].position_defect;
      defect_v = problem.stage[j + 1].velocity_defect;
    }
    for (std::size_t i = 0; i < Axes; ++i) {
      for (std::size_t k = 0; k < Axes; ++k) {
        uu[i][k] += b_p[i] * next.qp[k][i] + b_v[i] * next.qv[k][i] + b_p[k] * next.qp[i][k] +
                    b_v[k] * next.qv[i][k] + next.qq[i][k];
        up[i][k] += next.qp[i][k];
        uv[i][k] += a[k] * next.qp[i][k] + e[k] * next.qv[i][k];
        u[i] += next.qp[i][k] * defect_p[k] + next.qv[i][k] * defect_v[k];
      }
      u[i] += next.q[i];
    }
  }

  Value& value = value_[j];
  for (std::size_t i = 0; i < Axes; ++i) {
    for (std::size_t k = 0; k < Axes; ++k) {
      const double mixed = a[k] * next.pp[i][k] + e[k] * next.pv[i][k];
      value.pp[i][k] = next.pp[i][k] + weight[i][k];
      value.pv[i][k] = mixed;
    }
  }
  for (std::size_t i = 0; i < Axes; ++i) {
    for (std::size_t k = 0; k < Axes; ++k) {
      value.vv[i][k] = a[i] * value.pv[i][k] + e[i] * (a[k] * next.pv[k][i] + e[k] * next.vv[i][k]);
    }
    value.p[i] = h_p[i];
    value.v[i] = a[i] * h_p[i] + e[i] * h_v[i];
  }

  // Free inputs leave one after the other; what remains is a form over (later inputs, held inputs, s).
  Policy& policy = policy_[j];
  for (std::size_t i = 0; i < Axes; ++i) {
    policy.curvature[i] = uu[i][i];
    if (held.how[i] != Hold::kFree) continue;
    const double inverse = 1.0 / uu[i][i];
    AxisVector<Axes> k_u, k_p, k_v;
    for (std::size_t k = 0; k < Axes; ++k) {
      // Inputs that left before i are not among those u_i may depend on.
      const bool gone = k == i || (k < i && held.how[k] == Hold::kFree);
      k_u[k] = gone ? 0.0 : -inverse * uu[i][k];
      k_p[k] = -inverse * up[i][k];
      k_v[k] = -inverse * uv[i][k];
    }
    const double k_0 = -inverse * u[i];
    for (std::size_t m = 0; m < Axes; ++m) {
      for (std::size_t k = 0; k < Axes; ++k) {
        value.pp[m][k] += up[i][m] * k_p[k];
        value.pv[m][k] += up[i][m] * k_v[k];
        value.vv[m][k] += uv[i][m] * k_v[k];
      }
      value.p[m] += up[i][m] * k_0;
      value.v[m] += uv[i][m] * k_0;
    }
    for (std::size_t m = 0; m < Axes; ++m) {
      if (m == i || (m < i && held.how[m] == Hold::kFree)) continue;
      for (std::size_t k = 0; k < Axes; ++k) {
        up[m][k] += uu[m][i] * k_p[k];
        uv[m][k] += uu[m][i] * k_v[k];
      }
      u[m] += uu[m][i] * k_0;
      for (std::size_t k = 0; k < Axes; ++k) {
        if (k != i) uu[m][k] += uu[m][i] * k_u[k];
      }
    }
    policy.on_input[i] = k_u;
    policy.on_position[i] = k_p;
    policy.on_velocity[i] = k_v;
    policy.offset[i] = k_0;
  }

  value.tied = false;
  for (std::size_t i = 0; i < Axes; ++i) {
    if (held.how[i] == Hold::kFree) continue;
    if (held.how[i] == Hold::kTied) value.tied = true;
    // The free inputs are gone: the row is the derivative by u_i with them at their optimum.
    policy.on_position[i] = up[i];
    policy.on_velocity[i] = uv[i];
    policy.offset[i] = u[i];
    for (std::size_t k = 0; k < Axes; ++k) {
      policy.on_input[i][k] = held.how[k] == Hold::kFree ? 0.0 : uu[i][k];
      value.p[k] += up[i][k] * held.value[i];
      value.v[k] += uv[i][k] * held.value[i];
    }
  }
  if (!value.tied) return;
  for (std::size_t i = 0; i < Axes; ++i) {
    const bool tied = held.how[i] == Hold::kTied;
    value.q[i] = tied ? u[i] : 0.0;
    for (std::size_t k = 0; k < Axes; ++k) {
      value.qp[i][k] = tied ? up[i][k] : 0.0;
      value.qv[i][k] = tied ? uv[i][k] : 0.0;
      value.qq[i][k] = tied && held.how[k] == Hold::kTied ? uu[i][k] : 0.0;
      if (tied && held.how[k] != Hold::kFree) value.q[i] += uu[i][k] * held.value[k];
    }
  }
}

template <std::size_t Axes>
void Riccati<Axes>::RollOut(const Problem& problem, const Holding& holding, Inputs& input,
                            Inputs& gradient) const noexcept {
  DriftState<Axes> s = problem.start;
  AxisVector<Axes> previous = problem.previous;
  for (std::size_t j = 0; j < problem.horizon; ++j) {
    const HeldInputs<Axes>& held = holding[j];
    const Policy& policy = policy_[j];
    AxisVector<Axes> u{};
    for (std::size_t i = 0; i < Axes; ++i) {
      if (held.how[i] == Hold::kFixed) u[i] = held.value[i];
      if (held.how[i] == Hold::kTied) u[i] = previous[i] + held.value[i];
    }
    AxisVector<Axes> row;
    for (std::size_t i = Axes; i-- > 0;) {
      double sum = policy.offset[i];
      for (std::size_t k = 0; k < Axes; ++k) {
        sum += policy.on_position[i][k] * s.position[k] + policy.on_velocity[i][k] * s.velocity[k] +
               policy.on_input[i][k] * u[k];
      }
      row[i] = sum;
      if (held.how[i] == Hold::kFree) u[i] = sum;
    }
    for (std::size_t i = 0; i < Axes; ++i) gradient[j][i] = held.how[i] == Hold::kFixed ? row[i] : 0.0;
    input[j] = u;
    s = Advance(problem, s, j, u);
    previous = u;
  }
}

template <std::size_t Axes>
double Cost(const QpProblem<Axes>& problem, const typename Riccati<Axes>::Inputs& input) noexcept {
  DriftState<Axes> s = problem.start;
  double cost = 0.0;
  for (std::size_t j = 0; j < problem.horizon; ++j) {
    AxisVector<Axes> error;
    for (std::size_t i = 0; i < Axes; ++i) {
      error[i] = s.position[i] + problem.dynamics[i].position_from_command * input[j][i];
      cost += problem.effort[i] * input[j][i] * input[j][i];
    }
    for (std::size_t i = 0; i < Axes; ++i) {
      for (std::size_t k = 0; k < Axes; ++k) cost += error[i] * problem.stage[j].weight[i][k] * error[k];
    }
    s = Advance(problem, s, j, input[j]);
  }
  for (std::size_t i = 0; i < Axes; ++i) {
    for (std::size_t k = 0; k < Axes; ++k) {
      cost += s.position[i] * problem.terminal[i][k] * s.position[k] +
              2.0 * s.position[i] * problem.terminal[i][Axes + k] * s.velocity[k] +
              s.velocity[i] * problem.terminal[Axes + i][Axes + k] * s.velocity[k];
    }
  }
  return 0.5 * cost;
}

template <std::size_t Axes>
void Gradient(const QpProblem<Axes>& problem, const typename Riccati<Axes>::Inputs& input,
              typename Riccati<Axes>::Inputs& gradient) noexcept {
  std::array<AxisVector<Axes>, kMaxHorizon> slope;  // weight_j error_j
  DriftState<Axes> s = problem.start;
  for (std::size_t j = 0; j < problem.horizon; ++j) {
    AxisVector<Axes> error;
    for (std::size_t i = 0; i < Axes; ++i) {
      error[i] = s.position[i] + problem.dynamics[i].position_from_command * input[j][i];
    }
    for (std::size_t i = 0; i < Axes; ++i) {
      slope[j][i] = 0.0;
      for (std::size_t k = 0; k < Axes; ++k) slope[j][i] += problem.stage[j].weight[i][k] * error[k];
    }
    s = Advance(problem, s, j, input[j]);
  }
  AxisVector<Axes> costate_p{}, costate_v{};
  for (std::size_t i = 0; i < Axes; ++i) {
    for (std::size_t k = 0; k < Axes; ++k) {
      costate_p[i] += problem.terminal[i][k] * s.position[k] + problem.terminal[i][Axes + k] * s.velocity[k];
      costate_v[i] += problem.terminal[k][Axes + i] * s.position[k] +
                      problem.terminal[Axes + i][Axes + k] * s.velocity[k];
    }
  }
  for (std::size_t j = problem.horizon; j-- > 0;) {
    for (std::size_t i = 0; i < Axes; ++i) {
      const AxisDynamics& d = problem.dynamics[i];
      // By way of error_j and of the velocity at the end of the interval.
      const double by_error = slope[j][i] + costate_p[i];
      const double by_velocity = d.position_from_velocity * costate_p[i] + d.velocity_kept * costate_v[i];
      gradient[j][i] = problem.effort[i] * input[j][i] + d.position_from_command * by_error +
                       d.velocity_from_command * by_velocity + d.position_from_previous * costate_p[i] +
                       d.velocity_from_previous * costate_v[i];
      costate_p[i] = by_error;
      costate_v[i] = by_velocity;
    }
  }
}

#define CONTOUR_INSTANTIATE(Axes)                                                            \
  template class Riccati<Axes>;                                                              \
  template double Cost<Axes>(const QpProblem<Axes>&, const Riccati<Axes>::Inputs&) noexcept; \
  template void Gradient<Axes>(const QpProblem<Axes>&, const Riccati<Axes>::Inputs&,         \
                               Riccati<Axes>::Inputs&) noexcept;
CONTOUR_INSTANTIATE(1)
CONTOUR_INSTANTIATE(2)
CONTOUR_INSTANTIATE(3)
#undef CONTOUR_INSTANTIATE

}  // namespace contour
