#include "daemon/program/paced_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "daemon/program/fixed_walk.h"

namespace contour {
namespace {

constexpr double kRounding = PathGenerator::kRounding;
/// Laws that are older than this are of no use to anybody.
constexpr double kRemembered_s = 4.0;
constexpr int kHalvings = 40;
/// Of the pace that is wanted.
constexpr double kSlowest = 1e-3;

std::unique_ptr<PathWalk> WalkOf(const PathGenerator& generator) {
  std::unique_ptr<PathWalk> walk = generator.plan()->Walk();
  if (!walk) walk = std::make_unique<FixedWalk>(generator.plan());
  return walk;
}

/// A way to rest is looked for once in so long, and begins so long later.
constexpr double kStride_s = 0.032;
/// So much more is planned than a motion at the axes' largest velocities needs to come to rest.
constexpr double kBesides_s = 4.0 * kStride_s;
/// Ramps are longer than the shortest that the limits allow at constant speed, where the path bends.
constexpr double kLongerRamp = 4.0;
/// What is not needed any more is given up in lots of so long; differences look a few points back.
constexpr double kForgetAtOnce_s = 0.256;
constexpr std::uint64_t kLooksBack = 64;
/// Periods of plan that are left where it rests.
constexpr double kRoom = 4.0;
/// So much of what is enough is planned at once when the feed changes.
constexpr double kPlanAfterChange = 1.5;
/// So much of what is enough is planned ahead.
constexpr double kPlanAhead = 3.0;

/// Periods within which a motion at the axes' largest velocities comes to rest, with room.
double EnoughAhead(const PerAxis<PlanLimits>& limits, double period_s) {
  double ramp_s = 0.0;
  for (const PlanLimits& l : limits) {
    ramp_s = std::max(ramp_s, 1.5 * l.velocity_m_s / l.acceleration_m_s2);
    if (l.jerk_m_s3 > 0.0) ramp_s = std::max(ramp_s, std::sqrt(6.0 * l.velocity_m_s / l.jerk_m_s3));
  }
  return (kLongerRamp * ramp_s + kBesides_s) / period_s;
}

}  // namespace

PacedPath::PacedPath(std::unique_ptr<PathGenerator> generator, const Options& options)
    : generator_(std::move(generator)),
      walk_(WalkOf(*generator_)),
      feed_(options.feed),
      single_block_(options.single_block),
      halts_(options.halts),
      planning_(options.planning),
      enough_(EnoughAhead(generator_->limits(), generator_->period_s())),
      law_(std::min(options.feed, 1.0)) {
  if (feed_ > 1.0 && feed_may_exceed()) {
    scale_ = std::min(feed_, PathWalk::kLargestScale);
    walk_->ChangeFeed(0.0, scale_);
  }
  // A program begins at rest, so there is a way to the end of its first line.
  if (single_block_ && feed_ > 0.0)
    if (const std::optional<PaceLaw> law = ToEndOfLine(law_)) law_ = *law;
}

// Long programs are planned no further than needed to know.
bool PacedPath::IsLast(double time) const {
  return !walk_->GoesOnAfter((time + kRounding) * generator_->period_s());
}

std::uint32_t PacedPath::HaltsAt(double index) const {
  return index < 0.0 ? 0 : walk_->Halts((law_.At(index).time + kRounding) * generator_->period_s());
}

// The program is at rest where it halts, as in a dwell: its time may stand still there at once. It stands
// just behind that instant, so that it is not found again when it goes on.
void PacedPath::StandAtHalt() {
  double high = static_cast<double>(next_), low = high - 1.0;
  const std::uint32_t passed = HaltsAt(low);
  if (HaltsAt(high) == passed) return;
  for (int i = 0; i < kHalvings && low >= 0.0; ++i) {
    const double middle = 0.5 * (low + high);
    (HaltsAt(middle) == passed ? low : high) = middle;
  }
  halt_ = {HaltsAt(high), walk_->ProgramTime_s(law_.At(high).time * generator_->period_s())};
  law_.Hold(high, 0.0, Held::kHalt);
}

bool PacedPath::Next(PathPoint& point) {
  if (ended_) return false;
  if (halts_) StandAtHalt();
  const PaceState state = law_.At(static_cast<double>(next_));
  point.program_id = generator_->program_id();
  point.index = next_;
  point.law = pending_ && next_ >= pending_from_ ? issued_ : taken_;
  point.last = state.held == Held::kNot && IsLast(state.time);
  Evaluate(state, point);
  ended_ = point.last;
  ++next_;
  return true;
}

void PacedPath::Evaluate(const PaceState& state, PathPoint& point) const {
  const double period_s = generator_->period_s();
  // The last grid point lies on the end of the path or after it.
  const double time_s = point.last ? walk_->duration_s() : state.time * period_s;
  point.program_time_s = walk_->ProgramTime_s(state.time * period_s);
  point.line = static_cast<std::uint32_t>(std::max(0, walk_->Line(time_s)));
  walk_->At(time_s, point.axes);
  if (generator_->offsets()) generator_->offsets()->AddBetween(state.time, point);
  if (state.rate == 1.0 && state.change == 0.0) return;
  for (ReferencePoint& p : point.axes) {
    p.acceleration_m_s2 =
        state.rate * state.rate * p.acceleration_m_s2 + state.change / period_s * p.velocity_m_s;
    p.velocity_m_s *= state.rate;
    // An extra torque belongs to the program's own pace, as in a stop.
    p.extra_torque_Nm *= std::min(1.0, state.rate);
  }
}

// In periods of the walk's time.
double PacedPath::Planned() const {
  return planning_ == Options::Planning::kItself ? std::numeric_limits<double>::infinity()
                                                 : walk_->planned_s() / generator_->period_s();
}

bool PacedPath::Ready(std::uint64_t needed) {
  if (ended_ || planning_ == Options::Planning::kItself) return true;
  const double planned = Planned();
  if (planning_ == Options::Planning::kAheadOrSlower) {
    const bool enough = law_.At(static_cast<double>(next_)).time + enough_ <= planned;
    if (!enough && !waits_for_plan_ && next_ >= needed) return false;
    if (!MayGoOn()) return false;
  }
  const double ahead = next_ == 0 ? enough_ : 1.0;
  return law_.At(static_cast<double>(next_)).time + ahead < planned;
}

// No point is handed out unless there is a way to rest behind it within what is planned.
bool PacedPath::MayGoOn() {
  const double planned = Planned();
  const PaceState now = law_.At(static_cast<double>(next_));
  if (now.time + enough_ <= planned) {
    stop_.reset();
    if (waits_for_plan_) GoOnWithPlan();
    return true;
  }
  const bool rests = law_.rate() == 0.0 && law_.At(law_.settled()).time + kRoom < planned;
  if (waits_for_plan_ || rests || (stop_ && next_ < stop_->begin)) return true;
  const std::uint64_t later = next_ + generator_->PeriodsIn(kStride_s);
  if (const auto law = Ramp().From(law_, static_cast<double>(later), 0.0, planned)) {
    stop_ = Stop{later, *law};
    return true;
  }
  if (!stop_ || next_ != stop_->begin) return false;
  law_ = stop_->law;
  stop_.reset();
  waits_for_plan_ = true;
  return true;
}

// Nothing of this has been handed out, so that nobody needs to be told.
void PacedPath::GoOnWithPlan() {
  const PaceState now = law_.At(static_cast<double>(next_));
  if (now.rate > 0.0 && now.change != 0.0) return;  // still on its way to rest
  if (feed_ > 0.0) {
    const std::optional<PaceLaw> law = LawFrom(next_, std::min(feed_ / scale_, 1.0));
    if (!law) return;
    law_ = *law;
  }
  waits_for_plan_ = false;
}

double PacedPath::TimeShare() const {
  if (scale_ <= 1.0 || ended_) return 1.0;
  return walk_->TimeShare(law_.At(static_cast<double>(next_)).time * generator_->period_s());
}

void PacedPath::ForgetBefore(std::uint64_t index) {
  if (index < forgotten_ + generator_->PeriodsIn(kForgetAtOnce_s)) return;
  forgotten_ = index;
  const std::uint64_t needed = index - std::min(index, kLooksBack);
  const double time_s = law_.At(static_cast<double>(needed)).time * generator_->period_s();
  walk_->ForgetBefore(std::max(0.0, time_s));
}

PacedPath::Plan PacedPath::TakePlan() {
  if (planning_ == Options::Planning::kItself || ended_) return {};
  if (law_.At(static_cast<double>(next_)).time + kPlanAhead * enough_ < Planned()) return {};
  return {walk_->Clone(), version_};
}

void PacedPath::GivePlan(Plan plan) {
  if (plan.version == version_) walk_ = std::move(plan.walk);
}

// Where the line ends that is under way at that time, or begins.
double PacedPath::EndOfLine(double time) const {
  const double period_s = generator_->period_s();
  double at = std::floor(time + kRounding) + 1.0;
  int line = 0;
  // A dwell may belong to no line: then it belongs to the one before.
  const auto goes_on = [&](double place) {
    const int there = walk_->Line(place * period_s);
    if (line == 0) line = there;
    return there == 0 || there == line;
  };
  while (!IsLast(at) && goes_on(at)) at += 1.0;
  if (IsLast(at)) return std::numeric_limits<double>::infinity();
  double low = at - 1.0;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + at);
    (goes_on(middle) ? low : at) = middle;
  }
  return at;
}

