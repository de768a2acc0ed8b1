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

/// What a score must exceed for its kind to be named.
struct Gate {
  double flips = 0.0;     ///< as above
  double rate = 0.05;     ///< of false alarms
  double accepted = 0.0;  ///< score of what is accepted already; 0: nothing
};
double Threshold(const Problem& problem, const Gate& gate, const Effect& effect);
/// The same of a kind without a number in the base.
double Threshold(const Problem& problem, const Gate& gate);

}  // namespace contour::diagnosis
