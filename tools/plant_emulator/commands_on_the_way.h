#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace contour::plant {

/// Torques that a drive has been given and that act later: its input delay. First in, first out.
class CommandsOnTheWay {
 public:
  /// False where no room is left.
  [[nodiscard]] bool Add(double torque_Nm, std::int64_t at_ns) noexcept {
    if (count_ == commands_.size()) return false;
    commands_[(first_ + count_) % commands_.size()] = {torque_Nm, at_ns};
    ++count_;
    return true;
  }

  /// When the next one acts; the end of time without one.
  [[nodiscard]] std::int64_t next_ns() const noexcept {
    return count_ > 0 ? commands_[first_].at_ns : std::numeric_limits<std::int64_t>::max();
  }

  /// The next one, which there must be.
  double Take_Nm() noexcept {
    const double torque_Nm = commands_[first_].torque_Nm;
    first_ = (first_ + 1) % commands_.size();
    --count_;
    return torque_Nm;
  }

  void Clear() noexcept { count_ = 0; }

 private:
  struct Command {
    double torque_Nm = 0.0;
    std::int64_t at_ns = 0;
  };
  std::array<Command, 64> commands_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace contour::plant
