#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "core/axis.h"
#include "daemon/program/path_walk.h"
#include "daemon/program/program.h"

namespace contour {

/// Three years: a program that takes longer is refused.
inline constexpr double kLongestProgram_s = 1e8;

/// What one axis of the machine allows a program to do. SI units, table side.
struct PlanLimits {
  std::string axis;  ///< name in the machine file
  double position_min_m = 0.0;
  double position_max_m = 0.0;
  double velocity_m_s = 0.0;
  double acceleration_m_s2 = 0.0;
  double jerk_m_s3 = 0.0;  ///< 0: not limited
  // For experiments that put torque on the axis; 0: it takes none.
  double torque_Nm = 0.0;
  double following_error_m = 0.0;
  double radius_m_rad = 0.0;
  double mass_kg = 0.0;  ///< everything that moves, seen at the table
  /// How far the table may leave the path of a program that says nothing about it; the smallest of the axes'.
  double path_tolerance_m = 1e-5;
  /// How far the table may be from the path planned for it; the largest of the axes' counts.
  double path_following_m = 2e-6;
  /// How far the table is expected to be off for each m/s^2, by what is not known of mass and stiffness; 0:
  /// nothing is expected.
  double inertia_doubt_s2 = 0.0;
  /// And by what is not known of friction, whatever the acceleration.
  double friction_doubt_m = 0.0;
  double cycle_s = 0.0;  ///< a torque is set once in it; 0: not known
  /// The stiffest spring that the axis's loop can be; infinite: it has no such loop.
  double stiffest_spring_N_m = std::numeric_limits<double>::infinity();
};

/// The commanded circle of a circle program.
struct CommandedCircle {
  std::size_t axis[2] = {0, 1};  ///< indices of the plane's axes
  double centre_m[2] = {0, 0};
  double radius_m = 0.0;
  bool counter_clockwise = true;
  int turns = 0;
};

/// A program placed on a machine: where it is at every instant, and what it looks like as a curve.
/// Immutable and deterministic; safe to share between threads.
class MotionPlan {
 public:
  virtual ~MotionPlan() = default;

  [[nodiscard]] virtual std::size_t axis_count() const = 0;

  /// From the first to the last instant; the machine rests at both.
  [[nodiscard]] virtual double duration_s() const = 0;

  /// Reference at a time since the start, held at either end. Velocity and acceleration are the exact
  /// derivatives of position (from the right, at a corner taken at full feed).
  virtual void At(double time_s, PerAxis<ReferencePoint>& axes) const = 0;

  /// Line of the program's text that is carried out at a time since the start; 0 unknown.
  [[nodiscard]] virtual std::uint32_t Line(double /*time_s*/) const { return 0; }

  /// How many of the places at which the program waits (see HaltsOf) have been reached at a time since the
  /// start.
  [[nodiscard]] virtual std::uint32_t Halts(double /*time_s*/) const { return 0; }

  /// Shortest distance from a point (one coordinate per axis) to the whole curve.
  [[nodiscard]] virtual double Distance_m(const PerAxis<double>& point_m) const = 0;

  /// Turns that the reference has completed at a time since the start; 0 for shapes without turns.
  [[nodiscard]] virtual double Turns(double time_s) const = 0;

  /// Is this instant part of what is scored? Circles: the whole turns after the first; other shapes: from 1 s
  /// after the start to the end.
  [[nodiscard]] virtual bool Scored(double time_s) const = 0;

  [[nodiscard]] virtual std::optional<CommandedCircle> circle() const = 0;

  /// Nothing but standing still.
  [[nodiscard]] virtual bool is_hold() const = 0;

  /// Does this axis do anything?
  [[nodiscard]] virtual bool Moves(std::size_t axis) const = 0;

  /// Is the end later than this? Long programs are planned no further than needed to know.
  [[nodiscard]] virtual bool GoesOnAfter(double time_s) const { return time_s < duration_s(); }

  /// A way along it whose feed may be changed, which keeps the plan alive; null: its feed is fixed.
  [[nodiscard]] virtual std::unique_ptr<PathWalk> Walk() const { return nullptr; }
  [[nodiscard]] virtual bool feed_may_change() const { return false; }
};

/// Of all of it at its own feed; of G-code that is not planned yet, from its feeds and lengths.
[[nodiscard]] inline double EstimatedDuration_s(const MotionPlan& plan) {
  const auto walk = plan.Walk();
  return walk ? walk->ProgramDuration().duration_s : plan.duration_s();
}

/// Whether what takes so long at its own feed takes longer than programs may at this one (1 as programmed).
/// At feed 0 it rests.
[[nodiscard]] constexpr bool TakesYears(double program_s, double feed) {
  return feed > 0.0 && program_s > kLongestProgram_s * feed;
}

/// That `what` does, for people.
std::string YearsText(double feed_percent, const std::string& what);

/// Places a program where the machine stands and checks it against the limits: position range, velocity,
/// acceleration, run-up, torque. Throws ProgramError naming axis, value and limit.
std::shared_ptr<const MotionPlan> PlanMotion(const Program& program, const PerAxis<double>& start_m,
                                             const PerAxis<PlanLimits>& limits);

}  // namespace contour
