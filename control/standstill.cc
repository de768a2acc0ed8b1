#include "control/standstill.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace contour {
namespace {

// In what a step of torque moves, or a count of the encoder if that is more: the axis is left alone from the
// first on, the force is changed from the second on (one step then brings it nearer), and the third is for
// the loop.
constexpr double kBegins = 1.0, kCorrected = 0.7, kEnds = 4.0;
// Of an error that is taken back at once: what is known of the friction's stiffness may be off by as much.
constexpr double kPart = 0.7;
// A step moves at least this share of what was stated.
constexpr double kStiffest = 0.1;
// Bristles that are relieved are so much stiffer (LuGre: at the level of friction). No correction is larger
// than would turn the error round if each of its steps moved all that one may: one whose first step was
// hidden by creep had so many that the axis swung, and swinging it crept back to where it had been.
constexpr double kRelieved = 2.0;
// Friction may be so much softer than stated; what an axis at rest is let off with grows to that in this
// time.
constexpr double kSofter = 4.0;
constexpr double kPatience_s = 1.5;
// An error that is left after that time stays unless it is so much larger: what friction has settled for is
// better left alone than stepped about for long.
constexpr double kCorrectedLate = 2.0;
// The doubt, of what friction winds the screw up by: half of what an axis may move by at rest. By the same
// share of friction the force gives way to a table that still slides, so that it stops.
constexpr double kDoubt = 0.1;
// Where the error is so many doubts, the loop takes over again.
constexpr double kDoubtEnds = 3.0;
// A loop that is taken answers a force within 200 ms (kMostLeft of design/creep.h). What has not come
// to rest long after that is stopped within what grows to the doubt, well before kStandsAfter_s.
constexpr double kDoubtFrom_s = 0.5, kDoubtGrows_s = 1.0;
// For so long it has to be so, and so long an axis is left to come to rest after a step.
constexpr double kSettles_s = 0.05;
constexpr double kWatch_s = 0.07;
// Means of error and force: over some periods of what the loop steps to and fro by.
constexpr double kMean_s = 0.01;
// From one step of torque to the next: some periods of an axis on its bristles, two at least. What a ramp
// leaves ringing is then a fifth of what a step does, where their stiffness is off by half.
constexpr double kRamp_s = 0.1;
constexpr double kRampSwings = 2.0;

int Cycles(double time_s, double period_s) noexcept {
  return std::max(1, static_cast<int>(std::lround(time_s / period_s)));
}

double LoopStiffness_N_m(const RestingAxis& a) noexcept {
  const double regulator_1_s = 2.0 * std::numbers::pi * a.regulator_Hz;
  return a.mass_kg * regulator_1_s * regulator_1_s;
}

// What the bristles alone take to damp a swing to a third. Not all of a ring is gone by the next correction,
// but then it does not build up.
bool RingsOn(const RestingAxis& a) noexcept {
  return 2.0 * a.mass_kg > (kRamp_s + kSettles_s + kWatch_s) * a.sigma1_Ns_m;
}

}  // namespace

Holder WhatHolds(const RestingAxis& a) noexcept {
  if (!(a.friction_N > kHeldSteps * a.step_N)) return Holder::kLoopFewSteps;
  // A loop that lets go leaves the speed of its own noise, which is more where it is the quicker of both.
  return LoopStiffness_N_m(a) > a.sigma0_N_m && RingsOn(a) ? Holder::kLoopLongRinging : Holder::kFriction;
}

// Where friction gives way more easily than the loop, it is the loop that says what a step moves.
double StepMoves_m(const RestingAxis& a) noexcept {
  return a.step_N / std::max(a.sigma0_N_m, LoopStiffness_N_m(a));
}

StandstillBounds BoundsOf(const RestingAxis& a, double count_m, double period_s) noexcept {
  const double swings_s =
      a.sigma0_N_m > 0.0 ? 2.0 * std::numbers::pi * std::sqrt(a.mass_kg / a.sigma0_N_m) : kPatience_s;
  return {a.step_N,
          WhatHolds(a) == Holder::kFriction ? StepMoves_m(a) : 0.0,
          count_m,
          period_s,
          std::min(swings_s, kPatience_s),
          a.stiffness_N_m > 0.0 ? kDoubt * a.friction_N / a.stiffness_N_m : 0.0,
          kDoubt * a.friction_N};
}

Standstill::Standstill(const StandstillBounds& bounds) noexcept
    : bounds_(bounds),
      share_(std::min(1.0, bounds.period_s / kMean_s)),
      settle_(Cycles(kSettles_s, bounds.period_s)),
      watch_(Cycles(std::max(kWatch_s, bounds.swings_s), bounds.period_s)),
      ramp_s_(std::max(kRamp_s, kRampSwings * bounds.swings_s)),
      patience_((kSofter - 1.0) * bounds.period_s / kPatience_s) {
  Forget();
}

// For the loop, until it is near again; what was seen of friction stays true.
void Standstill::Leave() noexcept {
  quiet_ = since_ = 0;
  sum_m_ = carry_N_ = steps_ = acts_s_ = 0.0;
  standing_ = untried_ = doubted_ = false;
}

void Standstill::Forget() noexcept {
  Leave();
  shown_m_ = moves_m_ = bounds_.step_moves_m;
  unit_m_ = std::max(bounds_.step_moves_m, bounds_.count_m);
  waits_ = 1.0;
  ramp_N_ = bounds_.step_N * std::min(1.0, bounds_.period_s / ramp_s_);
  started_ = false;
}

