#include "estimator/table_scale.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "estimator/gaussian.h"
#include "estimator/turn.h"

namespace contour {
namespace {

// Mean in which the zero is taken.
constexpr double kZero_s = 1.0;
// Time in which an acceleration is told from an encoder's steps.
constexpr double kFilter_s = 5e-3;
constexpr double kFilter_periods = 3.0;
// Of the newest sample, where a lie must not wait.
constexpr double kQuickShare = 0.5;
// The scale comes in a message of its own, of which one or two may be lost.
constexpr double kLost_s = 3e-3;
constexpr int kLostReadings = 3;
// Of the wind-up: what stiffness and torque are off by at most.
constexpr double kWindUpShare = 0.5;
// Of the motor's mass.
constexpr double kMassShare = 0.3;
constexpr double kMassStd = 0.3;
// Lead errors of screws that are sold, warm ones included, are below half a millimetre per metre; within one
// turn below a thousandth of it.
constexpr double kLeadError_rel = 5e-4;
constexpr double kTurnError_rel = 1e-3;
// A screw that warms grows within many minutes: what changes no faster is no fault of the scale.
constexpr double kWarms_s = 600.0;
// Swings of a screw whose damping is not known are taken to last for so many periods of its mode.
constexpr double kRinging_periods = 5.0;
// The shorter of the ways within which one that begins to count wrongly is looked for: of a turn.
constexpr double kShortWay = 0.1;
// Of the wind-up by friction: what a sample is off by that is no error of stiffness or lead.
constexpr double kNoiseShare = 0.1;

}  // namespace

TableScale::TableScale(const Setup& s) noexcept
    : setup_(s),
      share_(1.0 - std::exp(-s.period_s / std::max(kFilter_s, kFilter_periods * s.period_s))),
      creep_share_(s.period_s / kWarms_s),
      most_samples_(std::max(1, static_cast<int>(std::lround(kZero_s / s.period_s)))),
      lost_(std::max(kLostReadings, static_cast<int>(std::lround(kLost_s / s.period_s)))),
      fit_({s.period_s, kNoiseShare * s.level_N / s.stiffness_N_m, s.stiffness_std / s.stiffness_N_m,
            kMassStd * s.motor_mass_kg / s.stiffness_N_m, s.turn_m, s.learns && s.stiffness_std > 0.0,
            s.count_m}) {
  windows_ = {WindowOf(kShortWay * s.turn_m), WindowOf(s.turn_m)};
  const double masses_kg = s.motor_mass_kg + s.table_mass_kg;
  table_share_ = s.table_mass_kg / masses_kg;
  const double mode_rad_s = std::sqrt(s.stiffness_N_m * masses_kg / (s.motor_mass_kg * s.table_mass_kg));
  rings_kept_ = std::exp(-s.period_s * mode_rad_s / (kRinging_periods * 2.0 * std::numbers::pi));
}

ScaleWindow TableScale::WindowOf(double way_m) const noexcept {
  return ScaleWindow({.way_m = way_m,
                      .turn_m = setup_.turn_m,
                      .turn_error_rel = kTurnError_rel,
                      .lead_error_rel = kLeadError_rel,
                      .stiffness_N_m = setup_.stiffness_N_m,
                      .stiffness_error_rel = kWindUpShare,
                      .friction_N = setup_.friction_N,
                      .steps_m = 2.0 * setup_.reading_m + setup_.count_m});
}

void TableScale::Reset() noexcept {
  LetGo();
  fit_.Reset(believed() ? position_m_ - table_m_ - lead_m_ : 0.0);
}

void TableScale::LetGo() noexcept {
  sudden_ = doubted_ = 0;
  lately_m_ = 0.0;
  doubt_ = missing_ < lost_ ? Reason::kNone : Reason::kScaleLost;
  filtering_ = false;
  for (ScaleWindow& window : windows_) window.Restart();
  rings_N_ = force_N_ = 0.0;
  center_m_ = 0.0;
  fit_.LetGo(believed() ? position_m_ - table_m_ - lead_m_ : 0.0);
}

// An axis that is let go may swing on its bristles for a while: until it is first held, the mean counts.
void TableScale::SettleZero(const Sample& s, double apart_m) noexcept {
  // What the motor is known to be before the table by the lead is no part of it.
  const double off_m = apart_m - s.lead_m;
  if (!seen_ || std::abs(off_m) > Allowed_m(0.0, 0.0)) {
    seen_ = true;
    zero_samples_ = 1;
    zero_m_ = s.scale_m - s.position_m + s.lead_m;
    zero_at_m_ = s.position_m;
  } else if (zero_samples_ > 0) {
    zero_samples_ = std::min(zero_samples_ + 1, most_samples_);
    zero_m_ -= off_m / zero_samples_;
  }
}

double TableScale::Allowed_m(double screw_N, double acceleration_m_s2) const noexcept {
  // A loop that a lie has got hold of accelerates the motor further than any path does.
  const double planned_m_s2 = std::min(std::abs(acceleration_m_s2), setup_.acceleration_m_s2);
  const double wound_N =
      kWindUpShare * std::abs(screw_N) + setup_.friction_N + kMassShare * setup_.motor_mass_kg * planned_m_s2;
  return wound_N / setup_.stiffness_N_m + 2.0 * setup_.reading_m + setup_.count_m +
         kTurnError_rel * setup_.turn_m + kLeadError_rel * std::abs(position_m_ - zero_at_m_);
}

void TableScale::Filter(const Sample& s) noexcept {
  const CosSin angle = Turn(s.position_m / setup_.turn_m);
  const double velocity_m_s = (s.position_m - position_m_) / (periods_ * setup_.period_s);
  // All of the middle of the time that has passed, as force and velocity are.
  const double before_m = position_m_ - table_m_;
  const double apart_m = 0.5 * (before_m + s.position_m - (s.scale_m - zero_m_));
  const std::array<double, kSignals> now{apart_m,   s.force_N, velocity_m_s, s.position_m - zero_at_m_,
                                         angle.cos, angle.sin, s.lead_m};
  const double velocity_before_m_s = low_[kRate];
  if (!filtering_) {
    low_ = now;
    quick_ = {now[kApart], now[kForce], now[kRate]};
    quick_m_s2_ = 0.0;
    acceleration_m_s2_ = 0.0;
    filtering_ = true;
    return;
  }
  for (std::size_t i = 0; i < kSignals; ++i) low_[i] += share_ * (now[i] - low_[i]);
  acceleration_m_s2_ = (low_[kRate] - velocity_before_m_s) / setup_.period_s;
  quick_m_s2_ = -quick_[2] / setup_.period_s;
  for (std::size_t i = 0; i < quick_.size(); ++i) quick_[i] += kQuickShare * (now[i] - quick_[i]);
  quick_m_s2_ += quick_[2] / setup_.period_s;
}

double TableScale::MotorsScrew_N() const noexcept { return quick_[1] - setup_.motor_mass_kg * quick_m_s2_; }

bool TableScale::GoesWithMotor(const Sample& sample) noexcept {
  const double planned_m_s2 = std::min(std::abs(quick_m_s2_), setup_.acceleration_m_s2);
  ScaleWindow::Sample s;
  s.apart_m = quick_[0] - low_[kLead];
  // That of the torque is without friction: the window knows what that may change by.
  s.screw_N = {MotorsScrew_N(), table_share_ * quick_[1]};
  s.unsure_N = {rings_N_ + kMassShare * setup_.motor_mass_kg * planned_m_s2, rings_N_};
  s.moved_m = sample.position_m - position_m_;
  s.elapsed_s = periods_ * setup_.period_s;
  bool goes = true;
  for (ScaleWindow& window : windows_) goes = window.GoTogether(s) && goes;
  // Inertia keeps the screw from swinging in the period in which the torque changes.
  const double change_N = sample.force_N - std::exchange(force_N_, sample.force_N);
  rings_N_ = std::max(rings_kept_ * rings_N_, table_share_ * std::abs(change_N));
  return goes;
}

bool TableScale::Plausible() const noexcept {
  const double screw_N = MotorsScrew_N();
  const double off_m = quick_[0] - low_[kLead] - screw_N / setup_.stiffness_N_m - center_m_;
  // A SYNC that comes late makes a speed too high and the next too low: to the acceleration that is a push
  // and twice as large a pull.
  const double jitter_m_s2 =
      2.0 * kQuickShare * setup_.sample_jitter_s * std::abs(quick_[2]) / (setup_.period_s * setup_.period_s);
  const double jitter_m = setup_.motor_mass_kg * jitter_m_s2 / setup_.stiffness_N_m;
  return std::abs(off_m) <= Allowed_m(screw_N, quick_m_s2_) + jitter_m;
}

void TableScale::Step(const Sample& s) noexcept {
  ++periods_;
  if (doubt_ == Reason::kScaleDoubted) doubted_ = std::min(doubted_ + 1, lost_ + 1);
  if (!s.fresh) return;
  if (!s.scale_fresh) {
    missing_ = std::min(missing_ + 1, lost_);
    if (missing_ >= lost_ && doubt_ == Reason::kNone) doubt_ = Reason::kScaleLost;
    return;
  }
  missing_ = 0;
  const double apart_m = s.position_m - (s.scale_m - zero_m_);
  if (!s.enabled) {
    // Nobody's loop goes by it: what is farther apart than anything explains was told where it is.
    SettleZero(s, apart_m);
  } else if (seen_) {
    zero_samples_ = 0;
    Filter(s);
  }
  const bool goes = !s.enabled || !seen_ || GoesWithMotor(s);
  position_m_ = s.position_m;
  table_m_ = s.scale_m - zero_m_;
  lead_m_ = s.lead_m;
  periods_ = 0;
  if (!s.enabled) return LetGo();
  if (!believed()) return;
  const double screw_N = this->screw_N();
  const double beyond_m = low_[kApart] - low_[kLead] - screw_N / setup_.stiffness_N_m;
  if (!goes || !Plausible()) {
    doubt_ = Reason::kScaleDoubted;
    return;
  }
  center_m_ += creep_share_ * (beyond_m - center_m_);
  fit_.Learn(
      {beyond_m, screw_N, low_[kTravel], low_[kCos], low_[kSin], acceleration_m_s2_, s.moves, low_[kRate]});
}

bool TableScale::Sudden(double off_m, double velocity_m_s) noexcept {
  const double size_m = std::abs(off_m);
  const double forced_m = setup_.sudden_m + setup_.count_m + setup_.sample_jitter_s * std::abs(velocity_m_s);
  lately_m_ *= SuddenGate::kKeeps;
  // As there, what a loop makes of a reading that was off is not sudden.
  if (size_m <= std::max(forced_m, SuddenGate::kTwoPeriods * lately_m_)) {
    sudden_ = 0;
    lately_m_ = std::max(lately_m_, size_m);
    return false;
  }
  if (++sudden_ >= lost_ && doubt_ == Reason::kNone) doubt_ = Reason::kScaleDoubted;
  return true;
}

}  // namespace contour