std::optional<PaceLaw> PacedPath::ToEndOfLine(const PaceLaw& law) const {
  const double begin = std::ceil(law.settled());
  const double stop = EndOfLine(law.At(begin).time);
  // The last line ends by itself.
  return std::isfinite(stop) ? Ramp().StopAt(law, begin, stop) : law;
}

std::optional<PaceLaw> PacedPath::LawFrom(std::uint64_t begin, double rate) const {
  const auto from = static_cast<double>(begin);
  if (!single_block_) return Ramp().From(law_, from, rate);
  const double end_of_line = EndOfLine(law_.At(from).time);
  const auto before_its_end = [&](const PaceLaw& law) {
    return law.At(std::ceil(law.settled())).time < end_of_line;
  };
  if (rate <= 0.0) {
    const std::optional<PaceLaw> law = Ramp().From(law_, from, rate);
    return law && before_its_end(*law) ? law : std::nullopt;
  }
  // On a short line the pace that is wanted may not be reached.
  for (double slower = rate; slower > kSlowest * rate; slower *= 0.5) {
    const std::optional<PaceLaw> law = Ramp().From(law_, from, slower);
    if (!law || !before_its_end(*law)) continue;
    if (std::optional<PaceLaw> stopping = ToEndOfLine(*law)) return stopping;
  }
  return std::nullopt;
}

