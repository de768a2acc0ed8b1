#pragma once

#include <array>
#include <cstddef>

#include "core/state_keeper.h"
#include "core/two_inertia_loop.h"
#include "estimator/linear_friction.h"
#include "estimator/linear_friction_fit.h"

namespace contour {

/// Parameters of LinearFriction, learnt on line from the force that an observer finds beyond them: recursive
/// least squares, as a Kalman filter of parameters that drift. What the terms of the last periods have made
/// of the observer's force by now is known, its response is linear; so the observer's own dynamics are not
/// taken for friction. The motion is the reference's and the response does not depend on the regulator:
/// nothing that is learnt here comes back through the loop.
class FrictionLearner {
 public:
  struct Setup {
    FrictionTerms parameters{};  ///< as commissioned
    FrictionTerms std{};         ///< of each on its own; 0: it keeps its value
    double level_std = 0.0;      ///< relative, of all together
    FrictionTerms per_std{};  ///< what one more standard deviation of another number makes of them: of sigma0
    FrictionTerms per_law{};  ///< and of another law of friction
    std::array<double, kLoopTaps> response{};  ///< TwoInertiaLoop::disturbance_response
    double level_N = 1.0;                      ///< Coulomb level
    double vs_m_s = 1.0;
    double inertial_kg = 0.0;  ///< what acceleration may be off by beyond the parameter of the mass
    double level_range = 2.0;  ///< factor of the level that may be learnt
    double weight_N = 0.0;     ///< that a constant force beside friction may have: of a vertical axis
    double period_s = 1e-3;
    double together = 1.0;  ///< samples over which noise of the observer's force hangs together
    bool learns = true;
  };

  FrictionLearner() noexcept = default;
  explicit FrictionLearner(const Setup& setup) noexcept;

  /// Back to what was commissioned.
  void Reset() noexcept;
  /// The observer starts anew: what was before does not show in it.
  void Forget() noexcept;

  /// A period has passed along which the terms were these, and at its end the observer finds
  /// `disturbance_N`, positive against positive motion. Returns how much of it is explained from now on: to
  /// be taken off the observer's. `may`: enabled, moved by nothing but the controller. `noise_N2`: variance
  /// of the observer's force that is noise of its readings.
  double Learn(const FrictionTerms& terms, double used_N, double disturbance_N, double speed_m_s, bool may,
               double noise_N2 = 0.0) noexcept;
  /// The axis stands: parameters that explain less than the commissioned ones go back to those.
  void Rest() noexcept;

  [[nodiscard]] const FrictionTerms& parameters() const noexcept { return parameters_; }
  /// Of a parameter, by what has been learnt so far.
  [[nodiscard]] double variance(std::size_t term) const noexcept { return covariance_[term][term]; }
  /// Of the constant force, what is beyond any difference of friction's directions; against positive motion.
  [[nodiscard]] double Weight_N() const noexcept;
  /// Sliding friction without Stribeck and viscous parts and without weight, positive in both directions.
  [[nodiscard]] double Level_N(bool forward) const noexcept;
  /// Sliding friction at a steady speed, without viscous parts.
  [[nodiscard]] double SlidingLevel_N(bool forward, double speed_m_s) const noexcept;
  /// A parameter stands at its bound.
  [[nodiscard]] bool bounded() const noexcept { return bounded_; }
  /// How often Rest has had to bring them back.
  [[nodiscard]] int brought_back() const noexcept { return brought_back_; }
  /// A force from outside is there, or was a moment ago: for half a second nothing is learnt.
  [[nodiscard]] bool disturbed() const noexcept { return wait_cycles_ > 0; }

  /// Constants stay as constructed.
  void Keep(StateKeeper& keep) noexcept {
    keep(parameters_, covariance_, past_, newest_, with_N2_, without_N2_, wait_cycles_, waited_cycles_,
         brought_back_, bounded_);
  }

 private:
  void Filter(FrictionTerms& filtered) const noexcept;
  void Along(const FrictionTerms& filtered, FrictionTerms& along) const noexcept;
  void Bound(double gain, const FrictionTerms& along) noexcept;
  void Shrink(const FrictionTerms& along) noexcept;
  void Update(const FrictionTerms& filtered, double unexplained_N, double moving, double noise_N2) noexcept;
  void Judge(const FrictionTerms& filtered, double disturbance_N) noexcept;
  bool Waits(double disturbance_N, double noise_N2) noexcept;

  Setup setup_;
  FrictionMatrix initial_{};
  FrictionTerms drift_{};           // variance per period
  FrictionTerms least_{}, most_{};  // that parameters may be
  double directions_N_ = 0.0;       // by which friction of a direction may differ from the mean
  double noise_N2_ = 1.0;
  double outside_N_ = 1.0;
  double judge_share_ = 1.0;
  int wait_ = 0;
  int longest_ = 0;

  FrictionTerms parameters_{};
  FrictionMatrix covariance_{};
  // A ring. In the place that no term has, what was expected of them.
  std::array<FrictionTerms, kLoopTaps> past_{};
  static_assert(friction_term::kUsed < kFrictionTerms);
  std::size_t newest_ = 0;
  double with_N2_ = 0.0, without_N2_ = 0.0;  // mean squares of what is not explained, learnt and commissioned
  int wait_cycles_ = 0;
  int waited_cycles_ = 0;
  int brought_back_ = 0;
  bool bounded_ = false;
  bool sound_ = true;  // of the newest update
};

}  // namespace contour
