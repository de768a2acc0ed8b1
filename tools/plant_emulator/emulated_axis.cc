#include "tools/plant_emulator/emulated_axis.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace contour::plant {
namespace {

constexpr double kTick_s = 1e-9 * static_cast<double>(EmulatedAxis::kTick_ns);
constexpr std::int64_t kNsPerMs = 1'000'000;
/// Far from the streams that the axes count up.
constexpr std::uint64_t kTorqueNoiseStream = 1'000'000;
/// Below this the drive takes the axis for standing, once its ramp has ended.
constexpr double kStandstill_m_s = 1e-3;
/// The axis stands, held against what friction has wound up: so long the drive only damps, then it lets go.
constexpr std::int64_t kRelease_ns = 28 * kNsPerMs;
/// After the ramp's end the drive lets go at the latest then, standing or not.
constexpr std::int64_t kBrakeTimeout_ns = 500 * kNsPerMs;
constexpr std::uint16_t kEmergencyFollowingError = 0x8611;
constexpr std::uint16_t kEmergencyConnection = 0x8100;

}  // namespace

EmulatedAxis::EmulatedAxis(const AxisParameters& parameters, const EmulatedAxisPlacement& placement,
                           std::uint32_t cycle_us, std::uint64_t seed, std::uint64_t stream)
    : p_(parameters),
      node_id_(placement.node_id),
      plant_(parameters),
      current_(parameters.lag_s),
      encoder_(parameters, seed, stream),
      objects_(parameters, placement, encoder_.counts_per_rad()),
      scale_noise_(seed, stream + 1),
      torque_noise_(seed, stream + kTorqueNoiseStream),
      // A mean over a cycle is one over so many ticks.
      tick_noise_Nm_(parameters.torque_noise_Nm * std::sqrt(1e-6 * cycle_us / kTick_s)),
      cascade_(parameters.cascade, kTick_s, TravelPerCount_m()),
      slave_(objects_.dictionary, *this, placement.node_id) {
  slave_.DelayAnswers(parameters.answer_delay_ns, parameters.answer_delay_every);
  Sense();
  past_counts_.fill(counts_);
  latched_counts_ = counts_;
  if (p_.incremental_encoder) zero_counts_ = counts_;
  UpdateActualValues();
}

// --- Objects
// -------------------------------------------------------------------------------------------------------

std::uint32_t EmulatedAxis::CheckWrite(const ObjectEntry& entry, std::int64_t value) const noexcept {
  switch (entry.index) {
    case 0x605A:  // 0 coast, 1..3 then Switch On Disabled, 5..7 then stay
      return (value >= 0 && value <= 3) || (value >= 5 && value <= 7) ? abort_code::kNone
                                                                      : abort_code::kInvalidValue;
    case 0x6060:
      return value == 0 || value == kModeCsp || value == kModeCst ? abort_code::kNone
                                                                  : abort_code::kInvalidValue;
    case 0x60C2:
      return entry.sub == 1 && value == 0 ? abort_code::kInvalidValue : abort_code::kNone;
    default:
      return slave_.CheckWrite(entry, value);
  }
}

void EmulatedAxis::OnWritten(const ObjectEntry& entry) noexcept {
  if (entry.index < 0x2000) slave_.OnWritten(entry);
  // Over SDO, and in an RPDO that acts at once, a controlword takes effect now; at a SYNC, StepPowerState
  // runs anyway.
  if (&entry == &objects_.controlword) StepPowerState();
  if (&entry == &objects_.mode) objects_.mode_display.value = objects_.mode.value;
}

std::uint16_t EmulatedAxis::Statusword() const noexcept {
  std::uint16_t word = power_.StatusBits() | 0x0010U | 0x0200U;  // voltage enabled, remote
  if (limited_) word |= 0x0800U;
  if (power_.state() == DriveState::kOperationEnabled && braking_ == Braking::kNone &&
      (objects_.mode_display.value == kModeCst || objects_.mode_display.value == kModeCsp))
    word |= 0x1000U;  // follows the target
  if (following_error_seen_) word |= 0x2000U;
  return word;
}

