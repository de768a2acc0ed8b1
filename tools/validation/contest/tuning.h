#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/validation/contest/contest_cell.h"
#include "tools/validation/contest/contest_config.h"

namespace contour {

struct TunedValue {
  std::string key;
  double before = 0.0;
  double after = 0.0;
};

/// What tuning made of one controller.
struct TunedResult {
  std::string controller;
  double cost_before_um = 0.0;
  double cost_after_um = 0.0;
  int evaluations = 0;
  std::size_t runs = 0;
  std::vector<TunedValue> values;
};

/// Geometric mean over the runs of sqrt(peak rms), um at the table. A run that stopped counts as a
/// millimetre; an error that grows from turn to turn counts ten times.
double TuningCost_um(const std::vector<CellResult>& results);

/// Present value of a key: the machine file's, or else the default. `axes.*` stands for the first axis.
double PresentValue(const std::string& machine_file, const std::string& key);

/// Spends the budget on one controller, from the values of the machine file. Values move on a logarithmic
/// scale between their bounds and are tried with three digits, as they are written. `done` hears of every
/// evaluation.
TunedResult TuneController(const TuneConfig& config, const TunedController& controller,
                           const std::string& machine_file, int evaluations, unsigned workers,
                           const std::function<void(int evaluations, double best_um)>& done);

/// The tuned keys as a part of a machine file, `axes.*` written out for each of `axes`.
std::string TunedYaml(const std::vector<TunedResult>& results, const std::vector<std::string>& axes);

}  // namespace contour
