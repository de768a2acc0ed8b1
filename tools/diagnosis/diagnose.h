#pragma once

#include <cstdint>
#include <functional>
#include <string_view>

#include "tools/diagnosis/axis_log.h"
#include "tools/diagnosis/finding.h"
#include "tools/diagnosis/stated_axis.h"

namespace contour::diagnosis {

struct DiagnoseOptions {
  double false_alarm_rate = 0.05;
  std::uint64_t seed =
      1;  ///< of everything drawn; the same seed gives the same answer on any number of threads
  int threads = 1;
  int most_effects = 3;  ///< causes named at most
  /// Refits with the residual of every stroke at random, from which the intervals come; 0: from the fit's
  /// covariance.
  int bootstrap_runs = 0;
  /// Called now and then from the calling thread with what is being done and how much of it is done, 0..1.
  std::function<void(std::string_view, double)> progress;
};

/// What the log shows that the model does not have. The log's columns must be of equal length, its period and
/// the stated inertia positive: std::invalid_argument otherwise.
Diagnosis Diagnose(const AxisLog& log, const StatedAxis& stated, const DiagnoseOptions& options = {});

}  // namespace contour::diagnosis
