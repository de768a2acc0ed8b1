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
constexpr std::int8_t kModeCsp = 8;
constexpr std::int8_t kModeCst = 10;
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
      scale_noise_(seed, stream + 1),
      torque_noise_(seed, stream + kTorqueNoiseStream),
      // A mean over a cycle is one over so many ticks.
      tick_noise_Nm_(parameters.torque_noise_Nm * std::sqrt(1e-6 * cycle_us / kTick_s)),
      cascade_(parameters.cascade, kTick_s, TravelPerCount_m()),
      slave_((AddObjects(placement), objects_), *this, placement.node_id) {
  FindObjects();
  slave_.DelayAnswers(parameters.answer_delay_ns, parameters.answer_delay_every);
  Sense();
  past_counts_.fill(counts_);
  latched_counts_ = counts_;
  if (p_.incremental_encoder) zero_counts_ = counts_;
  UpdateActualValues();
}

void EmulatedAxis::AddObjects(const EmulatedAxisPlacement& placement) {
  using enum ObjectType;
  using enum ObjectAccess;
  using enum ObjectMapping;
  CanopenSlave::AddObjects(
      objects_, placement.node_id,
      {placement.vendor_id, placement.product_code, placement.revision, placement.serial});
  ObjectDictionary& o = objects_;
  const auto peak =
      std::min<std::int64_t>(32767, std::llround(1000.0 * p_.peak_torque_Nm / p_.rated_torque_Nm));
  const double counts_per_m = encoder_.counts_per_rad() / p_.radius_m_rad;
  const auto acceleration = [&](double m_s2) {
    return std::clamp<std::int64_t>(std::llround(m_s2 * counts_per_m), 1, 4294967295);
  };
  o.Add(0x6007, 0, kI16, kReadWrite, 1);
  o.Limit(0x6007, 0, 0, 3);
  o.Add(0x603F, 0, kU16, kReadOnly, 0, kTpdo);
  o.Add(0x6040, 0, kU16, kReadWrite, 0, kRpdo);
  o.Add(0x6041, 0, kU16, kReadOnly, 0, kTpdo);
  o.Add(0x605A, 0, kI16, kReadWrite, 2);
  o.Add(0x605B, 0, kI16, kReadWrite, 0);
  o.Limit(0x605B, 0, 0, 1);
  o.Add(0x605C, 0, kI16, kReadWrite, 1);
  o.Limit(0x605C, 0, 0, 1);
  o.Add(0x605D, 0, kI16, kReadWrite, 1);
  o.Limit(0x605D, 0, 1, 1);
  o.Add(0x605E, 0, kI16, kReadWrite, 2);
  o.Limit(0x605E, 0, 0, 2);
  o.Add(0x6060, 0, kI8, kReadWrite, 0, kRpdo);
  o.Add(0x6061, 0, kI8, kReadOnly, 0, kTpdo);
  o.Add(0x6064, 0, kI32, kReadOnly, 0, kTpdo);
  o.Add(0x6065, 0, kU32, kReadWrite, 4294967295);
  o.Add(0x6066, 0, kU16, kReadWrite, 0);
  o.Add(0x606C, 0, kI32, kReadOnly, 0, kTpdo);
  o.Add(0x6071, 0, kI16, kReadWrite, 0, kRpdo);
  o.Add(0x6072, 0, kU16, kReadWrite, peak, kRpdo);
  o.Limit(0x6072, 0, 0, peak);
  o.Add(0x6074, 0, kI16, kReadOnly, 0, kTpdo);
  o.Add(0x6076, 0, kU32, kReadOnly, std::llround(1000.0 * p_.rated_torque_Nm));
  o.Add(0x6077, 0, kI16, kReadOnly, 0, kTpdo);
  o.Add(0x607A, 0, kI32, kReadWrite, 0, kRpdo);
  o.Add(0x607E, 0, kU8, kReadWrite, 0);
  o.Limit(0x607E, 0, 0, 0);  // this drive cannot turn its axis round
  o.Add(0x6084, 0, kU32, kReadWrite, acceleration(2.0));
  o.Limit(0x6084, 0, 1, 4294967295);
  o.Add(0x6085, 0, kU32, kReadWrite, acceleration(5.0));
  o.Limit(0x6085, 0, 1, 4294967295);
  o.Add(0x608F, 0, kU8, kReadOnly, 2);
  o.Add(0x608F, 1, kU32, kReadOnly, std::llround(p_.encoder_counts_per_rev));
  o.Add(0x608F, 2, kU32, kReadOnly, 1);
  o.Add(0x6091, 0, kU8, kReadOnly, 2);
  o.Add(0x6091, 1, kU32, kReadOnly, 1);
  o.Add(0x6091, 2, kU32, kReadOnly, 1);
  o.Add(0x60B1, 0, kI32, kReadWrite, 0, kRpdo);
  o.Add(0x60B2, 0, kI16, kReadWrite, 0, kRpdo);
  o.Add(0x60C2, 0, kU8, kReadOnly, 2);
  o.Add(0x60C2, 1, kU8, kReadWrite, 1);
  o.Add(0x60C2, 2, kI8, kReadWrite, -3);
  o.Limit(0x60C2, 2, -6, 0);
  o.Add(0x60E0, 0, kU16, kReadWrite, peak, kRpdo);
  o.Limit(0x60E0, 0, 0, peak);
  o.Add(0x60E1, 0, kU16, kReadWrite, peak, kRpdo);
  o.Limit(0x60E1, 0, 0, peak);
  if (p_.scale_counts_per_m > 0.0) {
    o.Add(0x60E4, 0, kU8, kReadOnly, 1);
    o.Add(0x60E4, 1, kI32, kReadOnly, 0, kTpdo);
  }
  o.Add(0x60F4, 0, kI32, kReadOnly, 0, kTpdo);
  o.Add(0x6502, 0, kU32, kReadOnly, 1 << (kModeCsp - 1) | (p_.torque_mode ? 1 << (kModeCst - 1) : 0));
  o.Seal();
}

