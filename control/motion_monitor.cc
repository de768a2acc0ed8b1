#include "control/motion_monitor.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace contour {
namespace {

// A reading that stays the same for less is the encoder's step.
constexpr std::uint32_t kSameAtLeast_periods = 3;
// A spring so soft that it answers later than this answers never; whole numbers end somewhere.
constexpr double kLongest_periods = 1e6;
// Of the path after which a standing reading is one that stands still: no loop that follows is so far ahead.
constexpr double kSlipped = 3.0;
// Held forces that are remembered, at most.
constexpr std::uint32_t kMostHeld = 8;
// Readings in a row that momentum must be missing in.
constexpr std::uint32_t kBeyondAtLeast = 2;
// Of a report's error, what it must have shown to be one.
constexpr double kReportShows = 0.1;
// Drives know their torque to that share of it.
constexpr double kReportGain = 0.3;
constexpr std::uint32_t kLearnEvery_readings = 8;
// csp: less than this share of Coulomb friction is no torque.
constexpr double kNoTorque = 0.1;
// Where a limit is exceeded anyway, so much of what may go unexplained is enough to doubt the encoder.
constexpr double kInDoubt = 0.5;
// Readings whose second differences a SYNC is part of.
constexpr std::uint32_t kReadingsOfASync = 3;
// Lead errors of screws that are sold are well below half a millimetre per metre.
constexpr double kLeadError_rel = 5e-4;
// A screw that warms grows within many minutes: an offset that changes no faster than that is no slip.
constexpr double kWarms_s = 600.0;

// An encoder that is reversed takes the axis away to one side. What comes back, time and again, by as much at
// least as is missing and by more than readings may be off, is a loop that swings: one that is too fast for
// what has been put on the table, say.
Reason AsItSwings(Reason found, const SwingAhead& swing, double missing_m,
                  const MotionThresholds& t) noexcept {
  const bool swings = found == Reason::kFeedbackReversed && swing.Swings(std::max(t.reading_m, missing_m));
  return swings ? Reason::kOscillation : found;
}

}  // namespace

MotionMonitor::MotionMonitor(const MonitoredAxis& axis, const MonitorConfig& config, double period_s,
                             WatchesOff off) noexcept
    : axis_(axis),
      config_(config),
      off_(off),
      t_(ThresholdsOf(axis, config, period_s)),
      period_s_(period_s),
      watch_(axis.Fs_N, axis.slide_m_s, config.torque_constant_error_rel) {
  axis_.delay_cycles = std::clamp<std::uint32_t>(axis_.delay_cycles, 1, 4);
}

void MotionMonitor::Restart(const MotionSample& s) noexcept {
  held_ = true;
  forces_N_.fill(0.0);
  report_before_N_ = s.reported_force_N;
  peak_N_ = force_N_ = jitter_N_ = unexplained_N_ = on_its_way_N_ = ringing_N_ = turns_N_ = sent_N_ =
      reported_N_ = 0.0;
  slow_force_N_ = axis_.in_cascade ? s.reported_force_N : 0.0;
  least_N_ = most_N_ = slower_force_N_ = slow_force_N_;
  settling_N_ = 0.0;
  rest_least_N_ = rest_most_N_ = slow_force_N_;
  drive_push_.Restart(s.reference_m);
  // From no torque: a drive may answer the counts that flicker when it is enabled by a kick before its first
  // report.
  same_turns_.Restart(0.0);
  near_turns_.Restart(0.0);
  pushed_least_N_ = pushed_most_N_ = slow_force_N_;
  same_reference_m_ = s.reference_m;
  same_lead_m_ = s.lead_m;
  near_ = false;
  same_ = near_periods_ = same_gone_ = near_gone_ = pushed_periods_ = beyond_ = beyond_rigid_ = undelivered_ =
      0;
  report_seen_ = scale_seen_ = tells_none_ = false;
  doubt_ = Reason::kNone;
  doubt_lasts_ = false;
  doubt_hidden_ = 0;
  astray_m_ = 0.0;
  scale_apart_ = 0;
  swing_.Restart();
  swing_ahead_.Restart();
}

