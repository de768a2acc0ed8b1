#include "control/oscillation_detector.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace contour {
namespace {

// Half waves of one oscillation differ by less than this from those of the same side before.
constexpr double kSamePeriod = 0.6;
// What falls by more per period dies out by itself: damping ratio ln(1 / 0.8) / 2 pi = 0.036.
constexpr double kKept = 0.8;
constexpr double kGrown = 1.15;
constexpr int kGrowingHalfWaves = 4;
// A reference that swings by this share of the force's swing explains it.
constexpr double kExplained = 0.5;
// A sign counts from this share of the smallest swing that is looked for.
constexpr double kHysteresis = 0.2;
// So many of the slowest half waves after a motion, the axis is at rest.
constexpr double kSettledHalfWaves = 2.0;
// Force that goes to and fro from cycle to cycle is looked at over this time.
constexpr double kChatter_s = 0.05;
// Of the mean that is told: what is less is the time before a swing.
constexpr double kQuiet = 0.1;
// Where the middle of its changes lies in the time since: half-way of a swing that stays, before it of what
// rings and dies out after a shock; two thirds of one that has grown from there to what is told.
constexpr double kGrowingMiddle = 0.6;
// A swing from cycle to cycle that goes on is told again within so many kChatter_s; one that has stayed as
// large for so many of them is no shock.
constexpr double kAgain = 2.0;
constexpr int kSpans = 6;
// Of what the first of its half waves took: what falls below until it is told was a shock.
constexpr double kStays = 0.7;
constexpr std::uint32_t kLongAgo = 1U << 30;

// A mean that follows up to half the lowest frequency looked for, per cycle.
double ShareAt(double low_Hz, double period_s) noexcept {
  return std::min(1.0, std::numbers::pi * low_Hz * period_s);
}

}  // namespace

OscillationDetector::OscillationDetector(const OscillationBounds& bounds) noexcept
    : bounds_(bounds),
      share_(ShareAt(bounds.low_Hz, bounds.period_s)),
      moving_share_(ShareAt(bounds.low_moving_Hz, bounds.period_s)) {
  Reset();
}

void OscillationDetector::Reset() noexcept {
  started_ = false;
  chatter_ = {};
  lasting_ = {};
  sign_ = 0;
  now_ = {};
  before_ = {};
  highest_m_s2_ = lowest_m_s2_ = before_highest_m_s2_ = before_lowest_m_s2_ = 0.0;
  pushed_N_ = before_pushed_N_ = 0.0;
  moved_ago_ = kLongAgo;
  run_ = violent_run_ = growing_ = 0;
  violent_ = false;
}

Oscillation OscillationDetector::Step(const OscillationSample& now) noexcept {
  if (bounds_.half_waves == 0) return Oscillation::kNone;
  if (!started_) {
    started_ = true;
    mean_m_ = now.following_error_m;
    mean_N_ = before_N_ = now.force_N;
    reference_velocity_m_s_ = now.reference_velocity_m_s;
  }
  // In a corner at full feed the velocity jumps: what rings after it was struck by the path.
  const double change_m_s2 = (now.reference_velocity_m_s - reference_velocity_m_s_) / bounds_.period_s;
  reference_velocity_m_s_ = now.reference_velocity_m_s;
  const double reference_m_s2 = std::abs(change_m_s2) > std::abs(now.reference_acceleration_m_s2)
                                    ? change_m_s2
                                    : now.reference_acceleration_m_s2;
  const double share = now.reference_velocity_m_s != 0.0 ? moving_share_ : share_;
  mean_m_ += share * (now.following_error_m - mean_m_);
  mean_N_ += share * (now.force_N - mean_N_);
  const double error_m = now.following_error_m - mean_m_;
  moved_ago_ = now.reference_velocity_m_s != 0.0 ? 0 : std::min(moved_ago_ + 1, kLongAgo);
  Oscillation found = Oscillation::kNone;
  if (std::abs(error_m) > kHysteresis * bounds_.swing_m) {
    const int sign = error_m > 0.0 ? 1 : -1;
    if (sign != sign_) {
      if (sign_ != 0) found = EndHalfWave();
      sign_ = sign;
      now_ = {};
      before_highest_m_s2_ = highest_m_s2_;
      before_lowest_m_s2_ = lowest_m_s2_;
      highest_m_s2_ = lowest_m_s2_ = reference_m_s2;
      before_pushed_N_ = pushed_N_;
      pushed_N_ = 0.0;
    }
  }
  ++now_.cycles;
  now_.peak_m = std::max(now_.peak_m, std::abs(error_m));
  now_.peak_N = std::max(now_.peak_N, std::abs(now.force_N - mean_N_));
  highest_m_s2_ = std::max(highest_m_s2_, reference_m_s2);
  lowest_m_s2_ = std::min(lowest_m_s2_, reference_m_s2);
  if (now.pushed_N != 0.0) pushed_N_ = std::max(pushed_N_, std::abs(now.pushed_N));
  if (Chatters(now.force_N, now.pushed_N) && found == Oscillation::kNone) found = Oscillation::kLasting;
  return found;
}