void EmulatedAxis::FindObjects() {
  controlword_ = &objects_.At(0x6040);
  statusword_ = &objects_.At(0x6041);
  error_code_ = &objects_.At(0x603F);
  quick_stop_option_ = &objects_.At(0x605A);
  shutdown_option_ = &objects_.At(0x605B);
  disable_option_ = &objects_.At(0x605C);
  fault_option_ = &objects_.At(0x605E);
  abort_option_ = &objects_.At(0x6007);
  mode_ = &objects_.At(0x6060);
  mode_display_ = &objects_.At(0x6061);
  position_ = &objects_.At(0x6064);
  velocity_ = &objects_.At(0x606C);
  torque_ = &objects_.At(0x6077);
  torque_demand_ = &objects_.At(0x6074);
  target_torque_ = &objects_.At(0x6071);
  torque_offset_ = &objects_.At(0x60B2);
  velocity_offset_ = &objects_.At(0x60B1);
  target_position_ = &objects_.At(0x607A);
  max_torque_ = &objects_.At(0x6072);
  max_torque_plus_ = &objects_.At(0x60E0);
  max_torque_minus_ = &objects_.At(0x60E1);
  window_ = &objects_.At(0x6065);
  window_timeout_ = &objects_.At(0x6066);
  following_error_ = &objects_.At(0x60F4);
  deceleration_ = &objects_.At(0x6084);
  quick_stop_deceleration_ = &objects_.At(0x6085);
  interpolation_value_ = &objects_.At(0x60C2, 1);
  interpolation_exponent_ = &objects_.At(0x60C2, 2);
  scale_ = objects_.Find(0x60E4, 1);
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
  if (&entry == controlword_) StepPowerState();
  if (&entry == mode_) mode_display_->value = mode_->value;
}

std::uint16_t EmulatedAxis::Statusword() const noexcept {
  std::uint16_t word = power_.StatusBits() | 0x0010U | 0x0200U;  // voltage enabled, remote
  if (limited_) word |= 0x0800U;
  if (power_.state() == DriveState::kOperationEnabled && braking_ == Braking::kNone &&
      (mode_display_->value == kModeCst || mode_display_->value == kModeCsp))
    word |= 0x1000U;  // follows the target
  if (following_error_seen_) word |= 0x2000U;
  return word;
}

void EmulatedAxis::UpdateActualValues() noexcept {
  const auto wrap = [](std::int64_t v) {
    return static_cast<std::int64_t>(
        static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::uint64_t>(v))));
  };
  position_->value = wrap(latched_counts_ - zero_counts_);
  velocity_->value = wrap(std::llround(cascade_.velocity_m_s() / TravelPerCount_m()));
  const auto per_mille = [&](double torque_Nm) {
    return std::clamp<std::int64_t>(std::llround(1000.0 * torque_Nm / p_.rated_torque_Nm), -32768, 32767);
  };
  torque_->value = per_mille(tampering_.reported_share() * current_.torque_Nm());
  torque_demand_->value = per_mille(current_.command_Nm());
  if (scale_ != nullptr) scale_->value = wrap(ReadScale());
  statusword_->value = Statusword();
}

// --- Bus
// -----------------------------------------------------------------------------------------------------------

void EmulatedAxis::OnFrame(const CanFrame& frame, std::int64_t bus_ns, PendingFrames& out) noexcept {
  statusword_->value = Statusword();  // as an SDO may ask for it
  slave_.OnFrame(frame, bus_ns, now_ns_, out);
  statusword_->value = Statusword();
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
  statusword_->value = Statusword();
}