// What the cycle knows is to be kept, until it has taken what comes now.
void PacedPath::Adopt(const PaceLaw& law, std::uint64_t begin, std::uint64_t end, double feed) {
  before_.law = law_;
  before_.stop = stop_;
  before_.feed = feed_;
  law_ = law;
  feed_ = feed;
  stop_.reset();
  const std::uint64_t oldest = std::min(begin, end);
  law_.ForgetBefore(static_cast<double>(oldest - std::min(oldest, generator_->PeriodsIn(kRemembered_s))));
  ++issued_;
  pending_ = true;
  pending_from_ = begin;
  next_ = oldest;
  ended_ = false;
}

// Below the programmed feed by the pace, above it by the walk, whose feed is changed at the pace 1 or at rest
// only: one of the two changes at a time.
PacedPath::Step PacedPath::StepTowards(double feed, double begin, double from_rate) const {
  const double scale = std::clamp(feed, 1.0, PathWalk::kLargestScale);
  if (feed <= 0.0 || !feed_may_exceed() || scale == scale_) return {std::min(feed, 1.0), scale_, false, true};
  const bool steady = law_.AimAt(begin).reached;
  if (steady && from_rate == 0.0) return {std::min(feed, 1.0), scale, true, true};
  // The stop at the end of the line has been planned for the feed as it is: what is more comes after it.
  if (single_block_) return {std::min(1.0, feed / scale_), scale_, false, true};
  if (steady && from_rate == 1.0) return {1.0, scale, true, feed >= 1.0};
  return {1.0, scale_, false, false};
}