void EmulatedAxis::UpdateActualValues() noexcept {
  const auto wrap = [](std::int64_t v) {
    return static_cast<std::int64_t>(
        static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::uint64_t>(v))));
  };
  objects_.position.value = wrap(latched_counts_ - zero_counts_);
  objects_.velocity.value = wrap(std::llround(cascade_.velocity_m_s() / TravelPerCount_m()));
  const auto per_mille = [&](double torque_Nm) {
    return std::clamp<std::int64_t>(std::llround(1000.0 * torque_Nm / p_.rated_torque_Nm), -32768, 32767);
  };
  objects_.torque.value = per_mille(tampering_.reported_share() * current_.torque_Nm());
  objects_.torque_demand.value = per_mille(current_.command_Nm());
  if (objects_.scale != nullptr) objects_.scale->value = wrap(ReadScale());
  objects_.statusword.value = Statusword();
}

// --- Bus
// -----------------------------------------------------------------------------------------------------------

void EmulatedAxis::OnFrame(const CanFrame& frame, std::int64_t bus_ns, PendingFrames& out) noexcept {
  objects_.statusword.value = Statusword();  // as an SDO may ask for it
  slave_.OnFrame(frame, bus_ns, now_ns_, out);
  objects_.statusword.value = Statusword();
}

void EmulatedAxis::OnSync(std::int64_t bus_ns, PendingFrames& out) noexcept {
  Sense();
  latched_counts_ = counts_;
  UpdateActualValues();
  last_sync_ns_ = now_ns_;
  next_tick_ns_ = now_ns_;
  slave_.OnSync(bus_ns, out);
  StepPowerState();
  ApplyTarget();
  objects_.statusword.value = Statusword();
}

void EmulatedAxis::OnTimer(std::int64_t bus_ns, PendingFrames& out) noexcept { slave_.OnTimer(bus_ns, out); }

void EmulatedAxis::OnConnectionLost(ConnectionLoss /*loss*/) noexcept {
  if (power_.state() != DriveState::kOperationEnabled) return;
  switch (objects_.abort_option.value) {
    case 1:
      Fault(kEmergencyConnection, 0x10);
      return;
    case 2:
      power_.Disable();
      TorqueOff();
      return;
    case 3:
      power_.QuickStop();
      BeginBraking(Braking::kQuickStop, objects_.quick_stop_option.value);
      return;
    default:
      return;
  }
}

void EmulatedAxis::OnPowerCycle() noexcept {
  objects_.dictionary.Restore(0x6000, 0x60FF);
  power_.PowerOn();
  TorqueOff();
  objects_.error_code.value = 0;
  slave_.ClearErrors();
  if (p_.incremental_encoder) zero_counts_ = latched_counts_ = counts_;
  UpdateActualValues();
}

void EmulatedAxis::DropOut() noexcept {
  power_.Disable();
  TorqueOff();
}

void EmulatedAxis::Restart(std::int64_t bus_ns) noexcept {
  OnPowerCycle();
  slave_.Restart(bus_ns);
}

// --- Time
// ----------------------------------------------------------------------------------------------------------

void EmulatedAxis::AdvanceTo(std::int64_t drive_ns) noexcept {
  while (now_ns_ < drive_ns) {
    if (next_tick_ns_ <= now_ns_) {
      Tick();
      next_tick_ns_ = now_ns_ + kTick_ns;
    }
    while (on_the_way_.next_ns() <= now_ns_) current_.SetCommand(on_the_way_.Take_Nm());
    const std::int64_t until = std::min({drive_ns, next_tick_ns_, on_the_way_.next_ns()});
    Integrate(until - now_ns_);
    now_ns_ = until;
  }
}

void EmulatedAxis::Integrate(std::int64_t duration_ns) noexcept {
  const double duration_s = 1e-9 * static_cast<double>(duration_ns);
  const double steps = std::ceil(duration_s / plant_.MaxStep_s());
  const double step_s = duration_s / steps;
  for (int i = 0; i < static_cast<int>(steps); ++i)
    plant_.Step(step_s, tampering_.torque_share() * current_.StepMean_Nm(step_s) + torque_noise_now_Nm_);
}

