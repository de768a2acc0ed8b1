#pragma once

#include <optional>
#include <vector>

#include "analysis/identification/simulation.h"

namespace contour::identify {

/// Response of the motor's position to the force at the motor.
struct ResponsePoint {
  double frequency_Hz = 0.0;
  double accelerance_1_kg = 0.0;  ///< |x| (2 pi f)^2 / |F|: 1 / mass where the axis is rigid
  double coherence = 0.0;
  double phase_rad = 0.0;  ///< of the acceleration against the force; negative where it comes later
};

/// Coherence from which a point of the response says something.
inline constexpr double kGoodCoherence = 0.7;

/// Of the sampling rate: below, friction and mass say everything.
inline constexpr double kLowestShown_share = 0.04;

/// From a twenty-fifth to nearly half of the sampling rate, of records that are shaken there throughout,
/// their run-ups apart; empty when they are shorter than some windows of half a second.
std::vector<ResponsePoint> MotorResponse(const std::vector<Measured>& records);

/// The deepest point of a response that no rigid axis has; none where it is flat.
std::optional<ResponsePoint> VisibleAntiresonance(const std::vector<ResponsePoint>& response);

}  // namespace contour::identify
