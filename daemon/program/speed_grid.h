#pragma once

#include <limits>
#include <vector>

#include "daemon/program/stretch.h"

namespace contour {

/// The map for a way from rest at `from_m`, to rest at the stretch's end: it starts and ends over what a jerk
/// phase takes. The path has to be known at `from_m`.
RestMap RestMapFor(const Stretch& stretch, double from_m);

/// Parameters at which the speed along a path is decided: all places where the path's third derivative or the
/// feed jumps, and as many between them as changes of speed at the axes' limits need. Sparse where the feed
/// is kept. They are found piece by piece, each as soon as what lies behind it cannot slow it down any more.
class SpeedGrid {
 public:
  SpeedGrid(double from_u, double feed_scale) : begin_{from_u}, feed_scale_(feed_scale) {}

  /// Appends the next nodes, behind the one that it began with or has got to; those of no place that lies
  /// behind `until_u`. Makes more of the path known where needed.
  void Extend(Stretch& stretch, const RestMap& map, double until_u, std::vector<double>& nodes);
  [[nodiscard]] bool complete() const { return complete_; }
  /// The last node so far.
  [[nodiscard]] double at_u() const { return begin_.at_u; }

  /// Where it goes on, and how the motion is guessed to be there.
  struct Begin {
    double at_u = 0.0;
    double speed = std::numeric_limits<double>::infinity();
    double since_s = 0.0;
  };

 private:
  Begin begin_;
  double feed_scale_;
  bool complete_ = false;
};

/// Time between nodes where the speed changes at the axes' limits.
double StepTime_s(const Stretch& stretch, double way_m, double speed_m_s);

}  // namespace contour
