#pragma once

#include <algorithm>
#include <cmath>

#include "estimator/exponential.h"

namespace contour {

/// Whether a reading tells anything of the bristle's stiffness, and which of what has been learnt of it is
/// worth keeping. The position of an axis depends on sigma0 only on the first presliding lengths after a
/// reversal, and only as long as what else acts on the axis is known better than the bristle's force: in a
/// corner an inertial force many times the friction acts, and a mass that is off by a few per cent looks
/// like any stiffness.
class StiffnessEvidence {
 public:
  struct Tuning {
    double sigma0_N_m = 1.0;  ///< as commissioned
    double mass_kg = 1.0;
    double mass_std = 0.05;      ///< relative
    double timing_noise = 0.02;  ///< of a change of torque, what acts at another time than it is taken to
    double period_s = 1e-3;
  };
  struct Sample {
    bool forward = true;
    double bristle_N = 0.0;
    double level_N = 0.0;
    double velocity_m_s = 0.0;
    double travel_m = 0.0;           ///< since the motion turned round
    double acceleration_m_s2 = 0.0;  ///< commanded
    double torque_step_N = 0.0;      ///< of the drive's force, from the period before
    double surprise = 0.0;           ///< innovation, in its standard deviations
  };

  StiffnessEvidence() noexcept = default;
  explicit StiffnessEvidence(const Tuning& tuning) noexcept
      : tuning_(tuning), fade_(ExpOfNegative(-tuning.period_s / kRings_s)) {}

  void Reset() noexcept {
    kept_ = 0.0;
    Rest();
  }

  /// Once per period in which the axis moves.
  void See(const Sample& s, double log_sigma0) noexcept {
    const double unknown_N = tuning_.mass_std * tuning_.mass_kg * std::abs(s.acceleration_m_s2) +
                             tuning_.timing_noise * std::abs(s.torque_step_N);
    unknown_N_ = std::max(unknown_N, fade_ * unknown_N_);
    surprise2_ = s.surprise * s.surprise + fade_ * (surprise2_ - s.surprise * s.surprise);
    if (!moving_ || s.forward != forward_) {
      begin_N_ = s.bristle_N;
      shown_ = false;
    }
    moving_ = true;
    forward_ = s.forward;
    const double length_m = s.level_N / tuning_.sigma0_N_m;
    const double told_N = std::abs(s.bristle_N - begin_N_);
    const bool presliding = std::abs(s.bristle_N) < kPreslidingShare * s.level_N;
    const bool resolved = std::abs(s.velocity_m_s) * tuning_.period_s < kCoarsest * length_m;
    matters_ = presliding && resolved && s.travel_m < kMostLengths * length_m &&
               kMoreThanUnknown * unknown_N_ < s.level_N && surprise2_ < kMostSurprise * kMostSurprise;
    shows_ = matters_ && told_N > kLeastTold * s.level_N && told_N > kMoreThanUnknown * unknown_N_;
    // A passage that was seen to its end has told what there is to tell.
    if (shown_ && !presliding) {
      kept_ = log_sigma0;
      shown_ = false;
    }
    shown_ = shown_ || shows_;
  }

  /// Nothing is told of sigma0 while this axis stands.
  void Rest() noexcept {
    moving_ = matters_ = shows_ = shown_ = false;
    unknown_N_ = surprise2_ = 0.0;
  }

  /// The axis is in a passage that may tell of sigma0: what it is uncertain by counts.
  [[nodiscard]] bool matters() const noexcept { return matters_; }
  /// And has told enough for it to be learnt.
  [[nodiscard]] bool shows() const noexcept { return shows_; }
  /// ln(sigma0 / commissioned) as the last passage left it that told of it; 0: none has.
  [[nodiscard]] double kept() const noexcept { return kept_; }
  void Forget() noexcept { kept_ = 0.0; }

 private:
  // Presliding: the bristle is well below the level it would slip at.
  static constexpr double kPreslidingShare = 0.7;
  // After so much travel a bristle of a third of the commissioned stiffness has come to 0.74 of its level.
  static constexpr double kMostLengths = 4.0;
  // A passage that takes less than two periods is not seen.
  static constexpr double kCoarsest = 0.5;
  // Of the level, by how much the bristle's force must have changed.
  static constexpr double kLeastTold = 0.1;
  // And by so many times what is not known of the other forces.
  static constexpr double kMoreThanUnknown = 5.0;
  // Root mean square of recent innovations, in their standard deviations: beyond, the model is wrong, and
  // rather not by its stiffness.
  static constexpr double kMostSurprise = 3.0;
  // What a corner has struck rings for so long.
  static constexpr double kRings_s = 10e-3;

  Tuning tuning_;
  double fade_ = 0.0;
  double unknown_N_ = 0.0;  // largest recent one, fading
  double surprise2_ = 0.0;
  double begin_N_ = 0.0;  // of the bristle, where the motion turned round
  double kept_ = 0.0;
  bool moving_ = false;
  bool forward_ = true;
  bool matters_ = false;
  bool shows_ = false;
  bool shown_ = false;
};

}  // namespace contour
