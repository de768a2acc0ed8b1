#pragma once

namespace contour {

/// By how much the axis is heavier, and its drive later, than commissioned, learnt on line from what the
/// drive pushes and how the encoder answers:
///
///   force(t) - friction(t) = m a(t + delay) = m (a + delay a')
///
/// Both sides go through the same filters before they are compared: a low-pass, because two differences of an
/// encoder are mostly noise, and a high-pass, which takes away cutting forces and slow errors of the
/// friction. Least squares for the mass: the gain is what the present acceleration is worth beside all that
/// has been seen. The delay is taken from fast changes only; on a smooth path it would be mistaken for
/// friction. Where there are none nothing depends on it; a loop that begins to ring teaches it.
class MomentumBalance {
 public:
  struct Tuning {
    double mass_kg = 1.0;  ///< as commissioned
    double period_s = 1e-3;
    double mass_rate = 0.0;   ///< share of the error learnt per ms at 1 m/s^2 in the long run; 0: none
    double delay_rate = 0.0;  ///< and per ms at 100 N of change per ms
  };

  MomentumBalance() noexcept = default;
  explicit MomentumBalance(const Tuning& tuning) noexcept;

  void Reset() noexcept {
    extra_kg_ = delay_periods_ = 0.0;
    mass_seen_ = delay_seen_ = 0.0;
    Pause();
  }

  /// What the axis does has not to do with these forces for now.
  void Pause() noexcept {
    known_periods_ = 0;
    missing_.known = false;
  }

  [[nodiscard]] double extra_kg() const noexcept { return extra_kg_; }
  /// What is left of the variance of the commissioned mass, 1 until something has been seen.
  [[nodiscard]] double mass_variance_left() const noexcept { return kMassPrior / (mass_seen_ + kMassPrior); }
  /// Periods by which the drive acts later than commissioned, 0 to 1.
  [[nodiscard]] double delay_periods() const noexcept { return delay_periods_; }

  /// Force beyond what was given that the axis was driven with, by its acceleration over the last two
  /// periods, and the place and speed in the middle of them. Noisy, but not delayed by any filter.
  struct Missing {
    double force_N = 0.0, position_m = 0.0, velocity_m_s = 0.0, acceleration_m_s2 = 0.0;
    bool known = false;
  };
  [[nodiscard]] const Missing& missing() const noexcept { return missing_; }

  /// One period: the axis has come to `position_m` under `force_N` less `friction_N`, means over the period.
  void Learn(double position_m, double force_N, double friction_N) noexcept;

 private:
  /// Evidence that the commissioned mass weighs as much as, (m/s^2)^2 ms.
  static constexpr double kMassPrior = 10.0;

  struct Bands {
    double slow, slow_change, fast, fast_change;
  };
  /// Of the low-pass and of the means that the high-passes take away, per period.
  struct Shares {
    double low = 0.0, slow = 0.0, fast = 0.0;
  };
  /// One signal in both bands, and by how much it changes per period, at the middle of the newest period.
  struct Filter {
    double low = 0.0, slow_mean = 0.0, fast_mean = 0.0, slow = 0.0, fast = 0.0;
    Bands Step(double value, const Shares& shares) noexcept;
  };

  /// `change_m_s2`: of the acceleration, per period; `mass_kg`: as believed so far.
  void LearnMass(double acceleration_m_s2, double change_m_s2, double force_N, double mass_kg) noexcept;
  void LearnDelay(double acceleration_m_s2, double change_m_s2, double force_N, double mass_kg) noexcept;

  Tuning tuning_;
  Shares shares_;
  double period_ms_ = 1.0;
  double extra_kg_ = 0.0;
  double delay_periods_ = 0.0;
  double mass_seen_ = 0.0;
  double delay_seen_ = 0.0;
  double position_m_ = 0.0;
  double velocity_m_s_ = 0.0;
  double driving_N_ = 0.0;
  int known_periods_ = 0;
  Missing missing_;
  Filter acceleration_;
  Filter balance_;
};

}  // namespace contour
