#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "core/axis.h"
#include "core/horizon.h"
#include "core/mechanics.h"
#include "estimator/estimator_config.h"
#include "estimator/friction_config.h"

namespace contour {

enum class EstimatorKind : std::uint8_t {
  kKinematic,            ///< position and velocity only; no friction
  kDisturbanceObserver,  ///< Kalman filter [p, v, d]
  kSrukf4,               ///< the paper's four states, corrected
  kEkf7,                 ///< the seven states in an extended Kalman filter
  kSrukf7,               ///< seven states in a square-root unscented Kalman filter
  kFull,                 ///< kSrukf7, per-turn ripple, friction rolled along the reference
};

/// What the estimator of one axis takes in per cycle. "Table units": forces are torque / R.
struct AxisEstimatorInput {
  double position_m = 0.0;  ///< R theta of the newest feedback, latched at t(k-1)
  bool fresh = false;       ///< false: no new feedback; the filter only predicts
  /// Torque commands over R as really sent (limited, rounded to the drive's steps), newest first:
  /// u(k-1), which acts over [t(k-1), t(k)), then u(k-2), u(k-3).
  std::array<double, 3> force_N{};
  double commanded_velocity_m_s = 0.0;  ///< reference at t(k-1)
  double commanded_acceleration_m_s2 = 0.0;
  bool at_rest = true;   ///< commanded velocity is zero: friction parameters keep their values
  bool enabled = false;  ///< the drive turns torque into motion; otherwise only the position is followed
};

/// State, velocity and friction of one axis from its motor encoder and the torque sent to it.
/// One Update per cycle, then PreviewFriction if wanted. Value semantics; nothing allocates after
/// construction.
class AxisEstimator {
 public:
  using Input = AxisEstimatorInput;

  /// resolution_m: one encoder count at the table; 0 when unknown. lag_s: time constant of the drive's
  /// current loop. Throws std::invalid_argument when a value makes no sense (not positive, not finite).
  AxisEstimator(EstimatorKind kind, const Mechanics& mechanics, const FrictionConfig& friction,
                const EstimatorConfig& config, double period_s, double lag_s, double resolution_m = 0.0);

  /// Starts anew at a position, at rest; friction parameters as commissioned.
  void Reset(double position_m) noexcept;

  /// Filter at t(k-1) and prediction to t(k).
  AxisEstimate Update(const Input& in) noexcept;

  /// Total friction (bristle, viscous, disturbance) expected along the reference; out gets reference.size()
  /// elements. Zero for kKinematic.
  void PreviewFriction(const AxisHorizon& reference, FrictionPreview& out) noexcept;
};

}  // namespace contour
