#pragma once

#include <array>
#include <string_view>

#include "analysis/diagnosis/tuning/decision_tuning.h"

namespace contour::diagnosis {

/// The rate at which model-error allowances were read off clean logs.
inline constexpr double kCalibratedRate = kThreshold.calibrated_rate;

/// In addition to the kinds of cause: that something is left which none of them fits. Over the time the
/// model's own errors show, motion by motion, and nowhere else; each has an allowance of its own.
inline constexpr std::string_view kUnexplainedAll = "unexplained";
inline constexpr std::string_view kUnexplainedTorque = "unexplained:torque of time";
inline constexpr std::string_view kUnexplainedFriction = "unexplained:friction of time";
inline constexpr std::array kStructureClasses = {kUnexplainedAll, kUnexplainedTorque, kUnexplainedFriction};

constexpr bool IsStructureClass(std::string_view kind) { return kind.starts_with(kUnexplainedAll); }

/// How a kind's scores exceed the sign flips on machines without any effect: in a share of the logs, by
/// `scale` per 100 000 rows on the average there, exponentially distributed.
struct ErrorScore {
  std::string_view kind;
  double share = 0.0, scale = 0.0;
  /// Of a score, once a cause of this kind is accepted: what is left of it may look like others by so much,
  /// and like another one of its kind by so much more.
  double leakage = 0.0, leakage_of_its_kind = 0.0;
};

/// What the model's own errors may add to a score above the threshold of kCalibratedRate before all kinds
/// together alarm more often than asked; per row. They look like effects, the more the longer the log.
double AllowancePerRow(std::string_view kind, double false_alarm_rate);

double LeakageShare(std::string_view kind);
double LeakageShareOfItsKind(std::string_view kind);

}  // namespace contour::diagnosis
