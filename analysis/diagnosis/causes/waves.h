#pragma once

#include "analysis/diagnosis/causes/cause_definition.h"

// Causes that are waves of the motor's angle or of time.
namespace contour::diagnosis {

/// What is a wave, and of what; as the scans tell them apart.
enum class Wave { kFrictionOfAngle, kTorqueOfAngle, kReadingOfAngle, kForceOfTime, kGainOfAngle };

struct WaveSource {
  Required<Wave> wave;
  Required<bool (*)(double order)> has_order;  ///< which orders are the cause's
  /// Found to a part of a turn over the travel (of a cycle over the log), and fitted with the rest.
  Required<bool> free_order;
};

bool IsWholeOrder(double order);
bool AnyOrder(double order);

/// The effect of whichever cause has this wave at this order; per turn, or Hz.
SharedEffect WaveEffect(const Problem& problem, Wave wave, double order, double grid);

/// Of a fitted wave: amplitude times `scale`, order (where it has a name) and phase at zero.
NamedValues WaveParameters(const FittedEffect& fitted, const char* amplitude, const char* order,
                           double scale);

/// Whether an error of the reading, a wave of the angle, runs ahead and back by more than a share of the
/// angle itself: no encoder that works does.
bool ReadsWithMoreSlope(const Problem& problem, const Effect& effect, const std::vector<double>& a,
                        double most_slope);

}  // namespace contour::diagnosis
