#pragma once

namespace contour::diagnosis {

/// What could be found of what was not.
struct QuantificationTuning {
  /// [factor on a size] A cause must also hold in several blocks, in unseen halves and against other
  /// hypotheses, and the rest of the fit takes a part of it over. A log is good for a kind while a flaw would
  /// show by this much less than the largest that such an axis can have. Source: archive. 2026-11-23
  double beyond_threshold = 1.5;
};

inline constexpr QuantificationTuning kQuantification;

}  // namespace contour::diagnosis
