#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/fixed_vector.h"
#include "core/horizon.h"
#include "core/side_mode.h"
#include "core/state_keeper.h"

namespace contour {

/// What parts of the table that swing on springs ask of the screw along a reference that is known in advance,
/// beside what they would ask if they were fixed to the table: m e'', with e their way from the table,
/// e'' + 2 zeta w e' + w^2 e = -a. Only the reference goes in, so it closes no loop. How far their frequency
/// is known counts as damping: after some periods nobody knows where they are.
class SideModeForce {
 public:
  SideModeForce() noexcept = default;
  /// Throws std::invalid_argument when there are more than kMostSideModes.
  SideModeForce(const std::vector<SideMode>& modes, double table_mass_kg, double period_s);

  [[nodiscard]] bool none() const noexcept { return modes_.empty(); }
  void Reset() noexcept;
  /// Lays it along the first `points` of the reference; its element 0 is what element 1 was before.
  void Follow(const AxisHorizon& reference, std::size_t points) noexcept;
  /// On the table at a point, positive against positive motion; beyond the last one its force.
  [[nodiscard]] double At_N(std::size_t point) const noexcept {
    return laid_ == 0 ? 0.0 : force_N_[point < laid_ ? point : laid_ - 1];
  }

  /// The modes stay as constructed.
  void Keep(StateKeeper& keep) noexcept { keep(states_, force_N_, laid_); }

 private:
  struct State {
    double way_m = 0.0, rate_m_s = 0.0;
  };
  struct Mode {
    double mass_kg = 0.0, damping_1_s = 0.0, stiffness_1_s2 = 0.0;
    /// To the next point: rows of way and rate over way, rate, and the accelerations at both ends.
    std::array<std::array<double, 4>, 2> next{};
  };
  static Mode MakeMode(const SideMode& mode, double table_mass_kg, double period_s) noexcept;

  FixedVector<Mode, kMostSideModes> modes_;
  std::array<State, kMostSideModes> states_{};  ///< at element 0 of the next reference
  std::array<double, kMaxHorizonPoints> force_N_{};
  std::size_t laid_ = 0;
};

}  // namespace contour
