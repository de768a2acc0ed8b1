#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/diagnosis/score.h"

namespace contour::diagnosis {

/// What a score must exceed for its kind to be named.
struct Gate {
  double flips = 0.0;       ///< as SignFlips has it, at the asked rate
  double calibrated = 0.0;  ///< the same at the rate of the calibration
  double rate = 0.05;       ///< of false alarms
  int accepted = 0;         ///< causes that are accepted already
  double left = 0.0;        ///< what of their scores may look like other causes
};

/// The score that the best of all candidates exceeds by chance with a given probability: residual blocks
/// with random signs against the fixed columns, waves found by a scan as the largest of their grid; beyond
/// the 2 % quantile along a Gumbel fit. `more` is added to it.
Gate SignFlips(std::span<const Scored> scored, double false_alarm_rate, std::uint64_t seed, double more);

double Threshold(const Problem& problem, const Gate& gate, const Effect& effect);
/// The same of a kind without a number in the base.
double Threshold(const Problem& problem, const Gate& gate);

}  // namespace contour::diagnosis
