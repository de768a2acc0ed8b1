#pragma once

#include <optional>
#include <string>

#include "analysis/axis_model/stated_axis.h"
#include "analysis/rough_fit/rough_fit.h"

namespace contour::diagnosis {

/// What a model lacks that says another difference of the two directions than the log has: a constant force,
/// or levels of friction of their own. Rows that slide know both from the model, and not from each other.
struct UnlikeDirections {
  StatedAxis pulled;                 ///< with the constant force of least squares, free to move
  std::optional<StatedAxis> uneven;  ///< with the levels of least squares; none where one would push the axis
  double forth = 0.0, back = 0.0;    ///< what the axis resists by
  double by_rel = 0.0;               ///< half of the difference beyond what is stated, of the level
};

/// Nothing where the directions are as stated, or the log has one of them alone.
std::optional<UnlikeDirections> FindUnlikeDirections(const RoughFit& rough, const StatedAxis& stated);

}  // namespace contour::diagnosis
