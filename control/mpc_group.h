#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "control/control_law.h"
#include "control/flat_feedforward.h"
#include "control/path_weights.h"
#include "control/qp_solver.h"
#include "control/standstill.h"
#include "core/nonblocking.h"

namespace contour {

/// The axes of a machine that share one MPC problem; see MpcLaw.
class MpcGroupBase {
 public:
  virtual ~MpcGroupBase() = default;
  virtual void Reset() noexcept CONTOUR_NONBLOCKING = 0;
  virtual void Soften(bool softer) noexcept CONTOUR_NONBLOCKING = 0;
  virtual void Step(const ControlInput& input, ControlOutput& output) noexcept CONTOUR_NONBLOCKING = 0;
  virtual void Keep(StateKeeper& keep) noexcept CONTOUR_NONBLOCKING = 0;
};

/// MPC of 1 to 3 axes in the frame of their common path. Deviations from the flat feed-forward are predicted
/// over the horizon; the error across the path and along it are weighed apart.
template <std::size_t Axes>
class MpcGroup final : public MpcGroupBase {
 public:
  /// The group is axes[first] .. axes[first + Axes - 1].
  MpcGroup(const MpcConfig& config, const ControllerOptions& options, const PerAxis<ControlledAxis>& axes,
           std::size_t first, double period_s);
  void Reset() noexcept override;
  void Soften(bool softer) noexcept override { softer_ = softer; }
  void Step(const ControlInput& input, ControlOutput& output) noexcept override;
  void Keep(StateKeeper& keep) noexcept override {
    keep(plan_, planned_m_s2_, has_planned_, active_, solution_, softer_, standstill_);
  }

 private:
  void BuildAxis(const ControlInput& input, std::size_t i) noexcept;
  void ShiftWarmStart() noexcept;
  void Report(const QpReport& report, ControlOutput& output) noexcept;
  void HoldAtRest(const ControlInput& input, bool begins, ControlOutput& output) noexcept;

  MpcConfig config_;
  std::size_t first_;
  double period_s_;
  AxisVector<Axes> mass_kg_{};
  AxisVector<Axes> bound_m_s2_{};
  AxisVector<Axes> step_m_s2_{};
  std::vector<PathWeights<Axes>> weights_;  // its own and the softer ones, made once the dynamics are known
  std::vector<FlatFeedforward> feedforward_;
  std::array<AxisPlan, Axes> plan_{};
  std::array<Standstill, Axes> standstill_;
  AxisVector<Axes> planned_m_s2_{};  // feed-forward command of the last Step
  bool has_planned_ = false;
  bool softer_ = false;
  QpProblem<Axes> problem_;
  QpSolver<Axes> solver_;
  typename QpSolver<Axes>::Active active_{};
  typename QpSolver<Axes>::Inputs solution_{};
};

}  // namespace contour