void EmulatedAxis::Sense() noexcept {
  if (sensed_ns_ == now_ns_) return;
  const double ticks = static_cast<double>(now_ns_ - sensed_ns_) / static_cast<double>(kTick_ns);
  sensed_ns_ = now_ns_;
  counts_ =
      tampering_.Read(encoder_.Read(plant_.motor_angle_rad(), plant_.motor_velocity_m_s() / p_.radius_m_rad));
  cascade_.Sense(static_cast<double>(counts_) * TravelPerCount_m(), ticks);
  past_ = (past_ + 1) % past_counts_.size();
  past_counts_[past_] = counts_;
}

std::int64_t EmulatedAxis::ReadScale() noexcept {
  return scale_tampering_.Read(static_cast<std::int64_t>(
      std::floor(plant_.table_position_m() * p_.scale_counts_per_m + 0.5 + 0.3 * scale_noise_.Normal())));
}

void EmulatedAxis::Tick() noexcept {
  Sense();
  if (p_.cascade.dual_loop_Hz > 0.0 && objects_.mode_display.value == kModeCsp)
    cascade_.SenseScale(static_cast<double>(ReadScale()) / p_.scale_counts_per_m);
  if (p_.torque_noise_Nm > 0.0) {
    const bool changed = plant_.time_s() >= p_.torque_noise_change_s;
    torque_noise_now_Nm_ = tick_noise_Nm_ * (changed ? p_.torque_noise_change : 1.0) * torque_noise_.Normal();
  }
  slave_.Watch(now_ns_);
  StepPowerState();
  if (braking_ != Braking::kNone)
    Brake();
  else if (power_.state() == DriveState::kOperationEnabled && objects_.mode_display.value == kModeCsp)
    FollowPosition();
}

bool EmulatedAxis::alive() const noexcept {
  return power_.InControl() || std::fabs(plant_.motor_velocity_m_s()) > 1e-7 ||
         std::fabs(plant_.table_velocity_m_s()) > 1e-7;
}

// --- State machine
// -------------------------------------------------------------------------------------------------

void EmulatedAxis::StepPowerState() noexcept {
  if (braking_ == Braking::kDisableOperation || braking_ == Braking::kShutdown) {
    // On a ramp that was asked for, only taking the voltage away counts.
    if ((objects_.controlword.value & 0x02) != 0) return;
    power_.Disable();
    TorqueOff();
    return;
  }
  switch (power_.Step(static_cast<std::uint16_t>(objects_.controlword.value))) {
    case DrivePowerState::Action::kNone:
      return;
    case DrivePowerState::Action::kStarted:
      cascade_.Begin();
      target_.Reset(cascade_.position_m());
      delayed_targets_.fill(0.0);
      delayed_positions_.fill(counts_);
      objects_.target_position.value = objects_.position.value;
      following_error_seen_ = false;
      beyond_window_since_ns_ = -1;
      return;
    case DrivePowerState::Action::kTorqueOff:
      TorqueOff();
      return;
    case DrivePowerState::Action::kQuickStop:
      BeginBraking(Braking::kQuickStop, objects_.quick_stop_option.value);
      return;
    case DrivePowerState::Action::kDisableOperation:
      BeginBraking(Braking::kDisableOperation, objects_.disable_option.value);
      return;
    case DrivePowerState::Action::kShutdown:
      BeginBraking(Braking::kShutdown, objects_.shutdown_option.value);
      return;
    case DrivePowerState::Action::kFaultReset:
      objects_.error_code.value = 0;
      following_error_seen_ = false;
      slave_.ClearErrors();
      return;
  }
}

void EmulatedAxis::Fault(std::uint16_t error_code, std::uint8_t register_bits) noexcept {
  const DriveState before = power_.state();
  if (before == DriveState::kFault || before == DriveState::kFaultReactionActive) return;
  objects_.error_code.value = error_code;
  slave_.Emergency(error_code, register_bits);
  if (power_.Fault())
    BeginBraking(Braking::kFaultReaction, objects_.fault_option.value);
  else
    TorqueOff();
}

void EmulatedAxis::TorqueOff() noexcept {
  braking_ = Braking::kNone;
  on_the_way_.Clear();
  delayed_targets_.fill(0.0);
  limited_ = false;
  current_.SetCommand(0.0);
}

