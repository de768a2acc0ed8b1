#pragma once

#include <array>
#include <cstdint>

#include "core/reason.h"
#include "estimator/scale_fit.h"
#include "estimator/scale_window.h"

namespace contour {

/// The linear scale of one axis: where its zero lies, whether it can be believed, and what it teaches
/// (ScaleFit). It counts from a zero of its own, which is taken where the motor's encoder has it when both
/// are first seen, on average until the axis is held, and again when somebody tells the axis where it is.
///
/// It is believed against the motor: torque less what accelerates the motor is the force through the screw,
/// and the screw winds up by no more than that. Neither knows of the scale, so nothing that the loop does
/// about a scale that lies makes it look true. What is left may be friction at the motor, the wind-up at
/// which the zero was taken, errors of stiffness, mass and lead; all bounds are of these.
///
/// Within a turn of the screw, and a part of one, far less can change than since the zero was taken
/// (ScaleWindow): there one that begins to count wrongly is seen before the loop has followed it far.
class TableScale {
 public:
  struct Setup {
    double period_s = 1e-3;
    double motor_mass_kg = 1.0;
    double table_mass_kg = 1.0;
    double stiffness_N_m = 1.0;
    double stiffness_std = 0.0;       ///< relative; 0: nothing is learnt
    double friction_N = 1.0;          ///< at most
    double level_N = 1.0;             ///< as commissioned
    double acceleration_m_s2 = 10.0;  ///< of paths, at most
    double turn_m = 5e-3;
    double reading_m = 1e-8;       ///< step of the encoder
    double sudden_m = 1e-6;        ///< so far forces take the table in a period besides what is foreseen
    double sample_jitter_s = 0.0;  ///< by which a SYNC may come late or early
    bool learns = true;
    double count_m = 0.0;  ///< of the scale
  };
  struct Sample {
    bool enabled = false;
    bool moves = false;
    bool fresh = false;  ///< of the encoder
    bool scale_fresh = false;
    double position_m = 0.0;  ///< of the motor
    double scale_m = 0.0;     ///< the scale's reading
    double force_N = 0.0;     ///< on the motor, mean over the period that ends here
    double lead_m = 0.0;      ///< of the motor before the table that the model states besides wind-up
  };

  explicit TableScale(const Setup& setup) noexcept;

  /// As commissioned, and believed until something speaks against it.
  void Reset() noexcept;
  /// The axis is let go, and will be enabled anew: the same, but for the motor's mass.
  void LetGo() noexcept;
  void Step(const Sample& sample) noexcept;
  /// By how much the newest reading is off from where the table was expected, at this speed: further than a
  /// force or a SYNC that came late takes it, and it is not to be used. What lasts is doubted.
  bool Sudden(double off_m, double velocity_m_s) noexcept;

  /// Why it is not believed: kNone, kScaleLost or kScaleDoubted. Stays until the axis is enabled anew. A
  /// doubt is told some readings after it has begun: the motion monitor, which looks at larger distances, may
  /// have more to say of it.
  [[nodiscard]] Reason told() const noexcept {
    return doubt_ == Reason::kScaleDoubted && doubted_ <= lost_ ? Reason::kNone : doubt_;
  }
  [[nodiscard]] bool believed() const noexcept { return seen_ && doubt_ == Reason::kNone; }
  /// The newest reading, by the encoder's zero.
  [[nodiscard]] double table_m() const noexcept { return table_m_; }

  /// By how much the motor is before the table beyond the wind-up by this force as commissioned.
  [[nodiscard]] double Beyond_m(double position_m, double force_N) const noexcept {
    return fit_.zero_m() + fit_.extra_compliance_m_N() * force_N +
           fit_.Lead_m(position_m - zero_at_m_, position_m);
  }
  /// Force through the screw, low-passed, by torque and motor alone.
  [[nodiscard]] double screw_N() const noexcept {
    return low_[kForce] - setup_.motor_mass_kg * acceleration_m_s2_;
  }
  [[nodiscard]] const ScaleFit& fit() const noexcept { return fit_; }

 private:
  // Low-passed alike.
  enum Signal : std::uint8_t { kApart, kForce, kRate, kTravel, kCos, kSin, kLead, kSignals };
  void SettleZero(const Sample& s, double apart_m) noexcept;
  void Filter(const Sample& s) noexcept;
  [[nodiscard]] double Allowed_m(double screw_N, double acceleration_m_s2) const noexcept;
  [[nodiscard]] bool Plausible() const noexcept;
  [[nodiscard]] ScaleWindow WindowOf(double way_m) const noexcept;
  [[nodiscard]] double MotorsScrew_N() const noexcept;
  [[nodiscard]] bool GoesWithMotor(const Sample& s) noexcept;

  Setup setup_;
  double share_ = 1.0;        // of the low-pass, per period
  double creep_share_ = 0.0;  // per period
  int most_samples_ = 1;
  int lost_ = 3;

  bool seen_ = false;
  double zero_m_ = 0.0;
  double zero_at_m_ = 0.0;  // the motor, there
  int zero_samples_ = 0;    // that it is a mean of; 0: the axis has been held since
  double position_m_ = 0.0, table_m_ = 0.0, lead_m_ = 0.0;
  int periods_ = 0;  // since that sample
  int missing_ = 0, sudden_ = 0, doubted_ = 0;
  double lately_m_ = 0.0;  // largest that readings were off by, forgotten in a hundred
  Reason doubt_ = Reason::kNone;
  bool filtering_ = false;
  std::array<double, kSignals> low_{};
  double acceleration_m_s2_ = 0.0;
  // The same filtered as little as a step of the encoder allows, for what cannot wait.
  std::array<double, 3> quick_{};  // apart, force, velocity
  double quick_m_s2_ = 0.0;
  double center_m_ = 0.0;
  std::array<ScaleWindow, 2> windows_{};
  double table_share_ = 0.0;  // of the torque, through the screw
  double rings_kept_ = 0.0;   // per period
  double rings_N_ = 0.0;      // the screw, by what the torque changed at once
  double force_N_ = 0.0;      // of the sample before
  ScaleFit fit_;
};

}  // namespace contour