// At skipped grid points the drives hold the last torque.
void MotionMonitor::Push(const MotionSample& s) noexcept {
  for (std::uint32_t i = 0; i < std::min(s.periods, kMostHeld); ++i)
    for (std::size_t age = axis_.delay_cycles + 1; age > 0; --age) forces_N_[age] = forces_N_[age - 1];
  forces_N_[0] = s.sent_force_N;
}

// Of a force, and by how much it changed: it may ring in the screw for a while.
void MotionMonitor::SeePeak(double force_N, double spread_N) noexcept {
  peak_N_ = std::max(peak_N_ * t_.peak_decay, std::abs(force_N) + spread_N);
}

// A drive that tells of no torque says why its axis stands or falls behind. Where torque is wanted, that is;
// and where its report has not been seen to be one, a reading that stands may be either.
Reason MotionMonitor::Named(Reason found, const MotionSample& s, double force_N) noexcept {
  const double wanted_N = axis_.in_cascade ? axis_.Fc_N : std::abs(force_N);
  tells_none_ =
      off_.Acts(Watch::kDelivery) && report_seen_ && std::abs(s.reported_force_N) <= kNoTorque * wanted_N;
  const bool torque = found == Reason::kFeedbackFrozen || found == Reason::kTorqueWithoutMotion ||
                      found == Reason::kFeedbackReversed;
  if (!torque || !off_.Acts(Watch::kDelivery)) return found;
  const bool wants = axis_.in_cascade ? t_.loop_N_m * std::abs(s.reference_m - s.position_m) > axis_.Fc_N
                                      : wanted_N > kReportShows * t_.delivery_N;
  if (tells_none_ && wants) return Reason::kTorqueNotDelivered;
  const bool either = found == Reason::kFeedbackFrozen && (tells_none_ || !report_seen_);
  return either ? Reason::kTorqueWithoutMotion : found;
}

Reason MotionMonitor::Jump(const MotionSample& s, double force_N) noexcept {
  if (readings_ < 2) return Reason::kNone;
  const double n = waited_periods_;
  const double before = last_gap_periods_;
  const double acceleration_m_s2 = force_N / t_.mass_kg;
  const double predicted_m = position_m_ + velocity_m_s_ * n * period_s_ +
                             0.5 * acceleration_m_s2 * period_s_ * period_s_ * n * (n + before);
  const double beside_m = s.position_m - predicted_m;
  const bool evenly = n == 1.0 && before == 1.0;
  const double forced_m = t_.Forced_m(velocity_m_s_, peak_N_, period_s_, n, before);
  double off_m = std::abs(beside_m);
  if (evenly && off_m > forced_m) off_m = swing_ahead_.Beyond_m(beside_m, t_);
  if (evenly)
    swing_ahead_.See(beside_m, t_);
  else
    swing_ahead_.Restart();
  believed_ = off_m <= forced_m;
  // To momentum a SYNC that came late is a push that is taken back at once; only what goes on counts.
  if (believed_ && late_readings_ == 0) return Reason::kNone;
  const double jitter_m = std::min(off_m, t_.jitter_s * std::abs(velocity_m_s_));
  if (!believed_)
    jitter_N_ = std::max(jitter_N_, t_.filter * t_.mass_kg * jitter_m / (period_s_ * period_s_));
  double allowed_m = forced_m + t_.Jitter_m(velocity_m_s_, n, before);
  // A cycle that was late sent its SYNC late, by less than a period.
  if (late_readings_ > 0) {
    --late_readings_;
    allowed_m += 2.0 * period_s_ * std::abs(velocity_m_s_);
  }
  if (off_m <= allowed_m) return Reason::kNone;
  // The first reading under torque may follow one that jumped before.
  return near_ && std::abs(s.position_m - position_m_) <= t_.flicker_m ? Reason::kFeedbackFrozen
                                                                       : Reason::kFeedbackJump;
}

