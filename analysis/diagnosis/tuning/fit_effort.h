#pragma once

#include <limits>

namespace contour::diagnosis {

/// How far a fit goes.
struct FitEffort {
  /// [steps] Where nothing else is said. Source: time. 2026-11-21
  int most_steps = 12;
  /// [renewals of the sensitivities] Where nothing else is said. Source: time. 2026-11-21
  int most_refreshes = 4;
  /// [chi^2] What one more step would promise at an end, where nothing else is said. Source: reasoning; moves
  /// no size by a third of its deviation. 2026-11-21
  double close_enough = 0.1;
  bool covariance = true;  ///< of the end point; else sensitivities may be old
  /// So much of what the cost has fallen below `from` is close enough, too.
  double share_enough = 0.0, from = 0.0;
  /// Given up where not even the first step's promise leads below.
  double hopeless_above = std::numeric_limits<double>::infinity();
};

/// Fits that go less far than FitEffort says.
struct EffortTuning {
  /// [steps and chi^2] From a place that is nearly right. Source: time. 2026-11-23
  FitEffort quick = {.most_steps = 3, .most_refreshes = 1, .close_enough = 1.0, .covariance = false};
  /// [steps and chi^2] From a grid point at full size, and once more from the stated numbers. Source: time.
  /// 2026-11-22
  FitEffort far = {.most_steps = 8, .most_refreshes = 2, .close_enough = 1.0, .covariance = false};
};

inline constexpr EffortTuning kEfforts;

/// A quick one with the sensitivities that it is given.
constexpr FitEffort WithTheirSensitivities() {
  FitEffort effort = kEfforts.quick;
  effort.most_refreshes = 0;
  return effort;
}

/// A quick one whose end is needed as exactly as any.
constexpr FitEffort QuickToTheEnd() {
  return {.most_steps = kEfforts.quick.most_steps, .most_refreshes = kEfforts.far.most_refreshes};
}

}  // namespace contour::diagnosis
