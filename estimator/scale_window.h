#pragma once

#include <array>
#include <cstddef>

namespace contour {

/// Whether motor and table go together over a short way: how far they are apart beyond the wind-up is held
/// against what it was so far back, and little can change within that way. A scale or an encoder that begins
/// to count wrongly is off by a share of it.
///
/// The force through the screw is found twice: by what accelerates the motor, which a SYNC that comes late
/// gets wrong at speed, and by the table's share of the torque, which an outside force gets wrong. They do
/// not go together when neither explains it.
class ScaleWindow {
 public:
  static constexpr std::size_t kWays = 2;
  struct Setup {
    double way_m = 5e-3;
    double turn_m = 5e-3;         ///< travel of a turn of the screw
    double turn_error_rel = 0.0;  ///< of a turn: what the lead is off by within it, at most
    double lead_error_rel = 0.0;  ///< of the way: what it is off by besides
    double stiffness_N_m = 1.0;
    double stiffness_error_rel = 0.0;
    double friction_N = 1.0;  ///< at most
    double steps_m = 0.0;     ///< of encoder and scale
  };
  struct Sample {
    double apart_m = 0.0;  ///< motor less table
    std::array<double, kWays> screw_N{};
    std::array<double, kWays> unsure_N{};  ///< what each may be off by
    double moved_m = 0.0;                  ///< of the motor
    double elapsed_s = 0.0;
  };

  ScaleWindow() noexcept = default;
  explicit ScaleWindow(const Setup& setup) noexcept;
  /// The next sample is the first.
  void Restart() noexcept { begun_ = false; }
  bool GoTogether(const Sample& sample) noexcept;

 private:
  /// Followed over the way.
  struct Before {
    double apart_m = 0.0;
    double screw_N = 0.0;
  };
  Setup setup_;
  double lead_m_ = 0.0;
  bool begun_ = false;
  double direction_ = 0.0;         // of the motion: 1 or -1
  double direction_before_ = 0.0;  // followed
  std::array<Before, kWays> before_{};
};

}  // namespace contour