// A step of the force, in a corner at full feed, is one change among many; an experiment may change it from
// cycle to cycle.
bool OscillationDetector::Chatters(double force_N, double pushed_N) noexcept {
  if (!(bounds_.chatter_N > 0.0)) return false;
  Chatter& c = chatter_;
  const double change_N = std::abs(force_N - before_N_);
  before_N_ = force_N;
  if (pushed_N != 0.0) {
    c = {};
    lasting_ = {};
    return false;
  }
  c.mean_N += std::min(1.0, bounds_.period_s / kChatter_s) * (change_N - c.mean_N);
  // Near half the sampling rate every other change is small.
  const double two_N = change_N + c.change_N;
  c.sum_N += two_N;
  c.moment_N += (c.cycles + 0.5) * two_N;
  ++c.cycles;
  c.change_N = change_N;
  const bool told = c.mean_N >= bounds_.chatter_N;
  SeeLasting(two_N);
  if (told) {
    violent_ = Stays() || c.moment_N >= kGrowingMiddle * c.cycles * c.sum_N;
    lasting_.goes_on = true;
    lasting_.told_ago = 0;
    c = {.change_N = change_N};
  }
  if (!told && c.mean_N < kQuiet * bounds_.chatter_N) c = {.mean_N = c.mean_N, .change_N = change_N};
  return told;
}

// Over a loud background a swing has hardly grown when it is told, and nothing but time tells it from a
// shock.
void OscillationDetector::SeeLasting(double two_N) noexcept {
  Lasting& l = lasting_;
  if (!l.goes_on) return;
  if (++l.told_ago * bounds_.period_s > kAgain * kChatter_s) {
    l = {};
    return;
  }
  l.sum_N += two_N;
  if (++l.cycles * bounds_.period_s < kChatter_s) return;
  l.newest_N = l.sum_N / l.cycles;
  if (l.spans++ == 0) l.first_N = l.newest_N;
  l.sum_N = 0.0;
  l.cycles = 0;
}

bool OscillationDetector::Stays() const noexcept {
  return lasting_.spans >= kSpans && lasting_.newest_N >= kStays * lasting_.first_N;
}

// Against the half wave of the same side: friction and outside forces make the two sides differ.
bool OscillationDetector::GoesOn(const HalfWave& before) const noexcept {
  const double length_s = now_.cycles * bounds_.period_s;
  const bool moving = moved_ago_ * bounds_.period_s < kSettledHalfWaves * 0.5 / bounds_.low_Hz;
  const double low_Hz = moving ? bounds_.low_moving_Hz : bounds_.low_Hz;
  if (length_s > 0.5 / low_Hz || length_s < 0.5 / bounds_.high_Hz) return false;
  const double swing_m = now_.peak_m + before_[0].peak_m;
  const double swing_N = now_.peak_N + before_[0].peak_N;
  if (swing_m < bounds_.swing_m) return false;
  if (swing_N < (moving ? bounds_.swing_moving_N : bounds_.swing_N)) return false;
  const double pushed_N = std::max(pushed_N_, before_pushed_N_);
  if (pushed_N > 0.0 && swing_N < bounds_.violent_N + 2.0 * bounds_.answered * pushed_N) return false;
  const double reference_N = bounds_.mass_kg * (std::max(highest_m_s2_, before_highest_m_s2_) -
                                                std::min(lowest_m_s2_, before_lowest_m_s2_));
  if (reference_N > kExplained * swing_N) return false;
  if (before.cycles == 0) return true;
  const auto [shorter, longer] = std::minmax(now_.cycles, before.cycles);
  return shorter + 1 >= kSamePeriod * longer && now_.peak_m >= kKept * before.peak_m;
}

Oscillation OscillationDetector::EndHalfWave() noexcept {
  const HalfWave same_side = before_[1];
  const bool goes_on = GoesOn(same_side);
  run_ = goes_on ? run_ + 1 : 0;
  const double swing_N = now_.peak_N + before_[0].peak_N;
  violent_run_ = goes_on && swing_N >= bounds_.violent_N ? violent_run_ + 1 : 0;
  if (violent_run_ == 1) violent_first_N_ = swing_N;
  const bool grew = goes_on && same_side.cycles != 0 && now_.peak_m > kGrown * same_side.peak_m;
  growing_ = grew ? growing_ + 1 : 0;
  before_[1] = before_[0];
  before_[0] = now_;
  if (growing_ >= kGrowingHalfWaves && now_.peak_m > bounds_.growing_m) return Oscillation::kGrowing;
  if (run_ < bounds_.half_waves) return Oscillation::kNone;
  run_ = 0;
  violent_ = 2 * violent_run_ >= bounds_.half_waves && swing_N >= kStays * violent_first_N_;
  return Oscillation::kLasting;
}

}  // namespace contour
