#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/axis_model/axis_model.h"
#include "analysis/prediction_error/forward_filter.h"
#include "analysis/recording/axis_log.h"

namespace contour::diagnosis {

/// What the rows of steady sliding are told from.
struct SlidesOf {
  const AxisLog& log;
  std::span<const std::uint8_t> valid;
  std::span<const std::size_t> begins;  ///< rows at which motion begins anew
  const AxisModel& nominal;
  double softest = 1.0;  ///< by what factor a bristle may come out softer than stated
};

/// Rows over which the body that friction acts on slides steadily, whatever the numbers come out as within
/// what is stated: the bristle is at its end, and the speed hardly changes over a row. Rows next to readings
/// that are not valid are none. `strict`: 1 and more; the larger, the further behind a turn, the faster and
/// the more even the motion of such a row.
std::vector<std::uint8_t> SteadySlides(const SlidesOf& of, double strict);

/// As many of them as this log allows: with friction held there, parts from all over the log come out as
/// they do without, to a tenth of what the sub-steps are off by themselves. None where no strictness does.
std::vector<std::uint8_t> HeldSlides(const FilterSetup& setup, const SlidesOf& of);

}  // namespace contour::diagnosis
