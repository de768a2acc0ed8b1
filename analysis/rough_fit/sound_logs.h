#pragma once

#include <span>
#include <string>

#include "analysis/axis_model/stated_axis.h"
#include "analysis/recording/axis_log.h"

namespace contour::diagnosis {

struct SoundLogs {
  /// Why nothing may be identified from them, with the numbers; empty: they may be used.
  std::string unusable;
  std::string note;  ///< what was left out; empty: nothing
};

/// Takes single wrong readings out of logs that are to be identified from, and looks whether each of them is
/// in the units and signs that the model states (WrongUnits).
SoundLogs MakeSound(std::span<AxisLog> logs, const StatedAxis& stated);

}  // namespace contour::diagnosis
