#include "estimator/scale_window.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace contour {
namespace {

// A screw that warms grows in so short a time by less than it winds up.
constexpr double kHardlyWarms_s = 10.0;
// Friction changes by this share of its most along the way without turning round.
constexpr double kAlongTheWay = 0.25;

}  // namespace

// A lead that is off once a turn changes along the way as its steepest part does.
ScaleWindow::ScaleWindow(const Setup& s) noexcept
    : setup_(s),
      lead_m_(s.turn_error_rel * std::min(s.turn_m, 2.0 * std::numbers::pi * s.way_m) +
              s.lead_error_rel * s.way_m) {}

bool ScaleWindow::GoTogether(const Sample& s) noexcept {
  if (s.moved_m != 0.0) direction_ = s.moved_m > 0.0 ? 1.0 : -1.0;
  const double share = std::min(1.0, std::abs(s.moved_m) / setup_.way_m + s.elapsed_s / kHardlyWarms_s);
  if (!begun_) direction_before_ = direction_;
  const double turned = std::abs(direction_ - direction_before_);
  bool together = false;
  for (std::size_t i = 0; i < kWays; ++i) {
    Before& before = before_[i];
    const double beyond_m = s.apart_m - s.screw_N[i] / setup_.stiffness_N_m;
    if (!begun_) before = {beyond_m, s.screw_N[i]};
    const double wound_N = setup_.stiffness_error_rel * std::abs(s.screw_N[i] - before.screw_N) +
                           (kAlongTheWay + turned) * setup_.friction_N + s.unsure_N[i];
    const double allowed_m = wound_N / setup_.stiffness_N_m + setup_.steps_m + lead_m_;
    together = together || std::abs(beyond_m - before.apart_m) <= allowed_m;
    before.apart_m += share * (beyond_m - before.apart_m);
    before.screw_N += share * (s.screw_N[i] - before.screw_N);
  }
  direction_before_ += share * (direction_ - direction_before_);
  begun_ = true;
  return together;
}

}  // namespace contour
