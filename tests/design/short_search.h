#pragma once

#include "design/loop_search.h"

namespace contour {

/// Much less than what `contour tune --from-model` spends.
inline const LoopSearchOptions kShort{.random_starts = 20,
                                      .runs = 2,
                                      .evaluations_per_run = 200,
                                      .refinements = 1,
                                      .evaluations_per_refinement = 200,
                                      .threads = 2,
                                      .start = {},
                                      .members = {}};

}  // namespace contour