void EmulatedAxis::OnTimer(std::int64_t bus_ns, PendingFrames& out) noexcept { slave_.OnTimer(bus_ns, out); }

void EmulatedAxis::OnConnectionLost(ConnectionLoss /*loss*/) noexcept {
  if (power_.state() != DriveState::kOperationEnabled) return;
  switch (abort_option_->value) {
    case 1:
      Fault(kEmergencyConnection, 0x10);
      return;
    case 2:
      power_.Disable();
      TorqueOff();
      return;
    case 3:
      power_.QuickStop();
      BeginBraking(Braking::kQuickStop, quick_stop_option_->value);
      return;
    default:
      return;
  }
}

void EmulatedAxis::OnPowerCycle() noexcept {
  objects_.Restore(0x6000, 0x60FF);
  power_.PowerOn();
  TorqueOff();
  error_code_->value = 0;
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
    while (on_the_way_count_ > 0 && on_the_way_[first_on_the_way_].at_ns <= now_ns_) {
      current_.SetCommand(on_the_way_[first_on_the_way_].torque_Nm);
      first_on_the_way_ = (first_on_the_way_ + 1) % on_the_way_.size();
      --on_the_way_count_;
    }
    std::int64_t until = std::min(drive_ns, next_tick_ns_);
    if (on_the_way_count_ > 0) until = std::min(until, on_the_way_[first_on_the_way_].at_ns);
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
  if (p_.cascade.dual_loop_Hz > 0.0 && mode_display_->value == kModeCsp)
    cascade_.SenseScale(static_cast<double>(ReadScale()) / p_.scale_counts_per_m);
  if (p_.torque_noise_Nm > 0.0) {
    const bool changed = plant_.time_s() >= p_.torque_noise_change_s;
    torque_noise_now_Nm_ = tick_noise_Nm_ * (changed ? p_.torque_noise_change : 1.0) * torque_noise_.Normal();
  }
  slave_.Watch(now_ns_);
  StepPowerState();
  if (braking_ != Braking::kNone)
    Brake();
  else if (power_.state() == DriveState::kOperationEnabled && mode_display_->value == kModeCsp)
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
    if ((controlword_->value & 0x02) != 0) return;
    power_.Disable();
    TorqueOff();
    return;
  }
  switch (power_.Step(static_cast<std::uint16_t>(controlword_->value))) {
    case DrivePowerState::Action::kNone:
      return;
    case DrivePowerState::Action::kStarted:
      cascade_.Begin();
      target_.Reset(cascade_.position_m());
      delayed_targets_.fill(0.0);
      delayed_positions_.fill(counts_);
      target_position_->value = position_->value;
      following_error_seen_ = false;
      beyond_window_since_ns_ = -1;
      return;
    case DrivePowerState::Action::kTorqueOff:
      TorqueOff();
      return;
    case DrivePowerState::Action::kQuickStop:
      BeginBraking(Braking::kQuickStop, quick_stop_option_->value);
      return;
    case DrivePowerState::Action::kDisableOperation:
      BeginBraking(Braking::kDisableOperation, disable_option_->value);
      return;
    case DrivePowerState::Action::kShutdown:
      BeginBraking(Braking::kShutdown, shutdown_option_->value);
      return;
    case DrivePowerState::Action::kFaultReset:
      error_code_->value = 0;
      following_error_seen_ = false;
      slave_.ClearErrors();
      return;
  }
}

void EmulatedAxis::Fault(std::uint16_t error_code, std::uint8_t register_bits) noexcept {
  const DriveState before = power_.state();
  if (before == DriveState::kFault || before == DriveState::kFaultReactionActive) return;
  error_code_->value = error_code;
  slave_.Emergency(error_code, register_bits);
  if (power_.Fault())
    BeginBraking(Braking::kFaultReaction, fault_option_->value);
  else
    TorqueOff();
}

void EmulatedAxis::TorqueOff() noexcept {
  braking_ = Braking::kNone;
  on_the_way_count_ = 0;
  delayed_targets_.fill(0.0);
  limited_ = false;
  current_.SetCommand(0.0);
}

void EmulatedAxis::BeginBraking(Braking why, std::int64_t option) noexcept {
  braking_ = why;
  on_the_way_count_ = 0;
  delayed_targets_.fill(0.0);
  coasting_ = option == 0;
  // Options 2 and 6 brake by 0x6085, 1 and 5 by 0x6084, 3 and 7 as hard as the torque limit lets.
  const bool quick = option == 2 || option == 6;
  const bool hardest = option == 3 || option == 7;
  ramp_rate_m_s2_ = TravelPerCount_m() *
                    static_cast<double>(quick ? quick_stop_deceleration_->value : deceleration_->value);
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
  const bool holds = braking_ == Braking::kQuickStop && quick_stop_option_->value >= 5;
  if (slow && settled && release_end_ns_ < 0 && !holds) release_end_ns_ = now_ns_ + kRelease_ns;
  const bool released = release_end_ns_ >= 0 && now_ns_ >= release_end_ns_;
  if (released || now_ns_ - ramp_end_ns_ >= kBrakeTimeout_ns) BrakingDone();
}

