#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/diagnosis/tuning/decision_tuning.h"

namespace contour::diagnosis {

/// What one kind of cause scored in one round, for calibrations.
struct Evidence {
  int accepted = 0;        ///< causes before this round
  double explained = 0.0;  ///< by them
  bool in_base = false;    ///< a number of the stated model
  std::string kind;
  double screened = 0.0;  ///< score test: drop of chi^2 and prior
  double penalty = 0.0;
  double overdispersion = 1.0;
  double refitted = 0.0;  ///< drop of the joint fit; NaN: not fitted
  double tested = 0.0;    ///< score that the threshold is asked about; NaN: not fitted
  double unseen = 0.0;    ///< held-out statistic; NaN: not fitted
  double flips = 0.0;     ///< threshold of the sign flips, at the rate of the calibration
  double asked = 0.0;     ///< by the threshold
};

struct DiagnoseOptions {
  double false_alarm_rate = kRounds.false_alarm_rate;
  std::uint64_t seed =
      1;  ///< of everything drawn; the same seed gives the same answer on any number of threads
  int threads = 1;
  int most_effects =
      kRounds.most_effects;          ///< causes named at most; as many further orders of theirs do not count
  std::vector<std::string> exclude;  ///< kinds that are not looked for
  /// Refits with the residual of every stroke at random, from which the intervals come; 0: from the fit's
  /// covariance.
  int bootstrap_runs = 0;
  /// For calibrations: candidates are fitted that exceed chance, whether they exceed the model-error
  /// allowance and the residual leakage or not. Slower; which are accepted is decided as ever.
  bool fit_above_chance = false;
  /// Gets what each kind scored; observes only.
  std::function<void(const Evidence&)> evidence;
  /// Called now and then from the calling thread with what is being done and how much of it is done, 0..1.
  std::function<void(std::string_view, double)> progress;
};

inline void Say(const DiagnoseOptions& options, std::string_view what, double done) {
  if (options.progress) options.progress(what, done);
}

}  // namespace contour::diagnosis
