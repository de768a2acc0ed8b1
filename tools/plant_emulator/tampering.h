#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

namespace contour::plant {

/// What is broken in an emulated axis besides its mechanics: an encoder (or a linear scale) that lies, a
/// motor that gives another torque than its current asks for. All faults may be had together; without any,
/// nothing is changed by a bit.
class Tampering {
 public:
  // The encoder. What it tells goes to the drive's own loops too.
  /// The count stands still where it is; with `flicker` it changes by so many counts and back at every read.
  void Freeze(std::int64_t flicker_counts = 0) noexcept {
    frozen_ = told_;
    flicker_ = flicker_counts;
  }
  /// The count is so many counts away from now on.
  void Jump(std::int64_t counts) noexcept { offset_ += counts; }
  /// From here the count runs with `scale` times the motion: -1 is a sign that is wrong.
  void Scale(double scale) noexcept {
    pivot_ = true_;
    scale_ = scale;
  }
  /// All that concerns the encoder is well again; the count tells the truth.
  void MendEncoder() noexcept {
    frozen_.reset();
    flicker_ = offset_ = 0;
    scale_ = 1.0;
  }

  // The motor.
  /// It gives this share of what the current loop makes. `reported`: the drive's torque actual value shows
  /// it.
  void WeakenTorque(double share, bool reported) noexcept {
    torque_share_ = share;
    reported_share_ = reported ? share : 1.0;
  }
  void MendTorque() noexcept { torque_share_ = reported_share_ = 1.0; }
  /// The target torque is so much more than what was sent, from the next SYNC on.
  void PushTarget(double torque_Nm) noexcept { pushed_Nm_ = torque_Nm; }

  // For the axis:
  std::int64_t Read(std::int64_t counts) noexcept {
    true_ = counts;
    told_ = counts + offset_;
    if (scale_ != 1.0) told_ = pivot_ + offset_ + std::llround(scale_ * static_cast<double>(counts - pivot_));
    if (frozen_) {
      flicks_ = !flicks_;
      told_ = *frozen_ + (flicks_ ? flicker_ : 0);
    }
    return told_;
  }
  [[nodiscard]] double torque_share() const noexcept { return torque_share_; }
  [[nodiscard]] double pushed_Nm() const noexcept { return pushed_Nm_; }
  [[nodiscard]] double reported_share() const noexcept { return reported_share_; }

 private:
  std::optional<std::int64_t> frozen_;
  std::int64_t flicker_ = 0;
  bool flicks_ = false;
  std::int64_t offset_ = 0;
  double scale_ = 1.0;
  std::int64_t pivot_ = 0;
  std::int64_t true_ = 0;
  std::int64_t told_ = 0;
  double torque_share_ = 1.0;
  double reported_share_ = 1.0;
  double pushed_Nm_ = 0.0;
};

}  // namespace contour::plant
