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
  if (top + 1 == problem.horizon) {
    value_[problem.horizon] = TerminalValue(problem);
    has_ties_[problem.horizon] = false;
    for (std::size_t i = 0; i < Axes; ++i) {
      const AxisDynamics& d = problem.dynamics[i];
      coefficients_.a[i] = d.position_from_velocity;
      coefficients_.e[i] = d.velocity_kept;
      coefficients_.c[i] = d.position_from_command;
      coefficients_.b_p[i] = d.position_from_command + d.position_from_velocity * d.velocity_from_command +
                             d.position_from_previous;
      coefficients_.b_v[i] = d.velocity_kept * d.velocity_from_command + d.velocity_from_previous;
    }
  }
  for (std::size_t j = top + 1; j-- > 0;) {
    if (!has_ties_[j + 1] && FreePair(holding[j])) {
      j = FactorFreePairs(problem, holding, j);
    } else {
      FactorStage(problem, holding[j], j);
    }
  }
}

template <std::size_t Axes>
void Riccati<Axes>::FactorStage(const Problem& problem, const HeldInputs<Axes>& held,
                                std::size_t j) noexcept {
  StageForm form;
  Value& value = value_[j];
  Policy& policy = policy_[j];
  BuildForm(problem, j, form, value);
  if (has_ties_[j + 1]) AddTies(problem, coefficients_, ties_[j + 1], j, form);
  bool all_free = true;
  for (std::size_t i = 0; i < Axes; ++i) {
    all_free = all_free && held.how[i] == Hold::kFree;
    policy.curvature[i] = form.uu[i][i];
  }
  has_ties_[j] = false;
  policy.all_free = all_free && Axes <= 2;
  if (policy.all_free) {
    ChooseAll(form, value, policy);
    return;
  }
  ChooseFree(held, form, value, policy);
  has_ties_[j] = FoldHeld(held, form, value, policy, ties_[j]);
}

// Cost of the stage and cost-to-go of s_{j+1} = A s_j + B u_j + defect, over (u, s).
template <std::size_t Axes>
void Riccati<Axes>::BuildForm(const Problem& problem, std::size_t j, StageForm& form,
                              Value& value) const noexcept {
  const Value& next = value_[j + 1];
  const SquareBlock& weight = problem.stage[j].weight;
  const Coefficients& k = coefficients_;

  // Gradient of the value at the defect.
  AxisVector<Axes> h_p = next.p, h_v = next.v;
  if (j + 1 < problem.horizon) {
    const AxisVector<Axes>& defect_p = problem.stage[j + 1].position_defect;
    const AxisVector<Axes>& defect_v = problem.stage[j + 1].velocity_defect;
    for (std::size_t i = 0; i < Axes; ++i) {
      for (std::size_t m = 0; m < Axes; ++m) {
        h_p[i] += next.pp[i][m] * defect_p[m] + next.pv[i][m] * defect_v[m];
        h_v[i] += next.pv[m][i] * defect_p[m] + next.vv[i][m] * defect_v[m];
      }
    }
  }

  SquareBlock w_p, w_v;  // P B, [state axis][input axis]
  for (std::size_t m = 0; m < Axes; ++m) {
    for (std::size_t i = 0; i < Axes; ++i) {
      w_p[m][i] = next.pp[m][i] * k.b_p[i] + next.pv[m][i] * k.b_v[i];
      w_v[m][i] = next.pv[i][m] * k.b_p[i] + next.vv[m][i] * k.b_v[i];
    }
  }
  for (std::size_t i = 0; i < Axes; ++i) {
    for (std::size_t m = 0; m < Axes; ++m) {
      const double from_error = k.c[i] * weight[i][m];
      form.uu[i][m] = k.b_p[i] * w_p[i][m] + k.b_v[i] * w_v[i][m] + from_error * k.c[m];
      form.up[i][m] = w_p[m][i] + from_error;
      form.uv[i][m] = k.a[m] * w_p[m][i] + k.e[m] * w_v[m][i];
      value.pp[i][m] = next.pp[i][m] + weight[i][m];
      value.pv[i][m] = k.a[m] * next.pp[i][m] + k.e[m] * next.pv[i][m];
    }
    form.uu[i][i] += problem.effort[i];
    form.u[i] = k.b_p[i] * h_p[i] + k.b_v[i] * h_v[i];
    value.p[i] = h_p[i];
    value.v[i] = k.a[i] * h_p[i] + k.e[i] * h_v[i];
  }
  for (std::size_t i = 0; i < Axes; ++i) {
    for (std::size_t m = 0; m < Axes; ++m) {
      value.vv[i][m] = k.a[i] * value.pv[i][m] + k.e[i] * (k.a[m] * next.pv[m][i] + k.e[m] * next.vv[i][m]);
    }
  }
}

