#pragma once

#include <string>
#include <vector>

#include "analysis/prediction_error/problem.h"

namespace contour::diagnosis {

/// Kinds outside the catalogue, tried so that what they explain does not get a wrong name.
inline constexpr const char* kOutside = "outside:";
inline constexpr const char* kFrictionOfTime = "outside:friction of time";

/// A signal scaled by an amplitude, into one of the model's inputs.
enum class Input { kMotorForce, kLoadForce, kLevel, kViscous, kReading, kScale };
SharedEffect LinearEffect(std::string kind, std::string label, double grid, Input input,
                          std::vector<SharedSignal> basis, double step);

/// Every cause of the catalogue that needs no search over orders or frequencies, on its grid.
std::vector<SharedEffect> CatalogueEffects(const Problem& problem);

/// A wave of the motor's angle or of time, as found by the scans.
enum class Wave { kFrictionOfAngle, kTorqueOfAngle, kReadingOfAngle, kForceOfTime, kGainOfAngle };
SharedEffect WaveEffect(const Problem& problem, Wave wave, double order, double grid);

}  // namespace contour::diagnosis
