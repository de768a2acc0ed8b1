#include "estimator/two_inertia_observer.h"

#include <algorithm>
#include <cmath>

namespace contour {
namespace {

// Beyond these there is no axis: m, m/s, N.
constexpr LoopMotion kLargest{1e2, 1e2, 1e2, 1e2, 1e7};
constexpr std::uint32_t kMostUnseen = 1000;
// Readings for which it is remembered that one came after several periods.
constexpr std::uint32_t kRemembered = 20;
// Share of what was believed that a reading leaves.
constexpr double kMemory = 0.6;

}  // namespace

LoopMotion MotionFromMotorForce(TwoInertiaAxis axis, double period_s) {
  axis.lag_s = axis.dead_time_s = 0.0;
  axis.delay_cycles = 0;
  LoopMotion motion = LoopMotionOf(axis, period_s).motion_from_input[0];
  motion[4] = 0.0;
  return motion;
}

TwoInertiaObserver::TwoInertiaObserver(const Setup& setup)
    : loop_(setup.loop),
      scale_gain_(setup.scale_loop ? setup.scale_loop->gain : Gain{}),
      stiffness_N_m_(setup.axis.stiffness_N_m),
      mass_kg_(setup.axis.motor_mass_kg + setup.axis.table_mass_kg),
      motion_from_motor_force_(MotionFromMotorForce(setup.axis, setup.period_s)),
      period_s_(setup.period_s),
      gate_(setup.gate, setup.sudden_m) {
  // The gain is (S - R) / S of the position, S the innovation's variance.
  const double left = std::max(1.0 - loop_.gain[0][0], 1e-6);
  innovation_std_m_ = setup.measurement_std_m / std::sqrt(left);
  const double both = 1.0 - scale_gain_[0][0] - scale_gain_[kObserverBias][0];
  scale_innovation_std_m_ = setup.measurement_std_m / std::sqrt(std::max(both, 1e-6));
}

void TwoInertiaObserver::Reset(double position_m) noexcept { Reset(position_m, position_m); }

void TwoInertiaObserver::Reset(double position_m, double table_m) noexcept {
  motion_ = {table_m, 0.0, table_m, 0.0, 0.0};
  beyond_m_ = position_m - table_m;
  disturbance_N_ = 0.0;
  gated_in_a_row_ = 0;
  unseen_periods_ = seldom_readings_ = again_readings_ = 0;
  gate_.Reset();
}

void TwoInertiaObserver::GoOnByMotor(double position_m, double screw_N, double disturbance_N) noexcept {
  motion_ = {position_m, motion_[1], position_m - screw_N / stiffness_N_m_, motion_[1], motion_[4]};
  beyond_m_ = 0.0;
  disturbance_N_ = disturbance_N;
}

LoopMotion TwoInertiaObserver::Ahead(const PeriodForces& f) const noexcept {
  LoopMotion next;
  // Positions are large beside what moves them: counted from the motor.
  const double from_m = motion_[0];
  const LoopMotion here{0.0, motion_[1], motion_[2] - from_m, motion_[3], motion_[4]};
  for (std::size_t i = 0; i < kLoopMotion; ++i) {
    double sum = loop_.motion_from_input[0][i] * f.input_N[0] + loop_.motion_from_input[1][i] * f.input_N[1] +
                 loop_.motion_from_disturbance[i] * (f.table_N + disturbance_N_) +
                 motion_from_motor_force_[i] * f.motor_N;
    for (std::size_t j = 0; j < kLoopMotion; ++j) sum += loop_.motion_from_motion[i][j] * here[j];
    next[i] = sum;
  }
  next[0] += from_m;
  next[2] += from_m;
  return next;
}

void TwoInertiaObserver::Predict(const PeriodForces& forces, double beyond_m) noexcept {
  motion_ = Ahead(forces);
  beyond_m_ += beyond_m;
  if (unseen_periods_ < kMostUnseen) ++unseen_periods_;
}

TwoInertiaObserver::Seen TwoInertiaObserver::Judge(double innovation_m, double std_m) noexcept {
  return {innovation_m, std_m, gate_.LeavesOut(innovation_m, std_m)};
}

// Three in a row that are off and agree on a motion: it is the axis that moves so, and what was foretold is
// wrong. To hear nothing until time is up would take a moving axis far from its path.
bool TwoInertiaObserver::AgreesWithGated(double position_m) noexcept {
  ++gated_in_a_row_;
  const double bend_m = position_m - 2.0 * gated_m_[0] + gated_m_[1];
  const bool agrees = gated_in_a_row_ > gated_m_.size() && std::abs(bend_m) <= gate_.most_m();
  gated_m_[1] = gated_m_[0];
  gated_m_[0] = position_m;
  return agrees;
}

// Moving as the readings do, under no force beyond what is known.
void TwoInertiaObserver::GoOnByGated(double position_m, double table_m) noexcept {
  const double velocity_m_s = (gated_m_[0] - gated_m_[1]) / period_s_;
  Reset(position_m, table_m);
  motion_[1] = motion_[3] = velocity_m_s;
}

// The gains are for a reading in every period. What has come up over several is taken for a motion of the
// axis as one mass: the screw swings too fast for it to show how. A filter of fading memory, position,
// velocity and acceleration (Morrison 1969), which is stable however long it takes. Where that happens again
// and again, readings in between are no exception.
bool TwoInertiaObserver::CameSeldom(double innovation_m) noexcept {
  const std::uint32_t periods = std::max(1u, unseen_periods_);
  unseen_periods_ = 0;
  if (periods > 1) {
    again_readings_ = seldom_readings_ > 0 ? kRemembered : 0;
    seldom_readings_ = kRemembered;
  } else {
    if (seldom_readings_ > 0) --seldom_readings_;
    if (again_readings_ == 0) return false;
    --again_readings_;
  }
  constexpr double kPosition = 1.0 - kMemory * kMemory * kMemory;
  constexpr double kVelocity = 1.5 * (1.0 - kMemory * kMemory) * (1.0 - kMemory);
  constexpr double kAcceleration = (1.0 - kMemory) * (1.0 - kMemory) * (1.0 - kMemory);
  const double span_s = periods * period_s_;
  const double more_m = kPosition * innovation_m, more_m_s = kVelocity * innovation_m / span_s;
  motion_[0] += more_m;
  motion_[1] += more_m_s;
  motion_[2] += more_m;
  motion_[3] += more_m_s;
  disturbance_N_ -= mass_kg_ * kAcceleration * innovation_m / (span_s * span_s);
  return true;
}

TwoInertiaObserver::Seen TwoInertiaObserver::Correct(double position_m) noexcept {
  const Seen seen = Judge(position_m - motion_[0], innovation_std_m_);
  if (seen.gated) {
    if (AgreesWithGated(position_m))
      GoOnByGated(position_m, position_m);
    else if (StartsAgain(gated_in_a_row_, period_s_))
      Reset(position_m);
    return seen;
  }
  gated_in_a_row_ = 0;
  if (CameSeldom(seen.innovation_m)) return seen;
  for (std::size_t i = 0; i < kLoopMotion; ++i) motion_[i] += loop_.gain[i][0] * seen.innovation_m;
  disturbance_N_ += loop_.gain[kObserverDisturbance][0] * seen.innovation_m;
  return seen;
}

TwoInertiaObserver::Seen TwoInertiaObserver::Correct(double position_m,
                                                     std::optional<double> table_m) noexcept {
  const Seen seen = Judge(position_m - beyond_m_ - motion_[0], scale_innovation_std_m_);
  if (seen.gated) {
    const double there_m = table_m.value_or(position_m - beyond_m_);
    if (AgreesWithGated(position_m))
      GoOnByGated(position_m, there_m);
    else if (StartsAgain(gated_in_a_row_, period_s_))
      Reset(position_m, there_m);
    return seen;
  }
  gated_in_a_row_ = 0;
  const std::array<double, 2> innovation_m{seen.innovation_m, table_m ? *table_m - motion_[2] : 0.0};
  const auto part = [&](std::size_t i) {
    return scale_gain_[i][0] * innovation_m[0] + scale_gain_[i][1] * innovation_m[1];
  };
  beyond_m_ += part(kObserverBias);
  if (CameSeldom(table_m ? innovation_m[1] : innovation_m[0])) return seen;
  for (std::size_t i = 0; i < kLoopMotion; ++i) motion_[i] += part(i);
  disturbance_N_ += part(kObserverDisturbance);
  return seen;
}

bool TwoInertiaObserver::Sound() const noexcept {
  for (std::size_t i = 0; i < kLoopMotion; ++i)
    if (!(std::abs(motion_[i]) <= kLargest[i])) return false;
  return std::abs(disturbance_N_) <= kLargest[4];
}

}  // namespace contour
