#include "control/path_weights.h"

#include <cmath>
#include <numbers>

#include "control/control_law.h"

namespace contour {
namespace {

double WeightOf(double bandwidth_Hz) {
  const double omega = 2.0 * std::numbers::pi * bandwidth_Hz;
  return omega * omega * omega * omega;
}

}  // namespace

template <std::size_t Axes>
PathWeights<Axes>::PathWeights(double contour_bandwidth_Hz, double lag_bandwidth_Hz, double rest_velocity_m_s,
                               const std::array<AxisDynamics, Axes>& dynamics)
    : contour_weight_(WeightOf(contour_bandwidth_Hz)),
      lag_weight_(WeightOf(lag_bandwidth_Hz)),
      rest_velocity_m_s_(rest_velocity_m_s) {
  for (std::size_t i = 0; i < Axes; ++i) {
    contour_terminal_[i] = LqrTerminal(dynamics[i], contour_weight_, 1.0);
    lag_terminal_[i] = LqrTerminal(dynamics[i], lag_weight_, 1.0);
  }
}

template <std::size_t Axes>
CONTOUR_WIDE_VECTORS void PathWeights<Axes>::Normalise(std::size_t count,
                                                       Tangents& velocity_m_s) const noexcept {
  const double rest2 = rest_velocity_m_s_ * rest_velocity_m_s_;
  for (std::size_t j = 0; j < count; ++j) {
    double square = rest2;
    for (std::size_t i = 0; i < Axes; ++i) square += velocity_m_s[i][j] * velocity_m_s[i][j];
    const double inverse = 1.0 / std::sqrt(square);
    for (std::size_t i = 0; i < Axes; ++i) velocity_m_s[i][j] *= inverse;
  }
}

template <std::size_t Axes>
void PathWeights<Axes>::Fill(const PerAxis<AxisHorizon>& reference, std::size_t first,
                             QpProblem<Axes>& problem) const noexcept {
  const std::size_t horizon = problem.horizon;
  Tangents tangent;
  for (std::size_t i = 0; i < Axes; ++i)
    for (std::size_t j = 0; j < horizon; ++j)
      tangent[i][j] = PointAt(reference[first + i], j + 2).velocity_m_s;
  Normalise(horizon, tangent);
  const double more = lag_weight_ - contour_weight_;
  for (std::size_t j = 0; j < horizon; ++j) {
    for (std::size_t i = 0; i < Axes; ++i) {
      for (std::size_t k = 0; k < Axes; ++k) {
        problem.stage[j].weight[i][k] =
            (i == k ? contour_weight_ : 0.0) + more * tangent[i][j] * tangent[k][j];
      }
    }
  }
  AxisVector<Axes> last{};
  for (std::size_t i = 0; i < Axes && horizon > 0; ++i) last[i] = tangent[i][horizon - 1];
  FillTerminal(last, problem);
}

// Cost-to-go of the rotated weights: exact when all axes have the same dynamics, positive semidefinite
// always.
template <std::size_t Axes>
void PathWeights<Axes>::FillTerminal(const AxisVector<Axes>& tangent,
                                     QpProblem<Axes>& problem) const noexcept {
  auto& terminal = problem.terminal;
  for (std::size_t i = 0; i < Axes; ++i) {
    for (std::size_t k = 0; k < Axes; ++k) {
      const TerminalFactor &ci = contour_terminal_[i], &ck = contour_terminal_[k];
      const TerminalFactor &li = lag_terminal_[i], &lk = lag_terminal_[k];
      const double along = tangent[i] * tangent[k];
      const double across = (i == k ? 1.0 : 0.0) - along;
      terminal[i][k] = across * ci.pp * ck.pp + along * li.pp * lk.pp;
      terminal[i][Axes + k] = across * ci.pp * ck.vp + along * li.pp * lk.vp;
      terminal[Axes + i][k] = across * ci.vp * ck.pp + along * li.vp * lk.pp;
      terminal[Axes + i][Axes + k] =
          across * (ci.vp * ck.vp + ci.vv * ck.vv) + along * (li.vp * lk.vp + li.vv * lk.vv);
    }
  }
}

template class PathWeights<1>;
template class PathWeights<2>;
template class PathWeights<3>;

}  // namespace contour
