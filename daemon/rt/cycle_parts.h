#pragma once

#include <memory>

#include "control/contour_controller.h"
#include "control/monitored_axis.h"
#include "control/torque_guard.h"
#include "daemon/rt/cycle_config.h"
#include "daemon/rt/transitions.h"
#include "estimator/axis_estimator.h"

// What the parts of a cycle are made of, from its configuration. Before the first Step only: all of it may
// take memory.
namespace contour {

/// Whether the drives close the position loop.
[[nodiscard]] bool InCascade(const CycleConfig& config) noexcept;

/// `full` with friction learnt along the reference.
[[nodiscard]] bool KnowsTwoInertias(const CycleConfig& config) noexcept;

[[nodiscard]] EstimatorKind EstimatorFor(const CycleConfig& config) noexcept;
/// The estimator of one axis. Throws std::invalid_argument.
[[nodiscard]] AxisEstimator MakeEstimator(const CycleConfig& config, std::size_t axis);
/// The observer that an axis falls back to.
[[nodiscard]] AxisEstimator MakeObserver(const CycleConfig& config, std::size_t axis);

/// The position loop as designed, and one that holds a rigid axis as stiffly; of the slowest axis.
[[nodiscard]] double DesignedLoop_Hz(const CycleConfig& config) noexcept;
[[nodiscard]] double StiffnessLoop_Hz(const CycleConfig& config) noexcept;

[[nodiscard]] PerAxis<GuardedAxis> GuardedAxes(const CycleConfig& config);

/// The axes as the motion monitor knows them.
[[nodiscard]] PerAxis<MonitoredAxis> MonitoredAxes(const CycleConfig& config);

/// The controller of such a cycle; takes all memory there will be. Throws std::invalid_argument.
[[nodiscard]] ContourController MakeController(const CycleConfig& config);

/// What is fallen back to when the controller of such a cycle fails: MPC with a disturbance observer, which
/// learns nothing. None where the controller has nothing more to give up, or the drives close the loop.
[[nodiscard]] std::unique_ptr<ContourController> MakeFallback(const CycleConfig& config);

/// Length of a stop on the path: an axis at its highest speed keeps its limits of acceleration and jerk.
[[nodiscard]] double StopOnPathTime_s(const CycleConfig& config);

[[nodiscard]] Transitions::Config TransitionTimes(const CycleConfig& config);

}  // namespace contour
