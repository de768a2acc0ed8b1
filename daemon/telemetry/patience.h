#pragma once

#include <algorithm>
#include <chrono>

namespace contour {

/// For how long all who fall behind may hold a machine in lock-step, together: so long at first, and one
/// cycle's time more with every cycle. One who waits uses half of what is left at most, so that what one who
/// has stopped uses up leaves something for the others. Of one thread.
class Patience {
 public:
  using Duration = std::chrono::nanoseconds;

  explicit Patience(Duration most = Duration::zero(), Duration per_cycle = Duration::zero())
      : most_(most), per_cycle_(per_cycle), left_(most) {}

  void EndCycle() { left_ = std::min(left_ + per_cycle_, most_); }
  [[nodiscard]] Duration ForOne() const { return left_ / 2; }
  void Use(Duration waited) { left_ = std::max(left_ - waited, Duration::zero()); }

 private:
  Duration most_, per_cycle_, left_;
};

}  // namespace contour
