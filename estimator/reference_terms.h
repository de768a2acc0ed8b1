#pragma once

#include <array>
#include <cstddef>

#include "core/horizon.h"
#include "estimator/level_correction.h"
#include "estimator/seven_state_model.h"

namespace contour {

/// What the friction along a reference takes from the reference and the commissioned law alone: angle of the
/// screw, Stribeck curve and bristle damping at every point. From one cycle to the next a reference moves on
/// by one point and only its last one is new; where it does not, bit for bit, everything is computed anew. So
/// what comes out does not depend on what was kept. One object belongs to one model and one correction.
class ReferenceTerms {
 public:
  /// Rows of the reference from its element 0 on; beyond its end the last element stands. The velocity and
  /// what follows from it belong to the middle of the period from the point on.
  struct View {
    const double *position_m, *node_velocity_m_s, *acceleration_m_s2, *velocity_m_s;
    std::array<const double*, LevelCorrection::kTerms> basis;
    const double* low_speed;                              ///< SpeedTerms::low_speed
    const double *node_sigma1_Ns_m, *middle_sigma1_Ns_m;  ///< bristle damping
  };

  /// Elements 0 .. count-1 of a reference that is not empty, and position, velocity and acceleration of one
  /// more. `count`: a multiple of kVector, at most kMaxHorizonPoints.
  View Follow(const SevenStateModel& model, const LevelCorrection& correction, const AxisHorizon& reference,
              std::size_t count) noexcept;

  static constexpr std::size_t kVector = 4;
  static_assert(kMaxHorizonPoints % kVector == 0);

 private:
  // A window that moves along the rows, and now and then back to their beginning.
  static constexpr std::size_t kLength = 2 * kMaxHorizonPoints + 8;
  using Row = std::array<double, kLength>;

  [[nodiscard]] bool MovedOn(const AxisHorizon& reference, std::size_t count) const noexcept;
  void Lay(const AxisHorizon& reference, std::size_t from, std::size_t count) noexcept;
  void ComputeAll(const SevenStateModel& model, const LevelCorrection& correction) noexcept;
  /// Of element count_ - 1; those before it are there.
  void ComputeLast(const SevenStateModel& model, const LevelCorrection& correction) noexcept;
  void Rewind() noexcept;

  std::size_t head_ = 0;
  std::size_t count_ = 0;       // 0: nothing is known
  std::array<Row, 3> nodes_{};  // position, velocity, acceleration
  std::array<Row, LevelCorrection::kTerms + 4> terms_{};
};

}  // namespace contour