Reason MotionMonitor::Frozen(const MotionSample& s) noexcept {
  // A force counts once it has acted for a whole period before this sample.
  const double settled_N = axis_.in_cascade ? s.reported_force_N : forces_N_[axis_.delay_cycles + 1];
  const double swing_N = settled_N - slow_force_N_;
  if (axis_.in_cascade) {
    same_turns_.See(settled_N);
    near_turns_.See(settled_N);
    turns_N_ = std::max(turns_N_ * t_.push_kept, same_turns_.most_N());
  }
  const bool turned = turns_N_ > 0.0;
  // Kicks come from either side: some of one sign in a row are no push, even where this reading has seen none
  // come back yet.
  const double same_noise_N = std::max(t_.swing * same_turns_.most_N(), turns_N_);
  slow_force_N_ += t_.frozen_filter * swing_N;
  slower_force_N_ += t_.settling_filter * (slow_force_N_ - slower_force_N_);
  // A reading that is exactly the same, under another force or along a path that goes on.
  if (readings_ == 0 || s.position_m != position_m_) {
    least_N_ = most_N_ = slow_force_N_;
    same_reference_m_ = s.reference_m;
    same_lead_m_ = s.lead_m;
    same_ = 0;
    if (turned) same_turns_.Restart(settled_N);
  } else {
    same_ += waited_periods_;
    least_N_ = std::min(least_N_, slow_force_N_);
    most_N_ = std::max(most_N_, slow_force_N_);
  }
  const bool at_rest =
      axis_.in_cascade
          ? drive_push_.Seen({s.reference_m, same_, waited_periods_, slow_force_N_, swing_N, same_noise_N},
                             t_, period_s_)
          : AtRest(s);
  // A reading that only flickers, along a path that goes on. A disturbance moves the axis, and only then may
  // its torque be on its way back: what a loop makes of a reading that stands is none.
  settling_N_ *= t_.settling_decay;
  if (!near_ || std::abs(s.position_m - near_position_m_) > t_.flicker_m) {
    SeeLead(s.position_m - s.reference_m);
    near_ = true;
    near_position_m_ = s.position_m;
    near_reference_m_ = s.reference_m;
    near_lead_m_ = s.lead_m;
    near_periods_ = 0;
    near_least_N_ = near_most_N_ = slow_force_N_;
    near_braked_ = true;
    if (turned) near_turns_.Restart(settled_N);
    settling_N_ = std::max(settling_N_, std::abs(slow_force_N_ - slower_force_N_));
  } else {
    near_periods_ += waited_periods_;
    // What braked the axis into the band goes back to nothing, and pushes nothing by that.
    near_braked_ = near_braked_ && std::abs(slow_force_N_) <= std::abs(near_most_N_);
    if (near_braked_) near_least_N_ = near_most_N_ = slow_force_N_;
    near_least_N_ = std::min(near_least_N_, slow_force_N_);
    near_most_N_ = std::max(near_most_N_, slow_force_N_);
  }
  const double settling_N = kSettlingShare * settling_N_;
  const bool by_push = !axis_.in_cascade && Pushed(s, settling_N);
  double loop_N_m = t_.loop_N_m;
  std::uint32_t answer_periods = t_.loop_periods;
  if (s.spring_N_m > 0.0) {
    loop_N_m = s.spring_N_m;
    answer_periods = static_cast<std::uint32_t>(
                         std::min(std::sqrt(t_.mass_kg / s.spring_N_m) / period_s_, kLongest_periods)) +
                     1;
  }
  // Inertia may hold a reading within its band for a while, against less the longer that lasts.
  const double inertial_N = t_.Inertial_N(t_.flickering, near_periods_ * period_s_);
  const auto flickering_N = [&] {
    const double noise_N = std::max(t_.swing * near_turns_.most_N(), turns_N_);
    return t_.flickering_force_N + noise_N + (near_periods_ >= t_.force_periods ? 0.0 : inertial_N);
  };
  const bool by_force =
      (same_ >= kSameAtLeast_periods && most_N_ - least_N_ > t_.frozen_force_N + same_noise_N) ||
      (near_periods_ >= kSameAtLeast_periods && near_most_N_ - near_least_N_ > flickering_N());
  // A reference that begins with a jump is answered after the loop's delay, which may be longer than stated.
  const auto gone = [&](std::uint32_t& periods, double from_m, double from_lead_m, double path_m) {
    const double gone_m = s.reference_m - from_m;
    // An axis that had slipped far ahead rightly stands until the reference has come up with it.
    const double lead_m = s.position_m - from_m;
    const double ahead_m = gone_m > 0.0 ? lead_m - least_lead_m_ : most_lead_m_ - lead_m;
    // What a drive was told, along the path.
    const double told_m = gone_m + s.lead_m - from_lead_m;
    const bool beyond = std::abs(gone_m) > path_m + (ahead_m > kSlipped * path_m ? ahead_m : 0.0) &&
                        (gone_m > 0.0 ? told_m : -told_m) > path_m;
    periods = beyond ? periods + waited_periods_ : 0;
    return periods > t_.begin_periods;
  };
  bool by_path = false, by_flicker = false;
  const double path_m = t_.frozen.Path_m(loop_N_m, settling_N);
  if (std::abs(s.reference_m - same_reference_m_) > path_m) {
    by_path = gone(same_gone_, same_reference_m_, same_lead_m_, path_m) && same_ >= answer_periods;
  } else {
    same_gone_ = 0;
  }
  if (std::abs(s.reference_m - near_reference_m_) > t_.flickering.Path_m(loop_N_m, settling_N)) {
    // At a turning point inertia alone may hold a reading within the band for a while. And what our own loop
    // answered is known: one that brakes at the same time may have answered nothing.
    const double force_N = settling_N + inertial_N;
    const bool answered = axis_.in_cascade || near_most_N_ - near_least_N_ > t_.flickering.force_N + force_N;
    const double flicker_path_m = answered ? t_.flickering.Path_m(loop_N_m, force_N) : HUGE_VAL;
    by_flicker =
        gone(near_gone_, near_reference_m_, near_lead_m_, flicker_path_m) && near_periods_ >= answer_periods;
  } else {
    near_gone_ = 0;
  }
  if (!by_force && !by_path && !by_flicker && !by_push && !at_rest) return Reason::kNone;
  return Reason::kFeedbackFrozen;
}

