#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/loop_tuning.h"
#include "design/loop_margins.h"

namespace contour {

inline constexpr double kNeverHopeless = 1e9;

struct LoopSearchOptions {
  int random_starts = 60;
  int runs = 6;
  int evaluations_per_run = 600;
  int refinements = 2;  ///< of the best runs
  int evaluations_per_refinement = 1500;
  int threads = 1;
  std::optional<LoopTuning> start;  ///< for instance, the one that the machine has
  std::vector<LoopMember> members;  ///< what it must bear; empty: UncertaintySet
  /// Share of the error under a step of force that may be left after 200 ms.
  double most_left = 1.0;
  /// Do not refine where all that would be is still further than this beyond a limit, as a share of it.
  double hopeless_excess = kNeverHopeless;
};

/// The tuning found, and how good it is.
struct FoundLoop {
  LoopTuning tuning;
  LoopVerdict verdict;
  double cost = 0.0;
  int evaluations = 0;
  /// Of FindLoop, where neither of its searches has found one: what is wrong with the best loop that leaves
  /// friction's falling slope aside. Empty where none was looked for.
  std::string wrong_creeping;
};

/// What the search makes small: the logarithm of the table's error under a force step (peak and twice the
/// mean, in micrometres), and `limit_slope` per share beyond a limit (a little where the axis creeps).
double LoopCost(const LoopVerdict& verdict, double limit_slope);

/// What was found on other axes, with all frequencies in those of this sampling.
std::vector<LoopTuning> LoopsOfOtherAxes(double period_s);

/// Searches the tuning of one axis. Deterministic. Whether what was found keeps the limits is for Acceptable
/// to say. Throws std::invalid_argument when the axis itself cannot be.
FoundLoop SearchLoop(const LoopAxis& axis, double period_s, const LoopSearchOptions& options = {});

}  // namespace contour
