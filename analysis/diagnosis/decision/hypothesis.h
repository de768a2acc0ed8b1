#pragma once

#include <string>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/prediction_error/fit.h"

namespace contour::diagnosis {

/// A candidate hypothesis, fitted jointly with the base and with what is accepted already.
struct Hypothesis {
  Fit fit;
  double score = 0.0;    ///< what it lowers chi^2 and prior by, less its penalty
  bool refused = false;  ///< did not hold
  /// So far behind that nothing but its place and its score is kept: the rest of a fit is large.
  bool given_up = false;
  /// A coupling that every screw has, no cause of a deviation: it belongs to the base.
  bool no_fault = false;
  /// By least squares it explains most of what moves the sliding axis: excited, whatever the noise of a base
  /// that lies far off lets the score test see.
  bool gross = false;
  bool implausible = false;  ///< the fit ended where the cause is not what its name says

  [[nodiscard]] const Effect& effect() const { return *fit.point.effects.back(); }
};

/// A shape that is none of the catalogue.
inline bool Outside(const std::string& kind) { return kind.starts_with(kOutside); }

}  // namespace contour::diagnosis