void EmulatedAxis::BeginBraking(Braking why, std::int64_t option) noexcept {
  braking_ = why;
  on_the_way_.Clear();
  delayed_targets_.fill(0.0);
  coasting_ = option == 0;
  // Options 2 and 6 brake by 0x6085, 1 and 5 by 0x6084, 3 and 7 as hard as the torque limit lets.
  const bool quick = option == 2 || option == 6;
  const bool hardest = option == 3 || option == 7;
  ramp_rate_m_s2_ = TravelPerCount_m() * static_cast<double>(quick ? objects_.quick_stop_deceleration.value
                                                                   : objects_.deceleration.value);
  ramp_m_s_ = hardest ? 0.0 : cascade_.velocity_m_s();
  ramp_end_ns_ = -1;
  release_end_ns_ = -1;
  cascade_.Begin();
  if (coasting_) BrakingDone();
}

void EmulatedAxis::Brake() noexcept {
  const double step = ramp_rate_m_s2_ * kTick_s;
  const double before = ramp_m_s_;
  ramp_m_s_ = std::fabs(before) <= step ? 0.0 : before - std::copysign(step, before);
  if (ramp_m_s_ == 0.0 && ramp_end_ns_ < 0) ramp_end_ns_ = now_ns_;
  if (release_end_ns_ >= 0) cascade_.ResetIntegral();
  const double limit = TorqueLimit_Nm(true) / InertiaForce_Nm(1.0);
  const double acceleration = cascade_.VelocityLoop_m_s2(ramp_m_s_, (ramp_m_s_ - before) / kTick_s, limit);
  Command_Nm(InertiaForce_Nm(acceleration));
  if (ramp_end_ns_ < 0) return;
  const std::int64_t oldest = past_counts_[(past_ + 1) % past_counts_.size()];
  const double window_s = kTick_s * static_cast<double>(past_counts_.size() - 1);
  const double moved_m = TravelPerCount_m() * static_cast<double>(std::abs(counts_ - oldest));
  const bool slow = moved_m <= std::max(kStandstill_m_s * window_s, 2.0 * TravelPerCount_m());
  const bool settled = now_ns_ - ramp_end_ns_ >= 2 * kNsPerMs;
  const bool holds = braking_ == Braking::kQuickStop && objects_.quick_stop_option.value >= 5;
  if (slow && settled && release_end_ns_ < 0 && !holds) release_end_ns_ = now_ns_ + kRelease_ns;
  const bool released = release_end_ns_ >= 0 && now_ns_ >= release_end_ns_;
  if (released || now_ns_ - ramp_end_ns_ >= kBrakeTimeout_ns) BrakingDone();
}

void EmulatedAxis::BrakingDone() noexcept {
  const Braking why = braking_;
  const bool stays = why == Braking::kQuickStop && objects_.quick_stop_option.value >= 5;
  if (stays) return;  // Quick Stop Active, holding zero speed until the voltage is disabled
  TorqueOff();
  switch (why) {
    case Braking::kQuickStop:
      power_.Disable();
      return;
    case Braking::kFaultReaction:
      power_.FaultReactionDone();
      return;
    case Braking::kDisableOperation:
      power_.LeftOperation(DriveState::kSwitchedOn);
      return;
    case Braking::kShutdown:
      power_.LeftOperation(DriveState::kReadyToSwitchOn);
      return;
    case Braking::kNone:
      return;
  }
}

// --- Motion
// --------------------------------------------------------------------------------------------------------

double EmulatedAxis::InertiaForce_Nm(double acceleration_m_s2) const noexcept {
  const double mass = p_.motor_inertia_kgm2 / (p_.radius_m_rad * p_.radius_m_rad) + p_.table_mass_kg +
                      p_.counterbalance_mass_kg;
  return mass * acceleration_m_s2 * p_.radius_m_rad;
}

double EmulatedAxis::InterpolationPeriod_s() const noexcept {
  double period_s = static_cast<double>(objects_.interpolation_value.value);
  for (std::int64_t e = objects_.interpolation_exponent.value; e < 0; ++e) period_s *= 0.1;
  return period_s;
}

double EmulatedAxis::TorqueLimit_Nm(bool positive) const noexcept {
  const std::int64_t side = (positive ? objects_.max_torque_plus : objects_.max_torque_minus).value;
  return 1e-3 * static_cast<double>(std::min(objects_.max_torque.value, side)) * p_.rated_torque_Nm;
}

