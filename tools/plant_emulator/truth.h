#pragma once

#include <cstdint>

#include "core/axis.h"
#include "core/states.h"

namespace contour {

/// What an emulated axis really did, at one instant. Table units unless the name says rad or Nm.
struct AxisTruth {
  double motor_position_m = 0.0;    ///< R theta, without encoder error
  double motor_velocity_m_s = 0.0;  ///< R omega
  double table_position_m = 0.0;    ///< where the table is, lead error included
  double table_velocity_m_s = 0.0;
  double friction_N = 0.0;  ///< whole friction force on the table, viscous included; positive opposes
                            ///< positive motion
  double bristle_N = 0.0;   ///< the elastic part of it (LuGre: sigma0 z)
  double torque_Nm = 0.0;   ///< torque acting on the motor from this instant's drive current
  double command_Nm = 0.0;  ///< torque the drive's current loop is heading for
  double reported_position_rad = 0.0;  ///< what the encoder said when last latched
  double encoder_zero_m = 0.0;         ///< where an incremental encoder began to count; 0 for an absolute one
  double temperature_degC = 0.0;       ///< of the screw
  DriveState drive_state = DriveState::kUnknown;

  /// As the encoder counts: comparable with what the daemon knows of an axis that was told nothing.
  [[nodiscard]] double TableByEncoder_m() const noexcept { return table_position_m - encoder_zero_m; }
};

/// One row per SYNC, all axes at that SYNC's instant; while the machine runs free (no SYNC), one per
/// millisecond.
struct TruthRow {
  std::uint64_t sync_number = 0;  ///< SYNCs received since the start; the latest of any bus
  double time_s = 0.0;            ///< the machine's own time
  bool free_running = false;      ///< no SYNC belongs to this row
  PerAxis<AxisTruth> axes;
};

/// Takes every truth row as it comes into being, on the thread that steps the machine.
class TruthSink {
 public:
  virtual ~TruthSink() = default;
  virtual void OnTruth(const TruthRow& row) noexcept = 0;
};

}  // namespace contour