void EmulatedAxis::BrakingDone() noexcept {
  const Braking why = braking_;
  const bool stays = why == Braking::kQuickStop && quick_stop_option_->value >= 5;
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
  double period_s = static_cast<double>(interpolation_value_->value);
  for (std::int64_t e = interpolation_exponent_->value; e < 0; ++e) period_s *= 0.1;
  return period_s;
}

double EmulatedAxis::TorqueLimit_Nm(bool positive) const noexcept {
  const std::int64_t side = (positive ? max_torque_plus_ : max_torque_minus_)->value;
  return 1e-3 * static_cast<double>(std::min(max_torque_->value, side)) * p_.rated_torque_Nm;
}

void EmulatedAxis::Command_Nm(double torque_Nm) noexcept {
  const double held = std::clamp(torque_Nm, -TorqueLimit_Nm(false), TorqueLimit_Nm(true));
  limited_ = held != torque_Nm;
  if (p_.delay_ns == 0 || on_the_way_count_ == on_the_way_.size()) {
    current_.SetCommand(held);
    return;
  }
  on_the_way_[(first_on_the_way_ + on_the_way_count_) % on_the_way_.size()] = {held, now_ns_ + p_.delay_ns};
  ++on_the_way_count_;
}

void EmulatedAxis::ApplyTarget() noexcept {
  if (power_.state() != DriveState::kOperationEnabled || braking_ != Braking::kNone) return;
  const auto cycles = static_cast<std::size_t>(p_.delay_cycles - 1);
  for (std::size_t i = delayed_targets_.size() - 1; i > 0; --i) {
    delayed_targets_[i] = delayed_targets_[i - 1];
    delayed_positions_[i] = delayed_positions_[i - 1];
  }
  const double per_mille = static_cast<double>(target_torque_->value + torque_offset_->value);
  delayed_targets_[0] = 1e-3 * per_mille * p_.rated_torque_Nm + tampering_.pushed_Nm();
  if (mode_display_->value == kModeCst) {
    Command_Nm(delayed_targets_[cycles]);
    return;
  }
  if (mode_display_->value != kModeCsp) {
    Command_Nm(0.0);
    return;
  }
  // The target is a wrapped count: the one nearest to where the axis is.
  const auto step = static_cast<std::int32_t>(
      static_cast<std::uint32_t>(target_position_->value) -
      static_cast<std::uint32_t>(static_cast<std::uint64_t>(counts_ - zero_counts_)));
  delayed_positions_[0] = counts_ + step;
  target_.Push(static_cast<double>(delayed_positions_[cycles]) * TravelPerCount_m());
}

void EmulatedAxis::FollowPosition() noexcept {
  const double period_s = InterpolationPeriod_s();
  const double u = 1e-9 * static_cast<double>(now_ns_ - last_sync_ns_) / period_s;
  CascadeTarget target = target_.At(u, period_s);
  target.velocity_m_s += static_cast<double>(velocity_offset_->value) * TravelPerCount_m();
  const double offset_Nm = 1e-3 * static_cast<double>(torque_offset_->value) * p_.rated_torque_Nm;
  const double limit = TorqueLimit_Nm(true) / InertiaForce_Nm(1.0);
  Command_Nm(InertiaForce_Nm(cascade_.PositionLoop_m_s2(target, limit)) + offset_Nm);
  const double error_m = target.position_m - cascade_.controlled_position_m();
  following_error_->value =
      std::clamp<std::int64_t>(std::llround(error_m / TravelPerCount_m()), -2147483648LL, 2147483647LL);
  WatchFollowingError(error_m);
}

void EmulatedAxis::WatchFollowingError(double error_m) noexcept {
  const double window_m = static_cast<double>(window_->value) * TravelPerCount_m();
  if (window_->value == 4294967295 || std::fabs(error_m) <= window_m) {
    beyond_window_since_ns_ = -1;
    return;
  }
  if (beyond_window_since_ns_ < 0) beyond_window_since_ns_ = now_ns_;
  if (now_ns_ - beyond_window_since_ns_ < window_timeout_->value * kNsPerMs) return;
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
  truth.temperature_degC = plant_.temperature_degC();
  truth.drive_state = power_.state();
}

}  // namespace contour::plant
