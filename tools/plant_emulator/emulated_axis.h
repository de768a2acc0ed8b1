#pragma once

#include <array>
#include <cstdint>

#include "drivers/can/bus_node.h"
#include "tools/plant_emulator/axis_plant.h"
#include "tools/plant_emulator/canopen_slave.h"
#include "tools/plant_emulator/commands_on_the_way.h"
#include "tools/plant_emulator/current_loop.h"
#include "tools/plant_emulator/drive_cascade.h"
#include "tools/plant_emulator/drive_objects.h"
#include "tools/plant_emulator/drive_power_state.h"
#include "tools/plant_emulator/encoder.h"
#include "tools/plant_emulator/tampering.h"
#include "tools/plant_emulator/truth.h"

namespace contour::plant {

/// One axis: a CiA 402 drive with its current loop and encoder, on its mechanics. The drive's control runs at
/// 8 kHz in its own time, re-phased by every SYNC.
class EmulatedAxis final : private SlaveDevice {
 public:
  static constexpr std::int64_t kTick_ns = 125'000;

  /// Throws std::invalid_argument.
  EmulatedAxis(const AxisParameters& parameters, const EmulatedAxisPlacement& placement,
               std::uint32_t cycle_us, std::uint64_t seed, std::uint64_t stream);
  EmulatedAxis(const EmulatedAxis&) = delete;
  EmulatedAxis& operator=(const EmulatedAxis&) = delete;

  /// Every frame except SYNC.
  void OnFrame(const CanFrame& frame, std::int64_t bus_ns, PendingFrames& out) noexcept;
  /// The SYNC, after AdvanceTo its instant: latches, sends TPDOs, applies RPDOs.
  void OnSync(std::int64_t bus_ns, PendingFrames& out) noexcept;
  void OnTimer(std::int64_t bus_ns, PendingFrames& out) noexcept;
  [[nodiscard]] std::int64_t NextTimer() const noexcept { return slave_.NextTimer(); }

  /// Plant and drive up to this instant of the drive's time.
  void AdvanceTo(std::int64_t drive_ns) noexcept;
  [[nodiscard]] std::int64_t now_ns() const noexcept { return now_ns_; }

  /// The motor is under the drive's control, or the axis still moves.
  [[nodiscard]] bool alive() const noexcept;
  void FillTruth(AxisTruth& truth) const noexcept;
  /// Fails as broken hardware would: EMCY with this code, fault reaction, Fault.
  void InjectFault(std::uint16_t error_code) noexcept { Fault(error_code, 0x20); }
  /// The drive's supply fails for a moment, whatever it is doing.
  void InterruptSupply() noexcept { slave_.Restart(); }

  // Other things that drives do unasked:
  /// Encoder and motor lie.
  [[nodiscard]] Tampering& tampering() noexcept { return tampering_; }
  /// The same of the linear scale; only what concerns an encoder matters.
  [[nodiscard]] Tampering& scale_tampering() noexcept { return scale_tampering_; }
  /// EMCY and nothing else: the drive goes on.
  void SendEmergency(std::uint16_t code, std::uint8_t register_bits) noexcept {
    slave_.Emergency(code, register_bits);
  }
  /// 0x6061 and what the drive does change; 0x6060 does not.
  void ChangeMode(std::int8_t mode) noexcept { objects_.mode_display.value = mode; }
  /// Operation Enabled is left for Switch On Disabled, the motor coasts.
  void DropOut() noexcept;
  void LeaveOperational() noexcept { slave_.LeaveOperational(); }
  /// Switched off and on: boot-up, parameters and modes as at power-on.
  void Restart(std::int64_t bus_ns) noexcept;

  [[nodiscard]] std::uint8_t node_id() const noexcept { return node_id_; }
  [[nodiscard]] AxisPlant& plant() noexcept { return plant_; }
  [[nodiscard]] const AxisPlant& plant() const noexcept { return plant_; }
  [[nodiscard]] const AxisParameters& parameters() const noexcept { return p_; }
  [[nodiscard]] const CanopenSlave& slave() const noexcept { return slave_; }
  [[nodiscard]] DriveState drive_state() const noexcept { return power_.state(); }

 private:
  /// Why the drive is braking by itself, and so what follows when the axis stands.
  enum class Braking : std::uint8_t { kNone, kQuickStop, kFaultReaction, kDisableOperation, kShutdown };

  // SlaveDevice
  [[nodiscard]] std::uint32_t CheckWrite(const ObjectEntry& entry,
                                         std::int64_t value) const noexcept override;
  void OnWritten(const ObjectEntry& entry) noexcept override;
  void OnConnectionLost(ConnectionLoss loss) noexcept override;
  void OnPowerCycle() noexcept override;

  void Integrate(std::int64_t duration_ns) noexcept;
  void Sense() noexcept;
  [[nodiscard]] std::int64_t ReadScale() noexcept;
  void Tick() noexcept;
  void StepPowerState() noexcept;
  void ApplyTarget() noexcept;
  void BeginBraking(Braking why, std::int64_t option) noexcept;
  void Brake() noexcept;
  void BrakingDone() noexcept;
  void TorqueOff() noexcept;
  void Fault(std::uint16_t error_code, std::uint8_t register_bits) noexcept;
  void FollowPosition() noexcept;
  void WatchFollowingError(double error_m) noexcept;
  void Command_Nm(double torque_Nm) noexcept;
  void UpdateActualValues() noexcept;
  [[nodiscard]] std::uint16_t Statusword() const noexcept;
  [[nodiscard]] double TorqueLimit_Nm(bool positive) const noexcept;
  [[nodiscard]] double TravelPerCount_m() const noexcept {
    return p_.radius_m_rad / encoder_.counts_per_rad();
  }
  [[nodiscard]] double InertiaForce_Nm(double acceleration_m_s2) const noexcept;
  [[nodiscard]] double InterpolationPeriod_s() const noexcept;

  AxisParameters p_;
  std::uint8_t node_id_;
  AxisPlant plant_;
  CurrentLoop current_;
  Encoder encoder_;
  DriveObjects objects_;
  Tampering tampering_;
  Tampering scale_tampering_;
  Random scale_noise_;
  Random torque_noise_;
  double tick_noise_Nm_;
  double torque_noise_now_Nm_ = 0.0;
  DriveCascade cascade_;
  TargetInterpolator target_;
  DrivePowerState power_;

  CanopenSlave slave_;

  std::int64_t now_ns_ = 0;
  std::int64_t next_tick_ns_ = 0;
  std::int64_t sensed_ns_ = -1;
  std::int64_t counts_ = 0;
  std::int64_t latched_counts_ = 0;
  std::int64_t zero_counts_ = 0;                ///< where an incremental encoder began to count
  std::array<std::int64_t, 17> past_counts_{};  ///< of the last 2 ms
  std::size_t past_ = 0;

  // Applied at a SYNC, acting after delay_cycles - 1 more and the input delay.
  CommandsOnTheWay on_the_way_;
  std::array<double, 8> delayed_targets_{};  ///< newest first
  std::array<std::int64_t, 8> delayed_positions_{};

  Braking braking_ = Braking::kNone;
  double ramp_m_s_ = 0.0;
  double ramp_rate_m_s2_ = 0.0;
  bool coasting_ = false;  ///< brake option "disable drive function"
  std::int64_t ramp_end_ns_ = -1;
  std::int64_t release_end_ns_ = -1;
  std::int64_t last_sync_ns_ = 0;
  std::int64_t beyond_window_since_ns_ = -1;
  bool limited_ = false;
  bool following_error_seen_ = false;
};

}  // namespace contour::plant