// A motor leads its table by the screw's wind-up for as long as it moves; what it slips by, it leads by more
// than when the motion began.
void MotionMonitor::SeeLead(double lead_m) noexcept {
  if (!near_) least_lead_m_ = most_lead_m_ = lead_m;
  const double forgotten = std::min((near_periods_ + 1) * t_.settling_filter, 1.0);
  least_lead_m_ = std::min(least_lead_m_ + forgotten * (lead_m - least_lead_m_), lead_m);
  most_lead_m_ = std::max(most_lead_m_ + forgotten * (lead_m - most_lead_m_), lead_m);
}

// Our own loops at rest answer more than readings, and outside forces that grow slowly: only what goes fast
// counts.
bool MotionMonitor::AtRest(const MotionSample& s) noexcept {
  if (same_ == 0) rest_least_N_ = rest_most_N_ = slow_force_N_;
  rest_least_N_ += t_.rest_fade * (slow_force_N_ - rest_least_N_);
  rest_most_N_ += t_.rest_fade * (slow_force_N_ - rest_most_N_);
  rest_least_N_ = std::min(rest_least_N_, slow_force_N_);
  rest_most_N_ = std::max(rest_most_N_, slow_force_N_);
  return s.spring_N_m == 0.0 && same_ >= t_.force_periods && rest_most_N_ - rest_least_N_ > t_.rest_force_N;
}