// What the input means to tied inputs of the stage after.
template <std::size_t Axes>
void Riccati<Axes>::AddTies(const Problem& problem, const Coefficients& k, const Ties& next, std::size_t j,
                            StageForm& form) noexcept {
  AxisVector<Axes> defect_p{}, defect_v{};
  if (j + 1 < problem.horizon) {
    defect_p = problem.stage[j + 1].position_defect;
    defect_v = problem.stage[j + 1].velocity_defect;
  }
  for (std::size_t i = 0; i < Axes; ++i) {
    for (std::size_t m = 0; m < Axes; ++m) {
      form.uu[i][m] += k.b_p[i] * next.qp[m][i] + k.b_v[i] * next.qv[m][i] + k.b_p[m] * next.qp[i][m] +
                       k.b_v[m] * next.qv[i][m] + next.qq[i][m];
      form.up[i][m] += next.qp[i][m];
      form.uv[i][m] += k.a[m] * next.qp[i][m] + k.e[m] * next.qv[i][m];
      form.u[i] += next.qp[i][m] * defect_p[m] + next.qv[i][m] * defect_v[m];
    }
    form.u[i] += next.q[i];
  }
}

// One or two inputs, all free: gains by the inverse in closed form.
template <std::size_t Axes>
void Riccati<Axes>::ChooseAll(const StageForm& form, Value& value, Policy& policy) noexcept {
  SquareBlock inverse{};  // of uu, negative
  if constexpr (Axes == 1) {
    inverse[0][0] = -1.0 / form.uu[0][0];
  } else if constexpr (Axes == 2) {
    const double scale = -1.0 / (form.uu[0][0] * form.uu[1][1] - form.uu[0][1] * form.uu[1][0]);
    inverse[0][0] = scale * form.uu[1][1];
    inverse[1][1] = scale * form.uu[0][0];
    inverse[0][1] = inverse[1][0] = -scale * form.uu[0][1];
  }
  for (std::size_t i = 0; i < Axes; ++i) {
    policy.offset[i] = 0.0;
    for (std::size_t m = 0; m < Axes; ++m) policy.offset[i] += inverse[i][m] * form.u[m];
    for (std::size_t n = 0; n < Axes; ++n) {
      double by_p = 0.0, by_v = 0.0;
      for (std::size_t m = 0; m < Axes; ++m) {
        by_p += inverse[i][m] * form.up[m][n];
        by_v += inverse[i][m] * form.uv[m][n];
      }
      policy.on_position[i][n] = by_p;
      policy.on_velocity[i][n] = by_v;
    }
  }
  for (std::size_t m = 0; m < Axes; ++m) {
    for (std::size_t i = 0; i < Axes; ++i) {
      for (std::size_t n = 0; n < Axes; ++n) {
        if (n >= m) value.pp[m][n] += form.up[i][m] * policy.on_position[i][n];
        if (n >= m) value.vv[m][n] += form.uv[i][m] * policy.on_velocity[i][n];
        value.pv[m][n] += form.up[i][m] * policy.on_velocity[i][n];
      }
      value.p[m] += form.up[i][m] * policy.offset[i];
      value.v[m] += form.uv[i][m] * policy.offset[i];
    }
    for (std::size_t n = 0; n < m; ++n) {
      value.pp[m][n] = value.pp[n][m];
      value.vv[m][n] = value.vv[n][m];
    }
  }
}

