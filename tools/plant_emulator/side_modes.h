#pragma once

#include <vector>

#include "tools/plant_emulator/axis_parameters.h"

namespace contour::plant {

/// Masses on springs on the table: a bed that rocks, a spindle head that nods. They are part of the table's
/// mass and move along its axis. A step of the implicit midpoint rule is theirs, too: their velocities are
/// eliminated from the table's equation before it is solved, and follow from its solution.
class SideModes {
 public:
  SideModes(const std::vector<SideMode>& modes, double table_m);

  /// All masses rest on the table, with its velocity.
  void Place(double table_m, double table_m_s) noexcept;
  /// Adds to `slope v + ... = constant` of the table's mean velocity v over a step of twice `half_s`.
  void AddTo(double half_s, double table_m, double& slope_Ns_m, double& constant_N) noexcept;
  /// The step that AddTo prepared, with the mean velocity it led to.
  void Commit(double step_s, double table_m_s) noexcept;
  /// Kinetic and elastic, J.
  [[nodiscard]] double Energy_J(double table_m) const noexcept;

 private:
  struct Mass {
    SideMode mode;
    double position_m = 0.0;
    double velocity_m_s = 0.0;
    double free_m_s = 0.0;   ///< mean velocity over the step if the table stood,
    double taken_rel = 0.0;  ///< and what the table's velocity adds to it
  };
  std::vector<Mass> masses_;
};

}  // namespace contour::plant
