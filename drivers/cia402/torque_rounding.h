#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "drivers/cia402/scaling.h"

namespace contour {

/// A drive takes its torque in whole per mille of its rated torque. What rounding leaves over in one cycle is
/// made up for in the next, so that the torque is right on average and a demand below one step is not lost:
/// rounded plainly, an axis without friction strays until its controller asks for half a step.
///
/// At rest torque is rounded plainly. There it need not be right, it must be still: friction holds, and a
/// step that comes and goes would only shake the axis.
class TorqueRounding {
 public:
  /// `carry`: the axis moves. Whole per mille, none beyond the limit rounded; 0 for NaN.
  [[nodiscard]] std::int16_t Round(const TorqueScale& scale, double torque_Nm, double limit_Nm,
                                   bool carry) noexcept {
    if (!carry || !std::isfinite(torque_Nm)) left_over_Nm_ = 0.0;
    const double owed_Nm = torque_Nm + left_over_Nm_;
    const std::int16_t most = scale.ToPerMille(limit_Nm);
    const auto least = static_cast<std::int16_t>(-most);
    const std::int16_t per_mille = std::clamp(scale.ToPerMille(owed_Nm), least, most);
    if (carry && std::isfinite(torque_Nm)) {
      const double half_Nm = 0.5 * scale.FromPerMille(1);
      left_over_Nm_ = std::clamp(owed_Nm - scale.FromPerMille(per_mille), -half_Nm, half_Nm);
    }
    return per_mille;
  }
  void Reset() noexcept { left_over_Nm_ = 0.0; }

 private:
  double left_over_Nm_ = 0.0;
};

}  // namespace contour
