#pragma once

#include <cstdint>
#include <memory>

#include "core/axis.h"

namespace contour {

/// Goes along a plan whose feed may change on the way: from rest at its start to rest at its end. Where it is
/// depends on the time since it began and on the changes made so far, and on nothing else, so that the same
/// calls give the same points. Velocity, acceleration and jerk of every axis stay within the plan's limits at
/// every instant, also while the feed changes, stops and comes back. Plans ahead when it is asked for a time;
/// not for the real-time thread, not for two threads at once.
///
///   auto walk = plan->Walk();               // null: a plan whose feed is fixed (YAML shapes)
///   walk->At(t, axes);                      // points, in any order
///   double from_s = walk->ChangeFeed(t, 0); // hold: points up to from_s stay what they were
///   double rest_s = walk->rests_from_s();   // when it will be at rest, on the path
///   walk->ChangeFeed(rest_s + pause_s, 1);  // resume: it stands until then
///
/// A change concerns everything after `time_s`: points handed out for later times are void and have to be
/// asked for again. So whoever keeps a queue changes the feed from the oldest point that can still be taken
/// back. A change that may have to be withdrawn is made on a Clone(), which gives the same points until then.
class PathWalk {
 public:
  /// Of the programmed feed: as far as feed overrides of machine tools go.
  static constexpr double kLargestScale = 2.0;

  virtual ~PathWalk() = default;

  /// Reference at a time since the start, held at the end, or where it rests.
  virtual void At(double time_s, PerAxis<ReferencePoint>& axes) = 0;

  /// Is the end of the program later than this? Never false while it rests on the way.
  [[nodiscard]] virtual bool GoesOnAfter(double time_s) = 0;

  /// Feed times `scale` (0 to kLargestScale) as soon after `time_s` as the axes' limits allow; 0: to rest on
  /// the path, as soon as they allow. Rapids are scaled down, but never up. Returns the time up to which
  /// nothing has changed, at most 3 ms after `time_s`. A new scale above 0 counts at once, also while it
  /// comes to rest.
  virtual double ChangeFeed(double time_s, double scale) = 0;

  /// From when on it rests on the way, by a ChangeFeed to 0; infinite: it does not.
  [[nodiscard]] virtual double rests_from_s() const = 0;

  /// Line of the program under way at a time; 0: none.
  [[nodiscard]] virtual int Line(double time_s) = 0;

  /// How many of the places at which the program waits have been reached at a time.
  [[nodiscard]] virtual std::uint32_t Halts(double time_s) = 0;

  /// When the plan, at the programmed feed, is where this is at a time; the same time before the first
  /// change.
  [[nodiscard]] virtual double ProgramTime_s(double time_s) = 0;

  /// Of the whole program at the feed as it is. Plans all of it; infinite while it rests on the way.
  [[nodiscard]] virtual double duration_s() = 0;

  /// The same of the plan at the programmed feed: an estimate from feeds and lengths, which gets better with
  /// what is planned.
  struct Estimate {
    double duration_s = 0.0;
    bool exact = false;
  };
  [[nodiscard]] virtual Estimate ProgramDuration() = 0;

  /// How long the rest of what is planned takes from a time on, as a share of what it takes at the programmed
  /// feed: where the axes' limits bind, twice the feed is less than twice as fast. 1 where that is not known.
  [[nodiscard]] virtual double TimeShare(double time_s) = 0;

  /// Times before this need no planning when they are asked for; infinite: none do.
  [[nodiscard]] virtual double planned_s() = 0;
  /// Plans one step further: some hundred nodes of speed, some tens of milliseconds of work.
  virtual void PlanStep() = 0;
  /// Times before this will not be asked for again: what they need is given up.
  virtual void ForgetBefore(double time_s) = 0;

  [[nodiscard]] virtual std::unique_ptr<PathWalk> Clone() const = 0;
};

}  // namespace contour
