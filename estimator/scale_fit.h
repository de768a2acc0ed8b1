#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace contour {

/// What motor and table are apart by, beyond the wind-up of the commissioned screw: zero of the scale,
/// compliance of the screw, error of the lead over travel and over a turn. Linear in these, so a Kalman
/// filter of parameters that drift learns them from readings of encoder and linear scale, with the force
/// through the screw as torque and motor tell it. An observer's own disturbance would not do: it is stiffness
/// as believed times wind-up, whatever the stiffness.
class ScaleFit {
 public:
  struct Setup {
    double period_s = 1e-3;
    double noise_m = 1e-7;        ///< what a sample is off by for other reasons
    double compliance_std = 0.0;  ///< m/N, of the commissioned one
    double mass_std_s2 = 0.0;     ///< m per m/s^2: error of the motor's mass, which force_N has in it, over K
    double turn_m = 5e-3;         ///< travel of a turn of the screw
    bool learns = true;
    double count_m = 0.0;  ///< of the scale: what a reading is rounded to
  };
  /// Low-passed alike, all of one instant.
  struct Sample {
    double apart_m = 0.0;            ///< motor minus table, less the wind-up of the commissioned screw
    double force_N = 0.0;            ///< through the screw
    double travel_m = 0.0;           ///< of the motor since the zero was taken
    double cos = 0.0, sin = 0.0;     ///< of the screw's angle
    double acceleration_m_s2 = 0.0;  ///< of the motor
    bool moves = false;
    double velocity_m_s = 0.0;  ///< of the motor
  };

  ScaleFit() noexcept = default;
  explicit ScaleFit(const Setup& setup) noexcept;

  /// As commissioned; motor and table are so far apart.
  void Reset(double apart_m) noexcept;
  /// The axis is let go: the same, but for the motor's mass, which stays what it is.
  void LetGo(double apart_m) noexcept;
  void Learn(const Sample& sample) noexcept;

  [[nodiscard]] double zero_m() const noexcept { return value_[kZero]; }
  [[nodiscard]] double extra_compliance_m_N() const noexcept { return value_[kCompliance]; }
  /// One standard deviation of the screw's compliance.
  [[nodiscard]] double compliance_std_m_N() const noexcept {
    return std::sqrt(covariance_[kCompliance][kCompliance]);
  }
  /// What the motor is heavier than commissioned over the screw's stiffness as it is: m per m/s^2.
  [[nodiscard]] double motor_extra_s2() const noexcept { return -value_[kMass]; }
  /// Error of the lead there.
  [[nodiscard]] double Lead_m(double travel_m, double position_m) const noexcept;

 private:
  [[nodiscard]] double Rounding_m2(double velocity_m_s) const noexcept;
  void Bound() noexcept;
  static constexpr std::size_t kZero = 0, kCompliance = 1, kSlope = 2, kCos = 3, kSin = 4, kMass = 5,
                               kSize = 6;
  using Row = std::array<double, kSize>;

  Setup setup_;
  Row prior_{};  // standard deviations
  Row bound_{};  // of the sizes of values; the zero has none
  Row drift_{};  // variance per period of motion
  double zero_drift_m2_ = 0.0;
  double zero_share_ = 0.0;  // per period of rest
  Row value_{};
  std::array<Row, kSize> covariance_{};
};

}  // namespace contour