void Standstill::Begin(double error_m, double planned_N) noexcept {
  if (!(bounds_.step_moves_m > 0.0) || !(std::abs(error_m) < kEnds * unit_m_)) return;
  if (std::round(planned_N / bounds_.step_N) != 0.0) return;
  started_ = standing_ = untried_ = true;
  mean_m_ = error_m;
  mean_N_ = held_N_ = target_N_ = 0.0;
}

std::optional<double> Standstill::Step(double error_m, double sent_N, Motion motion) noexcept {
  if (motion == Motion::kOwn || !(bounds_.step_moves_m > 0.0)) {
    Forget();
    return std::nullopt;
  }
  if (!started_) {
    started_ = true;
    mean_m_ = error_m;
    mean_N_ = sent_N;
  }
  // One that has tried for long is let off with more: its friction may be softer than stated.
  if (motion == Motion::kNone) waits_ = std::min(waits_ + patience_, kSofter);
  mean_m_ += share_ * (error_m - mean_m_);
  mean_N_ += share_ * (sent_N - mean_N_);
  const double size_m = untried_ ? std::max(std::abs(mean_m_), std::abs(error_m)) : std::abs(mean_m_);
  if (standing_) {
    if (size_m < (doubted_ ? std::max(kEnds * unit_m_, kDoubtEnds * bounds_.doubt_m) : kEnds * unit_m_))
      return Held_N(error_m, sent_N);
    Leave();
    return std::nullopt;
  }
  if (motion != Motion::kNone) {
    quiet_ = 0;
    return std::nullopt;
  }
  acts_s_ += bounds_.period_s;
  const double doubt_m = Doubt_m();
  quiet_ = size_m < std::max(kBegins * waits_ * unit_m_, doubt_m) ? quiet_ + 1 : 0;
  if (quiet_ <= 1) begun_m_ = mean_m_;
  if (quiet_ < settle_) return std::nullopt;
  Stand(size_m, doubt_m);
  return held_N_;
}

void Standstill::Stand(double size_m, double doubt_m) noexcept {
  standing_ = true;
  // A loop that did not come to rest by what it saw does not by corrections either: which way the table goes
  // by a force is not known.
  doubted_ = doubt_m > 0.0 && (size_m >= kBegins * waits_ * unit_m_ || doubt_m >= bounds_.doubt_m);
  // One that slides goes on doing so under what it slides by.
  const double moved_m = mean_m_ - begun_m_;
  const double relief_N =
      doubted_ && std::abs(moved_m) > unit_m_ ? std::copysign(bounds_.relief_N, moved_m) : 0.0;
  // What is let off with beyond a count is friction that is softer than stated.
  if (size_m > kBegins * unit_m_) shown_m_ = unit_m_ = size_m / kBegins;
  moves_m_ = shown_m_;
  held_N_ = mean_N_;
  target_N_ = bounds_.step_N * std::round((mean_N_ - relief_N) / bounds_.step_N);
  if (relief_N != 0.0) ramp_N_ = bounds_.relief_N * std::min(1.0, bounds_.period_s / ramp_s_);
}

// What the loop may be stopped within by now.
double Standstill::Doubt_m() const noexcept {
  return bounds_.doubt_m * std::clamp((acts_s_ - kDoubtFrom_s) / kDoubtGrows_s, 0.0, 1.0);
}

// Between two steps their shares in time make up the force: what rounding kept back comes with the next.
double Standstill::Held_N(double error_m, double sent_N) noexcept {
  if (held_N_ == target_N_) {
    if (!doubted_) Watch(error_m);
  } else {
    carry_N_ += held_N_ - sent_N;
    held_N_ += std::clamp(target_N_ - held_N_, -ramp_N_, ramp_N_);
    since_ = 0;
    if (held_N_ == target_N_) carry_N_ = 0.0;
  }
  return held_N_ + carry_N_;
}

// What is left of an error once a force has settled: of many readings, since a single one is no finer than
// the encoder.
void Standstill::Watch(double error_m) noexcept {
  if (++since_ <= settle_) return;
  untried_ = false;
  sum_m_ += error_m;
  if (since_ < settle_ + watch_) return;
  Correct(sum_m_ / watch_);
  since_ = 0;
  sum_m_ = 0.0;
}

void Standstill::Correct(double mean_m) noexcept {
  if (steps_ > 0.0) {
    // Where friction is softer than stated a step moves more, and a smaller error is none; where it turns
    // round it is stiffer, and where it gives way the other way, one step does little.
    const double moved_m = (before_m_ > 0.0 ? before_m_ - mean_m : mean_m - before_m_) / steps_;
    shown_m_ = std::max(shown_m_, moved_m);
    unit_m_ = std::max(unit_m_, shown_m_);
    moves_m_ = std::clamp(moved_m, kStiffest * shown_m_, shown_m_);
  }
  const double size_m = std::abs(mean_m);
  // The first one is a single step: what it moves tells what more of them would.
  const double wanted = std::min(kPart * size_m / moves_m_, kRelieved * size_m / shown_m_);
  const double most = steps_ > 0.0 ? std::max(1.0, std::floor(wanted)) : 1.0;
  const double late = 1.0 + (kCorrectedLate - 1.0) * (waits_ - 1.0) / (kSofter - 1.0);
  steps_ = size_m > kCorrected * late * shown_m_ ? most : 0.0;
  before_m_ = mean_m;
  target_N_ -= std::copysign(steps_ * bounds_.step_N, mean_m);
  ramp_N_ = std::max(1.0, steps_) * bounds_.step_N * std::min(1.0, bounds_.period_s / ramp_s_);
}

}  // namespace contour