// What flickers and is no motion may be added up by our own loops until it is a push. What stopped the axis
// may be on its way for the first periods.
bool MotionMonitor::Pushed(const MotionSample& s, double settling_N) noexcept {
  if (near_periods_ < t_.force_periods) {
    pushed_least_N_ = pushed_most_N_ = slow_force_N_;
  } else {
    pushed_least_N_ += t_.rest_fade * (slow_force_N_ - pushed_least_N_);
    pushed_most_N_ += t_.rest_fade * (slow_force_N_ - pushed_most_N_);
    pushed_least_N_ = std::min(pushed_least_N_, slow_force_N_);
    pushed_most_N_ = std::max(pushed_most_N_, slow_force_N_);
  }
  double pushed_N = pushed_most_N_ - pushed_least_N_ - settling_N - t_.pushed_force_N;
  if (pushed_N > 0.0) pushed_N -= t_.Inertial_N(t_.flickering, near_periods_ * period_s_);
  pushed_periods_ = pushed_N > 0.0 && s.spring_N_m == 0.0 ? pushed_periods_ + waited_periods_ : 0;
  return pushed_periods_ >= t_.pushed_periods;
}

Reason MotionMonitor::Momentum(double velocity_m_s, double explained_N, bool stands) noexcept {
  const double won_N = force_N_ - unexplained_N_;
  // What slides and gains speed against its torque has friction on the side of the torque, and no heavier
  // mass explains it.
  const bool driven =
      won_N * force_N_ < 0.0 && velocity_m_s * force_N_ < 0.0 && std::abs(velocity_m_s) > axis_.slide_m_s;
  const double rigid_N =
      (driven ? t_.external_N + config_.mass_error_rel * std::abs(won_N) + axis_.Fs_N : explained_N) +
      jitter_N_ + std::abs(on_its_way_N_) + ringing_N_;
  jitter_N_ *= 1.0 - t_.filter;
  const double size_N = std::abs(unexplained_N_);
  beyond_rigid_ = size_N > rigid_N ? beyond_rigid_ + 1 : 0;
  beyond_ = size_N > rigid_N + swing_.Left_N(t_) ? beyond_ + 1 : 0;
  // By the time that it is no swing of the screw, the loop may have turned its torque round.
  if (beyond_rigid_ == kBeyondAtLeast) contradiction_ = Contradiction(velocity_m_s, stands, driven);
  if (beyond_ < kBeyondAtLeast) return Reason::kNone;
  return AsItSwings(contradiction_, swing_ahead_, size_N * period_s_ * period_s_ / t_.mass_kg, t_);
}

// What momentum beyond torque and friction says.
Reason MotionMonitor::Contradiction(double velocity_m_s, bool stands, bool driven) const noexcept {
  // A reading that stands contradicts a small torque by itself; under a large one the axis may stand.
  if (stands) {
    return std::abs(force_N_) > t_.friction_N + t_.external_N ? Reason::kTorqueWithoutMotion
                                                              : Reason::kFeedbackFrozen;
  }
  const double won_N = force_N_ - unexplained_N_;
  // Momentum won, in the torque's direction or against it.
  const bool lacks = unexplained_N_ * force_N_ > 0.0;
  // An axis without torque is braked by friction.
  const double braked_N = 0.5 * (t_.friction_N + t_.external_N) + t_.viscous_Ns_m * std::abs(velocity_m_s);
  const bool against = won_N * force_N_ < 0.0 && std::abs(won_N) > braked_N;
  return lacks && !against && !driven ? Reason::kTorqueWithoutMotion : Reason::kFeedbackReversed;
}

// Neighbouring samples say the same twice: one in a filter's memory is enough. An acceleration that friction
// could hide is mostly the encoder's steps, and noise in what is multiplied makes the factor come out small.
void MotionMonitor::Learn(double velocity_m_s) noexcept {
  if (until_learning_ > 0) --until_learning_;
  if (until_learning_ > 0 || !believed_ || std::abs(velocity_m_s) < axis_.slide_m_s) return;
  const double inertial_N = force_N_ - unexplained_N_;
  if (std::abs(inertial_N) <= axis_.Fs_N) return;
  until_learning_ = kLearnEvery_readings;
  watch_.Learn(force_N_, inertial_N, velocity_m_s);
}

