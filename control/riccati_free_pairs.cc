// The passes of riccati.cc while two axes are free in every stage, which they mostly are, on whole blocks.
#include "control/riccati.h"

#include "core/wide_numbers.h"
#include "core/wide_vectors.h"

namespace contour {
namespace {

using wide::Load;
using wide::Pair;
using wide::Store;
/// The rows of a 2 x 2 block.
using Block = wide::Quad;

inline Pair Load(const std::array<double, 2>& from) noexcept { return Load(from.data()); }
inline void Store(Pair pair, std::array<double, 2>& to) noexcept { Store(to.data(), pair); }
inline Pair Both(double x) noexcept { return Pair{x, x}; }

using SquareOfTwo = std::array<std::array<double, 2>, 2>;
[[gnu::always_inline]] inline void Load(const SquareOfTwo& from, Block& block) noexcept {
  Load(reinterpret_cast<const double*>(&from), block);
}
[[gnu::always_inline]] inline void Store(const Block& block, SquareOfTwo& to) noexcept {
  Store(reinterpret_cast<double*>(&to), block);
}

}  // namespace

// The same arithmetic as BuildForm and ChooseAll, which say what it means, on whole blocks. Of a block b with
// rows r and s: its transpose, (r|r) and (s|s), and every element of r or of s as a row.
#define CONTOUR_TRANSPOSED(b) __builtin_shufflevector(b, b, 0, 2, 1, 3)
#define CONTOUR_FIRST_ROWS(b) __builtin_shufflevector(b, b, 0, 1, 0, 1)
#define CONTOUR_SECOND_ROWS(b) __builtin_shufflevector(b, b, 2, 3, 2, 3)
#define CONTOUR_FIRST_ROW_DOWN(b) __builtin_shufflevector(b, b, 0, 0, 1, 1)
#define CONTOUR_SECOND_ROW_DOWN(b) __builtin_shufflevector(b, b, 2, 2, 3, 3)
#define CONTOUR_SYMMETRIC(b) __builtin_shufflevector(b, b, 0, 1, 1, 3)

template <std::size_t Axes>
CONTOUR_WIDE_VECTORS std::size_t Riccati<Axes>::FactorBlocks(const Problem& problem, const Holding& holding,
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

template <std::size_t Axes>
std::size_t Riccati<Axes>::FactorFreePairs(const Problem& problem, const Holding& holding,
                                           std::size_t j) noexcept {
  return FactorBlocks(problem, holding, j);
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

template std::size_t Riccati<1>::FactorFreePairs(const Problem&, const Holding&, std::size_t) noexcept;
template std::size_t Riccati<1>::RollOutFreePairs(const Problem&, std::size_t, DriftState<1>&, Inputs&,
                                                  Inputs&) const noexcept;
template std::size_t Riccati<2>::FactorFreePairs(const Problem&, const Holding&, std::size_t) noexcept;
template std::size_t Riccati<2>::RollOutFreePairs(const Problem&, std::size_t, DriftState<2>&, Inputs&,
                                                  Inputs&) const noexcept;
template std::size_t Riccati<3>::FactorFreePairs(const Problem&, const Holding&, std::size_t) noexcept;
template std::size_t Riccati<3>::RollOutFreePairs(const Problem&, std::size_t, DriftState<3>&, Inputs&,
                                                  Inputs&) const noexcept;

}  // namespace contour
