#pragma once

#include <array>
#include <cmath>
#include <string_view>

#include "analysis/diagnosis/tuning/decision_tuning.h"

namespace contour::diagnosis {

/// In addition to the kinds of cause: that something is left which none of them fits.
inline constexpr std::string_view kUnexplainedAll = "unexplained";
inline constexpr std::string_view kUnexplainedTorque = "unexplained:torque of time";
inline constexpr std::string_view kUnexplainedFriction = "unexplained:friction of time";
inline constexpr std::array kStructureClasses = {kUnexplainedAll, kUnexplainedTorque, kUnexplainedFriction};

/// What the model's own errors may add to a score by chance before all kinds together alarm more often than
/// asked; per row. They look like effects, the more the longer the log; exponentially distributed.
inline double AllowancePerRow(double false_alarm_rate) {
  return kThreshold.model_error_per_row * -std::log(false_alarm_rate);
}

}  // namespace contour::diagnosis
