#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/validation/contest/contest_cell.h"
#include "tools/validation/contest/contest_config.h"

namespace contour {

/// All controllers on one program, machine and seed.
struct Heat {
  std::string program;
  std::string machine;
  std::uint64_t seed = 1;
  std::vector<ControllerName> controllers;
  std::vector<CellResult> results;  ///< one per controller

  /// Null when the controller did not run.
  [[nodiscard]] const CellResult* Of(ControllerName controller) const;
};

/// Puts results beside each other; cells as PlanCells orders them, controllers innermost.
std::vector<Heat> Heats(const std::vector<ContestCell>& cells, const std::vector<CellResult>& results);

/// A heat that `full` does not win outright.
struct Loss {
  const Heat* heat = nullptr;
  ControllerName best = ControllerName::kFull;
  double full_um = 0.0;
  double best_um = 0.0;
  [[nodiscard]] double ratio() const { return full_um / best_um; }
};

enum class Reached { kNo, kYes, kBelow };  ///< kBelow: more than 15 % better than the figure

struct RivalCheck {
  ExpectedPeak expected;
  double peak_um = 0.0;  ///< median of the seeds
  Reached reached = Reached::kNo;
};

/// What is asked of `full`, and how it stands.
struct Verdict {
  std::size_t heats = 0;      ///< in which `full` met a rival
  std::size_t near_best = 0;  ///< best, or within 10 % of the best
  std::vector<Loss> losses;   ///< not within 10 %, the largest ratio first
  std::vector<const Heat*> unstable;
  std::size_t twice = 0;  ///< worse than twice the best
  /// The same two when a difference below one count of the finest encoder is a difference, too.
  std::size_t strictly_near_best = 0;
  std::size_t strictly_twice = 0;
  std::vector<RivalCheck> rivals;

  [[nodiscard]] double near_best_share() const {
    return heats == 0 ? 1.0 : static_cast<double>(near_best) / static_cast<double>(heats);
  }
  /// Best or nearly in 95 % of the heats, never unstable, never worse than twice the best.
  [[nodiscard]] bool met() const { return near_best_share() >= 0.95 && unstable.empty() && twice == 0; }
};

/// Stopped, growing from turn to turn, or more than ten times the median of the others.
bool Unstable(const Heat& heat, ControllerName controller);

/// Losses point into `heats`. The rivals are held against the figures on machine `nominal`.
Verdict Judge(const std::vector<Heat>& heats, const std::vector<ExpectedPeak>& expected,
              const std::string& nominal);

/// Of a list that is not empty; of an even number the mean of the two in the middle.
double Median(std::vector<double> values);

}  // namespace contour