// Momentum that was won or lost by nothing, in a reading that no force explains, is soon forgotten by the
// filter; but an axis that strays from then on does so because of it.
void MotionMonitor::KeepDoubt(const MotionSample& s, double velocity_m_s, double explained_N) noexcept {
  const double astray_m = std::abs(s.reference_m - s.position_m);
  if (std::abs(unexplained_N_) > kInDoubt * explained_N) {
    const double won_N = force_N_ - unexplained_N_;
    // Without torque an axis falls behind, with a reversed encoder it seems to gain speed the other way; one
    // that hardly moves does neither.
    const bool gains =
        won_N * force_N_ < 0.0 && velocity_m_s * force_N_ < 0.0 && std::abs(velocity_m_s) > axis_.slide_m_s;
    doubt_ =
        unexplained_N_ * force_N_ > 0.0 && !gains ? Reason::kTorqueWithoutMotion : Reason::kFeedbackReversed;
    doubt_lasts_ = doubt_lasts_ || !believed_;
    // While the screw swings back, it may hide for as long what it has not made.
    doubt_hidden_ = t_.swing_periods;
  } else if (doubt_hidden_ > waited_periods_) {
    doubt_hidden_ -= waited_periods_;
  } else if (!doubt_lasts_ || astray_m <= astray_m_) {
    doubt_ = Reason::kNone;
    doubt_lasts_ = false;
  }
  astray_m_ = astray_m;
}

Reason MotionMonitor::Doubt() const noexcept {
  if (held_ && tells_none_) return Reason::kTorqueNotDelivered;
  const double missing_m = std::abs(unexplained_N_) * period_s_ * period_s_ / t_.mass_kg;
  return held_ ? AsItSwings(doubt_, swing_ahead_, missing_m, t_) : Reason::kNone;
}

// A report that has never shown the torque is none: some drives leave 0x6077 at zero.
Reason MotionMonitor::Delivery(const MotionSample& s) noexcept {
  if (axis_.in_cascade) return DeliveryInCascade(s);
  const double share = waited_periods_ / (t_.report_periods + waited_periods_);
  sent_N_ += share * (Acting_N() - sent_N_);
  reported_N_ += share * (s.reported_force_N - reported_N_);
  const double allowed_N = t_.delivery_N + kReportGain * std::abs(sent_N_);
  if (sent_N_ * reported_N_ > 0.0 && std::abs(reported_N_) > kReportShows * t_.delivery_N)
    report_seen_ = true;
  undelivered_ = std::abs(sent_N_ - reported_N_) > allowed_N ? undelivered_ + waited_periods_ : 0;
  return report_seen_ && undelivered_ > t_.undelivered_periods ? Reason::kTorqueNotDelivered : Reason::kNone;
}

// The torque that a drive's own loop wants is not known, but one that is behind by so much wants some.
Reason MotionMonitor::DeliveryInCascade(const MotionSample& s) noexcept {
  const double force_N = std::abs(s.reported_force_N);
  const double none_N = kNoTorque * axis_.Fc_N;
  if (force_N > none_N) report_seen_ = true;
  // Drives interpolate their targets, and their loops follow behind.
  const double behind_m =
      std::abs(s.reference_m - s.position_m) -
      std::abs(velocity_m_s_) * (period_s_ + 1.0 / (2.0 * std::numbers::pi * axis_.loop_Hz));
  const bool idle = force_N <= none_N && t_.loop_N_m * behind_m > t_.friction_N + t_.external_N;
  undelivered_ = idle ? undelivered_ + waited_periods_ : 0;
  return report_seen_ && undelivered_ >= t_.idle_periods ? Reason::kTorqueNotDelivered : Reason::kNone;
}

