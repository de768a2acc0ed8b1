#include "daemon/rt/self_watch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "control/loop_bandwidth.h"
#include "daemon/rt/cycle_parts.h"

namespace contour {
namespace {

// A loop oscillates near its own bandwidth, at the slowest when friction has hold of it; in motion the path
// has its say below a quarter of it.
constexpr double kSlowestOfBandwidth = 1.0 / 16.0;
constexpr double kSlowestMovingOfBandwidth = 1.0 / 4.0;
// The model's stiffness may be wrong by as much.
constexpr double kModeMargin = 1.2;
// Two counts and one step of torque are moved through at rest by rounding alone; twice that is more than
// rounding.
constexpr double kRoundingCounts = 2.0;
constexpr double kBeyondRounding = 2.0;
constexpr double kFewestCyclesPerPeriod = 4.0;
// Of the torque limit that a filter's model may be off by, for a period: rivals ride corners at full feed
// with a mass, a delay or friction that is not stated, and keep the path.
constexpr double kUnmodelled = 0.5;
// Of all the torque there is, from limit to limit: what is left is for the path and what comes from outside,
// and a swing that takes so much of it leaves no margin for either.
constexpr double kViolentShare = 0.25;
// Of the following error that is a fault.
constexpr double kDangerousShare = 0.125;

// What a force of that share moves the axis in one period.
double ExplainedInnovation_m(const CycleConfig& config, std::size_t axis) {
  const CycleAxisConfig& a = config.axes[axis];
  const double force_N = kUnmodelled * a.limits.torque_Nm / a.mechanics.radius_m_rad;
  const double period_s = config.cycle_us * 1e-6;
  return 0.5 * force_N / a.mechanics.mass_kg * period_s * period_s;
}

// For so long in a row; 0 stays 0: not watched.
std::int32_t InARowFor(const CycleConfig& config, double time_ms) {
  if (!(time_ms > 0.0)) return 0;
  return std::max(static_cast<std::int32_t>(std::lround(time_ms * 1e3 / config.cycle_us)), 1);
}

std::uint32_t Cycles(const CycleConfig& config, double time_s) {
  return static_cast<std::uint32_t>(time_s * 1e6 / config.cycle_us) + 1;
}

}  // namespace

OscillationBounds OscillationBoundsFor(const CycleConfig& config, std::size_t axis) {
  const CycleAxisConfig& a = config.axes[axis];
  const Mechanics& m = a.mechanics;
  const Friction f = ToSi(a.friction, m.radius_m_rad);
  const double torque_step_N = kTorqueStep * config.master.axes[axis].drive.rated_torque_Nm / m.radius_m_rad;
  const double count_m = 2.0 * std::numbers::pi * m.radius_m_rad / a.encoder_counts_per_rev;
  const double motor_kg = m.mass_kg - m.table_mass_kg;
  const double mode_Hz =
      std::sqrt(m.stiffness_N_m * (1.0 / motor_kg + 1.0 / m.table_mass_kg)) / (2.0 * std::numbers::pi);
  OscillationBounds b;
  b.period_s = config.cycle_us * 1e-6;
  b.low_Hz = kSlowestOfBandwidth * DesignedLoop_Hz(config);
  b.low_moving_Hz = kSlowestMovingOfBandwidth * DesignedLoop_Hz(config);
  b.high_Hz = std::min(kModeMargin * mode_Hz, 1.0 / (kFewestCyclesPerPeriod * b.period_s));
  b.swing_m = kBeyondRounding * (kRoundingCounts * count_m + torque_step_N / f.sigma0_N_m);
  b.swing_N = kBeyondRounding * torque_step_N;
  b.swing_moving_N = 2.0 * std::max(f.Fs_plus_N, f.Fs_minus_N);
  const double limits_N = 2.0 * a.limits.torque_Nm / m.radius_m_rad;
  b.violent_N = std::max(b.swing_moving_N, kViolentShare * limits_N);
  b.answered = a.peak_late;
  b.mass_kg = m.mass_kg;
  b.growing_m = kDangerousShare * a.limits.following_error_mm * 1e-3;
  b.half_waves = config.control.supervision.half_waves;
  // Its regulator answers fast enough to swing from cycle to cycle; rivals' swings are slower.
  if (KnowsTwoInertias(config) && !InCascade(config)) b.chatter_N = b.swing_moving_N;
  return b;
}

SelfWatch::SelfWatch(const CycleConfig& config)
    : ladder_(Cycles(config, config.control.supervision.step_s),
              Cycles(config, config.control.supervision.quiet_s)),
      late_(InARowFor(config, config.control.supervision.late_ms)) {
  const SupervisionConfig& s = config.control.supervision;
  const EstimatorKind kind = EstimatorFor(config);
  in_cascade_ = InCascade(config);
  friction_filter_ = kind != EstimatorKind::kKinematic && kind != EstimatorKind::kDisturbanceObserver;
  for (std::size_t i = 0; i < config.axes.size(); ++i) {
    oscillation_.push_back(OscillationDetector(OscillationBoundsFor(config, i)));
    innovation_.push_back(InnovationWatch({s.innovation_sigma, ExplainedInnovation_m(config, i),
                                           s.innovation_samples, InARowFor(config, s.gated_ms)}));
    capped_.push_back(InARow(InARowFor(config, s.solver_cap_ms)));
  }
}

void SelfWatch::Reset() noexcept {
  if (clean_) return;
  ladder_.Reset();
  for (OscillationDetector& o : oscillation_) o.Reset();
  for (InnovationWatch& w : innovation_) w.Reset();
  for (InARow& c : capped_) c.Reset();
  late_.Reset();
  alarm_ = growing_ = {};
  violent_ = false;
  clean_ = true;
}

// The first of a cycle, unless another one is violent: a stop for that has its reason and its axis.
void SelfWatch::Raise(Reason alarm, std::size_t axis, bool violent) noexcept {
  if (alarm_.reason != Reason::kNone && (violent_ || !violent)) return;
  alarm_ = {alarm, static_cast<std::uint8_t>(axis)};
  violent_ = violent;
}

void SelfWatch::Look(std::size_t axis, const Seen& seen) noexcept {
  clean_ = false;
  if (capped_[axis].Step(seen.capped)) Raise(Reason::kSolverCapLasting, axis);
  if (!seen.feedback.fresh) return;
  const ReferencePoint& r = seen.reference;
  switch (
      oscillation_[axis].Step({r.position_m - seen.position_m, seen.feedback.torque_Nm / seen.radius_m_rad,
                               r.velocity_m_s, r.acceleration_m_s2, r.extra_torque_Nm / seen.radius_m_rad})) {
    case Oscillation::kGrowing:
      growing_ = {Reason::kOscillation, static_cast<std::uint8_t>(axis)};
      break;
    case Oscillation::kLasting:
      // Of a drive's own loop nothing is stopped; see Stop.
      Raise(Reason::kOscillation, axis, !in_cascade_ && oscillation_[axis].violent());
      break;
    case Oscillation::kNone:
      break;
  }
  const AxisEstimate& e = seen.estimate;
  const bool gated = e.limit == Reason::kInnovationGated;
  // The observer's noise is a bandwidth, not a statement: only what it does not believe counts.
  const bool stated = friction_filter_ && ladder_.step() < SupervisionStep::kFallenBack;
  if (innovation_[axis].Step(stated ? e.innovation_m : 0.0, e.innovation_std_m, gated))
    Raise(Reason::kEstimatorInconsistent, axis);
}

void SelfWatch::EndCycle(bool late) noexcept {
  if (late_.Step(late)) Raise(Reason::kCyclesLate, 0xFF);
  const SupervisionStep before = ladder_.step();
  ladder_.Step(alarm_.reason, alarm_.where, violent_);
  // What the filter said of itself says nothing of the observer that has taken its place.
  if (ladder_.step() == SupervisionStep::kFallenBack && before == SupervisionStep::kSoftened)
    for (InnovationWatch& w : innovation_) w.Reset();
  alarm_ = {};
  violent_ = false;
}

Softness SelfWatch::softness() const noexcept {
  if (ladder_.step() < SupervisionStep::kSoftened) return Softness::kNone;
  return ladder_.step() == SupervisionStep::kSoftened ? Softness::kSofter : Softness::kWithout;
}

FaultSeen SelfWatch::Stop() const noexcept {
  if (ladder_.step() != SupervisionStep::kStopped) return {};
  // A drive's own loop is not ours to soften: what does not grow is told, not stopped.
  if (in_cascade_ && ladder_.reason() == Reason::kOscillation) return {};
  return {ladder_.reason(), ladder_.where()};
}

Reason SelfWatch::Limit(std::size_t axis) const noexcept {
  switch (ladder_.step()) {
    case SupervisionStep::kNone:
      return Reason::kNone;
    case SupervisionStep::kNoticed:
      break;
    case SupervisionStep::kSoftened:
      return Reason::kSoftened;
    case SupervisionStep::kFallenBack:
    case SupervisionStep::kStopped:
      return Reason::kFallenBack;
  }
  if (ladder_.where() != axis) return Reason::kNone;
  if (ladder_.reason() == Reason::kOscillation) return Reason::kOscillationNoticed;
  if (ladder_.reason() == Reason::kEstimatorInconsistent) return Reason::kInnovationGated;
  return ladder_.reason() == Reason::kSolverCapLasting ? Reason::kSolverCap : Reason::kNone;
}

}  // namespace contour