void EmulatedAxis::Command_Nm(double torque_Nm) noexcept {
  const double held = std::clamp(torque_Nm, -TorqueLimit_Nm(false), TorqueLimit_Nm(true));
  limited_ = held != torque_Nm;
  if (p_.delay_ns == 0 || !on_the_way_.Add(held, now_ns_ + p_.delay_ns)) current_.SetCommand(held);
}

void EmulatedAxis::ApplyTarget() noexcept {
  if (power_.state() != DriveState::kOperationEnabled || braking_ != Braking::kNone) return;
  const auto cycles = static_cast<std::size_t>(p_.delay_cycles - 1);
  for (std::size_t i = delayed_targets_.size() - 1; i > 0; --i) {
    delayed_targets_[i] = delayed_targets_[i - 1];
    delayed_positions_[i] = delayed_positions_[i - 1];
  }
  const double per_mille = static_cast<double>(objects_.target_torque.value + objects_.torque_offset.value);
  delayed_targets_[0] = 1e-3 * per_mille * p_.rated_torque_Nm + tampering_.pushed_Nm();
  if (objects_.mode_display.value == kModeCst) {
    Command_Nm(delayed_targets_[cycles]);
    return;
  }
  if (objects_.mode_display.value != kModeCsp) {
    Command_Nm(0.0);
    return;
  }
  // The target is a wrapped count: the one nearest to where the axis is.
  const auto step = static_cast<std::int32_t>(
      static_cast<std::uint32_t>(objects_.target_position.value) -
      static_cast<std::uint32_t>(static_cast<std::uint64_t>(counts_ - zero_counts_)));
  delayed_positions_[0] = counts_ + step;
  target_.Push(static_cast<double>(delayed_positions_[cycles]) * TravelPerCount_m());
}

void EmulatedAxis::FollowPosition() noexcept {
  const double period_s = InterpolationPeriod_s();
  const double u = 1e-9 * static_cast<double>(now_ns_ - last_sync_ns_) / period_s;
  CascadeTarget target = target_.At(u, period_s);
  target.velocity_m_s += static_cast<double>(objects_.velocity_offset.value) * TravelPerCount_m();
  const double offset_Nm = 1e-3 * static_cast<double>(objects_.torque_offset.value) * p_.rated_torque_Nm;
  const double limit = TorqueLimit_Nm(true) / InertiaForce_Nm(1.0);
  Command_Nm(InertiaForce_Nm(cascade_.PositionLoop_m_s2(target, limit)) + offset_Nm);
  const double error_m = target.position_m - cascade_.controlled_position_m();
  objects_.following_error.value =
      std::clamp<std::int64_t>(std::llround(error_m / TravelPerCount_m()), -2147483648LL, 2147483647LL);
  WatchFollowingError(error_m);
}

void EmulatedAxis::WatchFollowingError(double error_m) noexcept {
  const double window_m = static_cast<double>(objects_.window.value) * TravelPerCount_m();
  if (objects_.window.value == 4294967295 || std::fabs(error_m) <= window_m) {
    beyond_window_since_ns_ = -1;
    return;
  }
  if (beyond_window_since_ns_ < 0) beyond_window_since_ns_ = now_ns_;
  if (now_ns_ - beyond_window_since_ns_ < objects_.window_timeout.value * kNsPerMs) return;
  following_error_seen_ = true;
  Fault(kEmergencyFollowingError, 0x20);
}

void EmulatedAxis::FillTruth(AxisTruth& truth) const noexcept {
  truth.motor_position_m = plant_.motor_position_m();
  truth.motor_velocity_m_s = plant_.motor_velocity_m_s();
  truth.table_position_m = plant_.table_position_m();
  truth.table_velocity_m_s = plant_.table_velocity_m_s();
  truth.friction_N = plant_.friction_N();
  truth.bristle_N = plant_.elastic_N();
  truth.torque_Nm = plant_.DeliveredTorque_Nm(tampering_.torque_share() * current_.torque_Nm());
  truth.command_Nm = current_.command_Nm();
  truth.reported_position_rad = encoder_.ToRad(latched_counts_ - zero_counts_);
  truth.encoder_zero_m = static_cast<double>(zero_counts_) * TravelPerCount_m();
  truth.temperature_degC = plant_.temperature_degC();
  truth.drive_state = power_.state();
}

}  // namespace contour::plant
