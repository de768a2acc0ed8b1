#pragma once

#include <array>
#include <cstddef>

#include "control/lqr_terminal.h"
#include "control/qp_problem.h"
#include "core/axis.h"
#include "core/horizon.h"
#include "core/wide_vectors.h"

namespace contour {

/// Weights of a QpProblem in the frame of the path: error across it and along it weighed apart, and the
/// cost-to-go of either beyond the horizon. Stage j ends at element j + 2 of the reference.
template <std::size_t Axes>
class PathWeights {
 public:
  /// Bandwidths: with cost weight error^2 + (force / mass)^2 a free mass becomes a second-order loop of
  /// natural frequency weight^(1/4), so that they mean the same for every mass.
  PathWeights(double contour_bandwidth_Hz, double lag_bandwidth_Hz, double rest_velocity_m_s,
              const std::array<AxisDynamics, Axes>& dynamics);

  /// Weights and terminal weight of the group reference[first] .. reference[first + Axes - 1].
  void Fill(const PerAxis<AxisHorizon>& reference, std::size_t first,
            QpProblem<Axes>& problem) const noexcept;

 private:
  // Per axis, along the horizon.
  using Tangents = std::array<std::array<double, kMaxHorizon>, Axes>;
  // Velocities into the direction of the path, shrinking to zero at rest so that then all directions weigh
  // the same.
  CONTOUR_WIDE_VECTORS void Normalise(std::size_t count, Tangents& velocity_m_s) const noexcept;
  void FillTerminal(const AxisVector<Axes>& tangent, QpProblem<Axes>& problem) const noexcept;

  double contour_weight_;
  double lag_weight_;
  double rest_velocity_m_s_;
  std::array<TerminalFactor, Axes> contour_terminal_{};
  std::array<TerminalFactor, Axes> lag_terminal_{};
};

}  // namespace contour
