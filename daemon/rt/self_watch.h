#pragma once

#include <cstdint>

#include "control/contour_controller.h"
#include "control/innovation_watch.h"
#include "control/oscillation_detector.h"
#include "control/supervision_ladder.h"
#include "core/axis.h"
#include "daemon/rt/cycle_config.h"
#include "daemon/rt/transitions.h"

namespace contour {

/// The cycle's eye on itself: loop, estimators, solver and the time at which it gets to run, and one ladder
/// for all of them. Watches only while torque is held.
class SelfWatch {
 public:
  SelfWatch() noexcept = default;
  explicit SelfWatch(const CycleConfig& config);

  struct Seen {
    const AxisFeedback& feedback;
    const AxisEstimate& estimate;
    const ReferencePoint& reference;  ///< of the feedback's instant
    double position_m = 0.0;
    double radius_m_rad = 0.0;
    bool capped = false;  ///< the solver reached its cap in the cycle before
  };
  void Reset() noexcept;
  /// Once per axis and cycle, then EndCycle.
  void Look(std::size_t axis, const Seen& seen) noexcept;
  /// `late`: the frames of the cycle before left late.
  void EndCycle(bool late) noexcept;

  [[nodiscard]] SupervisionStep step() const noexcept { return ladder_.step(); }
  [[nodiscard]] Softness softness() const noexcept;
  /// The ladder's last step: a stop on the path.
  [[nodiscard]] FaultSeen Stop() const noexcept;
  /// The loop itself is what fails, and gets worse: no path can be followed to its end.
  [[nodiscard]] FaultSeen Fault() const noexcept { return growing_; }
  /// What an axis shows of it.
  [[nodiscard]] Reason Limit(std::size_t axis) const noexcept;

 private:
  void Raise(Reason alarm, std::size_t axis, bool violent = false) noexcept;

  SupervisionLadder ladder_;
  PerAxis<OscillationDetector> oscillation_;
  PerAxis<InnovationWatch> innovation_;
  PerAxis<InARow> capped_;
  InARow late_;
  FaultSeen alarm_;
  FaultSeen growing_;
  bool violent_ = false;  ///< what alarm_ tells of
  bool friction_filter_ = false;
  bool in_cascade_ = false;
  bool clean_ = true;
};

/// From the axis's own numbers: counts, steps of torque, friction, its loop and its screw.
[[nodiscard]] OscillationBounds OscillationBoundsFor(const CycleConfig& config, std::size_t axis);

}  // namespace contour