// Free inputs leave one after the other; what remains is a form over (later inputs, held inputs, s).
template <std::size_t Axes>
void Riccati<Axes>::ChooseFree(const HeldInputs<Axes>& held, StageForm& form, Value& value,
                               Policy& policy) noexcept {
  for (std::size_t i = 0; i < Axes; ++i) {
    if (held.how[i] != Hold::kFree) continue;
    const auto gone = [&held, i](std::size_t m) { return m == i || (m < i && held.how[m] == Hold::kFree); };
    const double inverse = 1.0 / form.uu[i][i];
    AxisVector<Axes> k_u, k_p, k_v;
    for (std::size_t m = 0; m < Axes; ++m) {
      k_u[m] = gone(m) ? 0.0 : -inverse * form.uu[i][m];
      k_p[m] = -inverse * form.up[i][m];
      k_v[m] = -inverse * form.uv[i][m];
    }
    const double k_0 = -inverse * form.u[i];
    for (std::size_t m = 0; m < Axes; ++m) {
      for (std::size_t n = 0; n < Axes; ++n) {
        value.pp[m][n] += form.up[i][m] * k_p[n];
        value.pv[m][n] += form.up[i][m] * k_v[n];
        value.vv[m][n] += form.uv[i][m] * k_v[n];
      }
      value.p[m] += form.up[i][m] * k_0;
      value.v[m] += form.uv[i][m] * k_0;
    }
    for (std::size_t m = 0; m < Axes; ++m) {
      if (gone(m)) continue;
      const double coupling = form.uu[m][i];
      for (std::size_t n = 0; n < Axes; ++n) {
        form.up[m][n] += coupling * k_p[n];
        form.uv[m][n] += coupling * k_v[n];
        form.uu[m][n] += coupling * k_u[n];
      }
      form.u[m] += coupling * k_0;
    }
    policy.on_input[i] = k_u;
    policy.on_position[i] = k_p;
    policy.on_velocity[i] = k_v;
    policy.offset[i] = k_0;
  }
}

// With the free inputs gone: a held input's row is the derivative by it; its value enters the cost-to-go.
template <std::size_t Axes>
bool Riccati<Axes>::FoldHeld(const HeldInputs<Axes>& held, const StageForm& form, Value& value,
                             Policy& policy, Ties& ties) noexcept {
  bool any_tied = false;
  for (std::size_t i = 0; i < Axes; ++i) {
    if (held.how[i] == Hold::kFree) continue;
    if (held.how[i] == Hold::kTied) any_tied = true;
    policy.on_position[i] = form.up[i];
    policy.on_velocity[i] = form.uv[i];
    policy.offset[i] = form.u[i];
    for (std::size_t m = 0; m < Axes; ++m) {
      policy.on_input[i][m] = held.how[m] == Hold::kFree ? 0.0 : form.uu[i][m];
      value.p[m] += form.up[i][m] * held.value[i];
      value.v[m] += form.uv[i][m] * held.value[i];
    }
  }
  if (!any_tied) return false;
  for (std::size_t i = 0; i < Axes; ++i) {
    const bool tied = held.how[i] == Hold::kTied;
    ties.q[i] = tied ? form.u[i] : 0.0;
    for (std::size_t m = 0; m < Axes; ++m) {
      ties.qp[i][m] = tied ? form.up[i][m] : 0.0;
      ties.qv[i][m] = tied ? form.uv[i][m] : 0.0;
      ties.qq[i][m] = tied && held.how[m] == Hold::kTied ? form.uu[i][m] : 0.0;
      if (tied && held.how[m] != Hold::kFree) ties.q[i] += form.uu[i][m] * held.value[m];
    }
  }
  return true;
}

template <std::size_t Axes>
void Riccati<Axes>::RollOut(const Problem& problem, const Holding& holding, Inputs& input,
                            Inputs& gradient) const noexcept {
  DriftState<Axes> s = problem.start;
  AxisVector<Axes> previous = problem.previous;
  for (std::size_t j = 0; j < problem.horizon; ++j) {
    const HeldInputs<Axes>& held = holding[j];
    const Policy& policy = policy_[j];
    if (Axes == 2 && policy.all_free) {
      j = RollOutFreePairs(problem, j, s, input, gradient);
      previous = input[j];
      continue;
    }
    AxisVector<Axes> u{};
    if (policy.all_free) {
      u = policy.offset;
      for (std::size_t i = 0; i < Axes; ++i) {
        for (std::size_t k = 0; k < Axes; ++k) {
          u[i] += policy.on_position[i][k] * s.position[k] + policy.on_velocity[i][k] * s.velocity[k];
        }
      }
      input[j] = u;
      gradient[j] = {};
      s = Advance(problem, s, j, u);
      previous = u;
      continue;
    }
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
