#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "analysis/prediction_error/problem.h"

namespace contour::diagnosis {

struct Experiment {
  std::string text;     ///< for people
  std::string program;  ///< YAML for `contour run`; empty when none decides
};

/// What would tell a cause from its rivals, or show it better, within the stroke and torque of the log.
Experiment DecidingExperiment(const Problem& problem, std::string_view kind,
                              const std::vector<std::string>& rivals);

}  // namespace contour::diagnosis