Reason MotionMonitor::Scale(const MotionSample& s) noexcept {
  if (!s.has_scale) return Reason::kNone;
  const double apart_m = s.table_position_m - s.position_m;
  if (!scale_seen_) {
    scale_seen_ = true;
    scale_offset_m_ = apart_m;
    scale_begin_m_ = s.position_m;
  }
  const double travel_m = std::abs(s.position_m - scale_begin_m_);
  const double allowed_m = t_.windup_m + t_.reading_m + kLeadError_rel * travel_m;
  scale_apart_ = std::abs(apart_m - scale_offset_m_) > allowed_m ? scale_apart_ + 1 : 0;
  if (scale_apart_ == 0)
    scale_offset_m_ += waited_periods_ * period_s_ / kWarms_s * (apart_m - scale_offset_m_);
  return scale_apart_ >= t_.scale_samples ? Reason::kScaleDisagrees : Reason::kNone;
}

Reason MotionMonitor::Judge(const MotionSample& s) noexcept {
  const double force_N = axis_.in_cascade ? 0.5 * (s.reported_force_N + report_before_N_) : Acting_N();
  // A drive's loop that swings, as after a set-point that was lost, has a mean near nothing.
  const double swing_N = 0.5 * std::abs(s.reported_force_N - report_before_N_);
  if (axis_.in_cascade) {
    SeePeak(std::max(std::abs(force_N), swing_N), 0.0);
    // The screw rings by what the torque changed at once.
    ringing_N_ = std::max(ringing_N_ * t_.peak_decay, t_.ringing * 2.0 * swing_N);
  }
  report_before_N_ = s.reported_force_N;

  Reason found = Reason::kNone;
  const auto keep = [&](bool acts, Reason r) {
    if (acts && found == Reason::kNone) found = r;
  };
  keep(off_.Acts(Watch::kJump), Jump(s, force_N));
  keep(off_.Acts(Watch::kFrozen), Frozen(s));
  if (readings_ > 1) {
    const double gap_s = waited_periods_ * period_s_;
    const double velocity_m_s = (s.position_m - position_m_) / gap_s;
    const double between_s = 0.5 * (gap_s + last_gap_periods_ * period_s_);
    const double missing_N = force_N - t_.mass_kg * (velocity_m_s - velocity_m_s_) / between_s;
    unexplained_N_ += t_.filter * (missing_N - unexplained_N_);
    force_N_ += t_.filter * (force_N - force_N_);
    // What it would be with a drive that answers a cycle later than stated.
    const double before_N = axis_.in_cascade ? force_N : forces_N_[axis_.delay_cycles + 1];
    on_its_way_N_ += t_.filter * (force_N - before_N - on_its_way_N_);
    swing_.See(missing_N - unexplained_N_, force_N - force_N_, t_);
    const double explained_N = t_.Unexplained_N(velocity_m_s, force_N_);
    keep(off_.Acts(Watch::kMomentum),
         Momentum(velocity_m_s, explained_N, std::abs(s.position_m - position_m_) <= t_.flicker_m));
    if (off_.Acts(Watch::kMomentum)) KeepDoubt(s, velocity_m_s, explained_N + swing_.Left_N(t_));
    Learn(velocity_m_s);
  }
  keep(off_.Acts(Watch::kDelivery), Delivery(s));
  keep(off_.Acts(Watch::kScale), Scale(s));
  return Named(found, s, force_N);
}

Reason MotionMonitor::Step(const MotionSample& s) noexcept {
  waited_periods_ += s.periods;
  believed_ = true;
  if (s.late) late_readings_ = kReadingsOfASync;
  if (!s.enabled) held_ = false;
  Reason found = Reason::kNone;
  if (s.enabled) {
    if (!held_) Restart(s);
    Push(s);
    // Also of a force that acts while no reading comes.
    if (!axis_.in_cascade) SeePeak(Acting_N(), std::abs(Acting_N() - forces_N_[axis_.delay_cycles - 1]));
    if (s.fresh) found = Judge(s);
  }
  if (s.fresh) {
    if (readings_ > 0) velocity_m_s_ = (s.position_m - position_m_) / (waited_periods_ * period_s_);
    last_gap_periods_ = waited_periods_;
    position_m_ = s.position_m;
    waited_periods_ = 0;
    readings_ = std::min(readings_ + 1, 2U);
  }
  return found;
}

}  // namespace contour
