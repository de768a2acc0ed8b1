#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/diagnosis/score.h"

namespace contour::diagnosis {

/// The score that the best of all candidates exceeds by chance with the given probability: residual blocks
/// with random signs against the fixed columns, waves found by a scan as the largest of their grid; beyond
/// the 2 % quantile along a Gumbel fit.
double SignFlipGate(std::span<const Scored> scored, double false_alarm_rate, std::uint64_t seed);

}  // namespace contour::diagnosis
