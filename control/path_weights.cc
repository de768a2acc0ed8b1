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
AxisVector<Axes> PathWeights<Axes>::Tangent(const PerAxis<AxisHorizon>& reference, std::size_t first,
                                            std::size_t node) const noexcept {
  AxisVector<Axes> tangent;
  double square = rest_velocity_m_s_ * rest_velocity_m_s_;
  for (std::size_t i = 0; i < Axes; ++i) {
    tangent[i] = PointAt(reference[first + i], node).velocity_m_s;
    square += tangent[i] * tangent[i];
  }
  const double inverse = 1.0 / std::sqrt(square);
  for (double& t : tangent) t *= inverse;
  return tangent;
}

template <std::size_t Axes>
void PathWeights<Axes>::Fill(const PerAxis<AxisHorizon>& reference, std::size_t first,
                             QpProblem<Axes>& problem) const noexcept {
  AxisVector<Axes> tangent{};
  for (std::size_t j = 0; j < problem.horizon; ++j) {
    tangent = Tangent(reference, first, j + 2);
    for (std::size_t i = 0; i < Axes; ++i) {
      for (std::size_t k = 0; k < Axes; ++k) {
        problem.stage[j].weight[i][k] =
            (i == k ? contour_weight_ : 0.0) + (lag_weight_ - contour_weight_) * tangent[i] * tangent[k];
      }
    }
  }
  FillTerminal(tangent, problem);
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
