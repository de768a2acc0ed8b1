#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "control/contour_controller.h"
#include "control/control_config.h"
#include "core/horizon.h"
#include "core/nonblocking.h"
#include "core/state_keeper.h"

namespace contour {

/// The axes of a machine that are planned together; as the MPC groups them.
class PlannerGroupBase {
 public:
  virtual ~PlannerGroupBase() = default;
  virtual void Reset() noexcept CONTOUR_NONBLOCKING = 0;
  /// Whether something else than what is wanted must be followed.
  [[nodiscard]] virtual bool Decide(const PerAxis<AxisHorizon>& wanted) noexcept CONTOUR_NONBLOCKING = 0;
  /// Then once: what is followed, into `planned` unless that is null.
  virtual void Write(const PerAxis<AxisHorizon>& wanted,
                     PerAxis<AxisHorizon>* planned) noexcept CONTOUR_NONBLOCKING = 0;
  virtual void Keep(StateKeeper& keep) noexcept CONTOUR_NONBLOCKING = 0;
};

/// Turns a reference that asks for more acceleration than the torque allows, as corners at full feed do, into
/// motion that stays near its path: the same receding-horizon problem as the controller's, but solved for the
/// motion itself, free of noise and friction, with the error across the path weighed far more than the delay
/// along it.
class ReferencePlanner {
 public:
  ReferencePlanner(const PlannerConfig& config, const PerAxis<ControlledAxis>& axes, double period_s);
  /// The next plan begins at its reference.
  void Reset() noexcept;
  /// Successive calls are one period apart: element 1 of a horizon becomes element 0 of the next. A reference
  /// that does not continue the last one begins anew. Nothing is planned where all that is wanted is
  /// possible.
  void Plan(const PerAxis<AxisHorizon>& wanted, PerAxis<AxisHorizon>& planned) noexcept;
  [[nodiscard]] int horizon_points() const noexcept { return horizon_points_; }
  void Keep(StateKeeper& keep) noexcept { keep(groups_); }

 private:
  std::vector<std::unique_ptr<PlannerGroupBase>> groups_;
  int horizon_points_;
};

}  // namespace contour
