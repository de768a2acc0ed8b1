#pragma once

#include <limits>
#include <optional>

#include "daemon/program/motion_plan.h"
#include "daemon/program/pace_law.h"
#include "daemon/program/path_walk.h"

namespace contour {

/// Finds how long a change of pace must take, so that no axis exceeds what it may: velocity, acceleration and
/// jerk of the points themselves, by their differences. Where a program exceeds a limit by itself, it is not
/// asked to exceed it less.
class PaceRamp {
 public:
  PaceRamp(PathWalk& walk, const PerAxis<PlanLimits>& limits, double period_s)
      : walk_(walk), limits_(limits), period_s_(period_s) {}

  /// The law with the shortest ramp to `rate` that begins at the point `begin`. Nothing: none is long enough,
  /// or it would end after `latest`, in periods of the program.
  [[nodiscard]] std::optional<PaceLaw> From(const PaceLaw& law, double begin, double rate,
                                            double latest = std::numeric_limits<double>::infinity()) const;
  /// The law that comes to rest when the program's time is `stop`, and is held there; that lies ahead of
  /// `begin`, where the rate must not change. Nothing: there is no room for it.
  [[nodiscard]] std::optional<PaceLaw> StopAt(const PaceLaw& law, double begin, double stop) const;
  /// Do the points from..to of the law keep the limits?
  [[nodiscard]] bool Fits(const PaceLaw& law, double from, double to) const;

 private:
  [[nodiscard]] bool AtRest(double time) const;
  [[nodiscard]] double Shortest(double time, double change_of_rate) const;
  [[nodiscard]] PerAxis<ReferencePoint> At(double time) const;
  [[nodiscard]] bool Own(std::size_t axis, double time, int order, double found) const;

  PathWalk& walk_;
  const PerAxis<PlanLimits>& limits_;
  double period_s_;
};

}  // namespace contour
