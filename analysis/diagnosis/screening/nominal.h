#pragma once

#include <vector>

#include "analysis/prediction_error/fit.h"

namespace contour::diagnosis {

/// The stated model as the log has it: its numbers fitted, the noise learnt, and what may be tried in
/// addition to it.
struct Nominal {
  Fit fit;
  std::vector<SharedEffect> catalogue;
  double by_extras = 0.0;  ///< what |r|^2 would rise by without the extensions that the model has already
};

Nominal FitNominal(Problem& problem);

}  // namespace contour::diagnosis
