#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "daemon/program/speed_grid.h"
#include "daemon/program/speed_optimiser.h"
#include "daemon/program/stretch.h"

namespace contour {

/// When a stretch is where: from rest at some place on it to rest at its end, as fast as feed and axes allow.
/// Planned in windows, no further than asked for; a window looks ahead far enough for what it settles to be
/// what a plan of the whole stretch would be. Its feed can be changed on the way.
class TimeLaw {
 public:
  TimeLaw(Stretch stretch, double from_m, double feed_scale);

  struct State {
    double way_m = 0.0;
    double speed_m_s = 0.0;
    double acceleration_m_s2 = 0.0;
  };
  /// Since the start, held at the end.
  State At(double time_s);
  /// Is the end later than this?
  bool GoesOnAfter(double time_s);
  /// Plans all of it.
  double duration_s();
  /// Until the end of what is planned.
  [[nodiscard]] double planned_s() const { return stops_ ? last_s_ + tail_s_ : time_s_.back(); }
  /// Where that is on the way.
  [[nodiscard]] double planned_way_m() const;
  /// When it is at a way, 0 and duration_s() beyond either end. The feed must never have been changed.
  double TimeAt_s(double way_m);

  /// As PathWalk::ChangeFeed. After a change to 0 the law ends where it rests, which is not the stretch's end
  /// but for chance.
  double ChangeFeed(double time_s, double scale);
  [[nodiscard]] bool stops_on_the_way() const { return stops_; }

  /// Times before this will not be asked for again.
  void ForgetBefore(double time_s);
  /// As far as it is known.
  [[nodiscard]] const Stretch& stretch() const { return stretch_; }
  /// Nodes that are kept.
  [[nodiscard]] std::size_t nodes() const { return speed_.u.size(); }

 private:
  void KnowAhead(std::size_t settled);
  void Append(const std::vector<double>& nodes);
  void LowerFloor(std::size_t node, double floor);
  void MakeGrid(std::size_t node);
  void PlanWindow();
  void Refine(std::size_t node);
  void PlanTo(double time_s);
  void Settle(std::size_t node);
  void EndBySlowing();
  bool EndWithin(std::size_t from, double slow_m_s, double jerk_m_s3);
  /// Is there more to plan before the stretch's end?
  [[nodiscard]] bool GoesOn() const { return !ahead_.complete() || time_s_.size() < speed_.u.size(); }
  [[nodiscard]] State AtNode(std::size_t node) const;
  [[nodiscard]] double TimeWithin(std::size_t i, double since_u) const;
  /// How far after node i it is at a time since then.
  [[nodiscard]] double SinceNode(std::size_t i, double since_s) const;
  /// The first node after a time, made there if need be.
  std::size_t NodeAfter(double time_s);

  Stretch stretch_;
  RestMap map_;
  SpeedGoal goal_;
  SpeedSpline speed_;
  SpeedGrid ahead_;
  double optimised_u_ = 0.0;  ///< the speed has been decided up to here, if not settled
  bool forgets_ = false;
  std::vector<double> grid_;    ///< nodes for a feed that was changed to; empty: it was not
  std::vector<double> time_s_;  ///< of the nodes that are settled
  std::size_t changed_ = 0;     ///< node from which the present feed counts
  bool stops_ = false;
  // Having slowed down enough, it comes to rest by a last ramp:
  State last_;
  double last_s_ = 0.0;
  double tail_s_ = 0.0;
  double tail_jerk_m_s3_ = 0.0;
};

}  // namespace contour
