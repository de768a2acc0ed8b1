#pragma once

#include <algorithm>
#include <cmath>

#include "core/state_keeper.h"

namespace contour {

/// By how much a drive's report (0x6077) has gone one way and come back. A drive that reads its encoder more
/// often than we do answers counts that flicker in between, each by a kick that is over at once, and its
/// report shows those that fall on a SYNC. A loop that adds up what a standing reading leaves goes one way.
class ReportTurns {
 public:
  /// What it has done before does not count any more.
  void Restart(double report_N) noexcept {
    report_N_ = report_N;
    way_N_ = way_before_N_ = most_N_ = 0.0;
  }
  void See(double report_N) noexcept {
    const double change_N = report_N - report_N_;
    report_N_ = report_N;
    if (change_N * way_N_ < 0.0) {
      way_before_N_ = way_N_;
      way_N_ = 0.0;
    }
    way_N_ += change_N;
    most_N_ = std::max(most_N_, std::min(std::abs(way_N_), std::abs(way_before_N_)));
  }
  /// At most, since the restart.
  [[nodiscard]] double most_N() const noexcept { return most_N_; }

  void Keep(StateKeeper& keep) noexcept { keep(report_N_, way_N_, way_before_N_, most_N_); }

 private:
  double report_N_ = 0.0;      ///< the newest
  double way_N_ = 0.0;         ///< since it last turned
  double way_before_N_ = 0.0;  ///< between the two turns before
  double most_N_ = 0.0;
};

}  // namespace contour
