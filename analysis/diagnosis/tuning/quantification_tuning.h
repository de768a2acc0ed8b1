#pragma once

#include "analysis/diagnosis/tuning/fit_effort.h"

namespace contour::diagnosis {

/// Sizes of what is accepted, and what could be found of the rest.
struct QuantificationTuning {
  /// [factor on a size] A cause must also hold in several blocks, in unseen halves and against other
  /// hypotheses, and the rest of the fit takes a part of it over. Source: emulated machines,
  /// laboratory/diagnosis_results.md. 2026-11-22
  double beyond_threshold = 1.6;
  /// [factor on a size] The same where the size comes from runs at that size. Source: archive. 2026-11-22
  double beyond_runs = 1.5;
  /// [of the largest that such an axis can have] A log is good for a kind while a flaw would show by this
  /// much less. Source: reasoning. 2026-11-22
  double hopeless_factor = 1.5;
  /// [of what the linear estimate asks for] The smallest size that is run. Source: reasoning. 2026-11-22
  double first_run_share = 0.5;
  /// [steps] All that was accepted, together. Source: archive. 2026-11-22
  FitEffort together = {.most_steps = 12, .most_refreshes = 4};
};

inline constexpr QuantificationTuning kQuantification;

}  // namespace contour::diagnosis