void PacedPath::Rescale(std::uint64_t begin, double scale) {
  before_.walk = walk_->Clone();
  before_.scale = scale_;
  const double from_s = law_.At(static_cast<double>(begin)).time * generator_->period_s();
  walk_->ChangeFeed(from_s, scale);
  // What was planned beyond is void. Until the first points are handed out there are those of the law before.
  if (planning_ != Options::Planning::kItself)
    while (walk_->planned_s() < from_s + kPlanAfterChange * enough_ * generator_->period_s())
      walk_->PlanStep();
  scale_ = scale;
  ++version_;
}

void PacedPath::ScaleBack() {
  if (!before_.walk) return;
  walk_ = std::move(before_.walk);
  scale_ = before_.scale;
  ++version_;
}

std::optional<PaceLaw> PacedPath::Take(const Step& step, std::uint64_t begin) {
  const auto from = static_cast<double>(begin);
  if (!step.rescale) {
    // It is on its way to the pace 1 already.
    if (!step.last && law_.AimAt(from).rate == 1.0) return std::nullopt;
    return LawFrom(begin, step.rate);
  }
  const bool at_rest = law_.At(from).rate == 0.0;
  Rescale(begin, step.scale);
  std::optional<PaceLaw> law;
  if (at_rest) {
    law = LawFrom(begin, step.rate);
  } else {
    // Where it was to be held is another time now.
    law = law_;
    law->Ramp(from, 0.0, 1.0);
  }
  if (!law) ScaleBack();
  return law;
}

PacedPath::Change PacedPath::ChangeFeed(std::uint64_t earliest, std::uint64_t end, double feed, Held resume) {
  before_.walk.reset();
  // Twice: not out of the middle of another change, then after it.
  for (const bool again : {false, true}) {
    const PaceState from = law_.At(static_cast<double>(earliest));
    const bool held = from.held != Held::kNot;
    if (!held && IsLast(from.time)) return Change::kNothing;
    if (held ? from.held != resume || again : feed == feed_) {
      // Where it is held it rests anyway, and goes on as it has been told last.
      feed_ = feed;
      return Change::kNothing;
    }
    if (waits_for_plan_ || (feed > 0.0 && from.time + enough_ > Planned())) {
      if (feed > 0.0) return Change::kLater;
      // It comes to rest anyway, and stays there.
      if (waits_for_plan_) {
        feed_ = 0.0;
        return Change::kNothing;
      }
    }
    const Step step = StepTowards(feed, static_cast<double>(earliest), from.rate);
    if (const std::optional<PaceLaw> law = Take(step, earliest)) {
      Adopt(*law, earliest, end, step.last ? feed : scale_ * step.rate);
      return Change::kPlanned;
    }
    if (from.change == 0.0) break;
    earliest = std::max(earliest, static_cast<std::uint64_t>(std::ceil(law_.settled())));
  }
  return Change::kLater;
}

void PacedPath::Taken() {
  taken_ = issued_;
  pending_ = false;
  before_.walk.reset();
}

void PacedPath::Refused(std::uint64_t end) {
  ScaleBack();
  law_ = before_.law;
  stop_ = before_.stop;
  waits_for_plan_ = false;  // it did not, or it would not have been asked for another law
  feed_ = before_.feed;
  pending_ = false;
  next_ = end;
  ended_ = false;
}

}  // namespace contour
