#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/axis_model/stated_axis.h"
#include "analysis/prediction_error/signals.h"
#include "analysis/recording/axis_log.h"

namespace contour::diagnosis {

/// What an axis does and what moves it, of every row, all smoothed alike, stretch by stretch.
struct SmoothedMotion {
  Signal position;                         ///< q, not smoothed
  Signal velocity, acceleration, command;  ///< of q; the command as it acts in the middle of the row
  std::vector<std::uint8_t> counts;        ///< 0 where a gap or an end is near
  double max_speed = 0.0;                  ///< of q, where it counts
  double independent_rows = 1.0;           ///< from one independent row to the next

  [[nodiscard]] std::size_t size() const { return counts.size(); }
  /// For certain: not where friction has to be broken.
  [[nodiscard]] bool Slides(std::size_t k) const;
};

/// `falling`: friction whose break-away part is taken out of the command; null: nothing is.
SmoothedMotion SmoothMotion(const AxisLog& log, const StatedAxis& stated, const StatedFriction* falling);

/// What sliding friction has beyond the Coulomb level at this velocity, with the Stribeck velocity `vs`; 0:
/// none.
double BeyondCoulomb(const StatedFriction& f, double vs, double velocity);

/// A force, smoothed as the motion is; gaps are not seen.
Signal SmoothAsMotion(const Signal& force, double period_s);

}  // namespace contour::diagnosis
