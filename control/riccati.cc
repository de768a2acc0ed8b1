#include "control/riccati.h"

#include <cstring>

#include "core/wide_vectors.h"

namespace contour {
namespace {

// Two doubles side by side, one instruction for both on every x86-64, and the rows of a 2 x 2 block, one for
// all four where there is AVX2. GCC and Clang know this notation on all targets. Blocks are only ever local
// variables of something inlined, since how they would be passed depends on the processor.
using Pair = double __attribute__((vector_size(16)));
using Block = double __attribute__((vector_size(32)));

inline Pair Load(const std::array<double, 2>& from) noexcept {
  Pair pair;
  std::memcpy(&pair, from.data(), sizeof pair);
  return pair;
}
inline void Store(Pair pair, std::array<double, 2>& to) noexcept {
  std::memcpy(to.data(), &pair, sizeof pair);
}
inline Pair Both(double x) noexcept { return Pair{x, x}; }

using SquareOfTwo = std::array<std::array<double, 2>, 2>;
[[gnu::always_inline]] inline void Load(const SquareOfTwo& from, Block& block) noexcept {
  std::memcpy(&block, &from, sizeof block);
}
[[gnu::always_inline]] inline void Store(const Block& block, SquareOfTwo& to) noexcept {
  std::memcpy(&to, &block, sizeof block);
}

}  // namespace

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

// The same arithmetic as BuildForm and ChooseAll, which say what it means, on whole blocks. Of a block b with
// rows r and s: its transpose, (r|r) and (s|s), and every element of r or of s as a row.
#define CONTOUR_TRANSPOSED(b) __builtin_shufflevector(b, b, 0, 2, 1, 3)
#define CONTOUR_FIRST_ROWS(b) __builtin_shufflevector(b, b, 0, 1, 0, 1)
#define CONTOUR_SECOND_ROWS(b) __builtin_shufflevector(b, b, 2, 3, 2, 3)
#define CONTOUR_FIRST_ROW_DOWN(b) __builtin_shufflevector(b, b, 0, 0, 1, 1)
#define CONTOUR_SECOND_ROW_DOWN(b) __builtin_shufflevector(b, b, 2, 2, 3, 3)
#define CONTOUR_SYMMETRIC(b) __builtin_shufflevector(b, b, 0, 1, 1, 3)

template <std::size_t Axes>
CONTOUR_WIDE_VECTORS std::size_t Riccati<Axes>::FactorFreePairs(const Problem& problem,
                                                                const Holding& holding,
                                                                std::size_t j) noexcept {
  if constexpr (Axes == 2) {
    const Coefficients k = coefficients_;
    // Along a row by axis, and down the rows.
    const Block a{k.a[0], k.a[1], k.a[0], k.a[1]}, a_down{k.a[0], k.a[0], k.a[1], k.a[1]};
    const Block e{k.e[0], k.e[1], k.e[0], k.e[1]}, e_down{k.e[0], k.e[0], k.e[1], k.e[1]};
    const Block c{k.c[0], k.c[1], k.c[0], k.c[1]}, c_down{k.c[0], k.c[0], k.c[1], k.c[1]};
    const Block b_p{k.b_p[0], k.b_p[1], k.b_p[0], k.b_p[1]}, b_p_down{k.b_p[0], k.b_p[0], k.b_p[1], k.b_p[1]};
    const Block b_v{k.b_v[0], k.b_v[1], k.b_v[0], k.b_v[1]}, b_v_down{k.b_v[0], k.b_v[0], k.b_v[1], k.b_v[1]};
    const Pair row_a = Load(k.a), row_e = Load(k.e), row_b_p = Load(k.b_p), row_b_v = Load(k.b_v);
    const double effort_0 = problem.effort[0], effort_1 = problem.effort[1];
    const Value& next = value_[j + 1];
    Block pp, pv, vv;
    Load(next.pp, pp);
    Load(next.pv, pv);
    Load(next.vv, vv);
    Pair h_p = Load(next.p), h_v = Load(next.v);
    for (;; --j) {
      Block weight;
      Load(problem.stage[j].weight, weight);
      const Block vp = CONTOUR_TRANSPOSED(pv);

      if (j + 1 < problem.horizon) {
        const AxisVector<2>& d_p = problem.stage[j + 1].position_defect;
        const AxisVector<2>& d_v = problem.stage[j + 1].velocity_defect;
        h_p += Pair{pp[0], pp[1]} * Both(d_p[0]) + Pair{pp[2], pp[3]} * Both(d_p[1]) +
               Pair{vp[0], vp[1]} * Both(d_v[0]) + Pair{vp[2], vp[3]} * Both(d_v[1]);
        h_v += Pair{pv[0], pv[1]} * Both(d_p[0]) + Pair{pv[2], pv[3]} * Both(d_p[1]) +
               Pair{vv[0], vv[1]} * Both(d_v[0]) + Pair{vv[2], vv[3]} * Both(d_v[1]);
      }

      const Block w_p = pp * b_p + pv * b_v;
      const Block w_v = vp * b_p + vv * b_v;
      const Block uu = b_p_down * w_p + b_v_down * w_v + c_down * weight * c;
      const Block base_v = a * pp + e * pv;
      const Block w_p_t = CONTOUR_TRANSPOSED(w_p), w_v_t = CONTOUR_TRANSPOSED(w_v);
      const Block up = w_p_t + c_down * weight;
      const Block uv = a * w_p_t + e * w_v_t;
      const Pair u = row_b_p * h_p + row_b_v * h_v;

      const double u00 = uu[0] + effort_0;
      const double u11 = uu[3] + effort_1;
      const double u01 = uu[1];
      const double scale = -1.0 / (u00 * u11 - u01 * u01);
      const double i00 = scale * u11, i01 = -scale * u01, i11 = scale * u00;
      const Pair k_0 = Pair{i00, i01} * Both(u[0]) + Pair{i01, i11} * Both(u[1]);
      const Block by_first{i00, i00, i01, i01}, by_second{i01, i01, i11, i11};
      const Block k_p = by_first * CONTOUR_FIRST_ROWS(up) + by_second * CONTOUR_SECOND_ROWS(up);
      const Block k_v = by_first * CONTOUR_FIRST_ROWS(uv) + by_second * CONTOUR_SECOND_ROWS(uv);

      const Block up_0 = CONTOUR_FIRST_ROW_DOWN(up), up_1 = CONTOUR_SECOND_ROW_DOWN(up);
      const Block k_v_0 = CONTOUR_FIRST_ROWS(k_v), k_v_1 = CONTOUR_SECOND_ROWS(k_v);
      const Block new_pp = pp + weight + up_0 * CONTOUR_FIRST_ROWS(k_p) + up_1 * CONTOUR_SECOND_ROWS(k_p);
      const Block new_pv = base_v + up_0 * k_v_0 + up_1 * k_v_1;
      const Block new_vv = a_down * base_v + e_down * (a * vp + e * vv) + CONTOUR_FIRST_ROW_DOWN(uv) * k_v_0 +
                           CONTOUR_SECOND_ROW_DOWN(uv) * k_v_1;

      pp = CONTOUR_SYMMETRIC(new_pp);
      pv = new_pv;
      vv = CONTOUR_SYMMETRIC(new_vv);
      const Pair at_p = h_p, at_v = h_v;
      h_p = at_p + Pair{up[0], up[1]} * Both(k_0[0]) + Pair{up[2], up[3]} * Both(k_0[1]);
      h_v =
          row_a * at_p + row_e * at_v + Pair{uv[0], uv[1]} * Both(k_0[0]) + Pair{uv[2], uv[3]} * Both(k_0[1]);

      Value& value = value_[j];
      Store(pp, value.pp);
      Store(pv, value.pv);
      Store(vv, value.vv);
      Store(h_p, value.p);
      Store(h_v, value.v);
      Policy& policy = policy_[j];
      Store(k_p, policy.on_position);
      Store(k_v, policy.on_velocity);
      Store(k_0, policy.offset);
      policy.curvature = {u00, u11};
      policy.all_free = true;
      has_ties_[j] = false;
      if (j == 0 || !FreePair(holding[j - 1])) return j;
    }
  } else {
    static_cast<void>(problem);
    static_cast<void>(holding);
    return j;
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

// As RollOut from stage j on, while all is free; returns the last such stage, and the state after it in `s`.
template <std::size_t Axes>
std::size_t Riccati<Axes>::RollOutFreePairs(const Problem& problem, std::size_t j, DriftState<Axes>& s,
                                            Inputs& input, Inputs& gradient) const noexcept {
  if constexpr (Axes == 2) {
    const AxisDynamics &x = problem.dynamics[0], &y = problem.dynamics[1];
    const Pair position_from_command{x.position_from_command, y.position_from_command};
    const Pair velocity_from_command{x.velocity_from_command, y.velocity_from_command};
    const Pair position_from_velocity{x.position_from_velocity, y.position_from_velocity};
    const Pair position_from_previous{x.position_from_previous, y.position_from_previous};
    const Pair velocity_from_previous{x.velocity_from_previous, y.velocity_from_previous};
    const Pair velocity_kept{x.velocity_kept, y.velocity_kept};
    Pair p = Load(s.position), v = Load(s.velocity);
    for (;; ++j) {
      const Policy& policy = policy_[j];
      const auto& [p_0, p_1] = policy.on_position;
      const auto& [v_0, v_1] = policy.on_velocity;
      const Pair u = Load(policy.offset) +
                     (Pair{p_0[0], p_1[0]} * Both(p[0]) + Pair{v_0[0], v_1[0]} * Both(v[0])) +
                     (Pair{p_0[1], p_1[1]} * Both(p[1]) + Pair{v_0[1], v_1[1]} * Both(v[1]));
      Store(u, input[j]);
      gradient[j] = {};
      const bool last = j + 1 >= problem.horizon;
      const Pair error = p + position_from_command * u;
      const Pair velocity = v + velocity_from_command * u;
      p = error + position_from_velocity * velocity + position_from_previous * u;
      v = velocity_kept * velocity + velocity_from_previous * u;
      if (!last) {
        p += Load(problem.stage[j + 1].position_defect);
        v += Load(problem.stage[j + 1].velocity_defect);
      }
      if (last || !policy_[j + 1].all_free) break;
    }
    Store(p, s.position);
    Store(v, s.velocity);
  } else {
    static_cast<void>(problem);
    static_cast<void>(s);
    static_cast<void>(input);
    static_cast<void>(gradient);
  }
  return j;
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
