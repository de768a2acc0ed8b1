#include "daemon/program/stretch_walk.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace contour {
namespace {

constexpr double kNever_s = std::numeric_limits<double>::infinity();
constexpr double kRounding_s = 1e-9;
constexpr double kBetweenLegs_s = 1e-3;
// Over less, no share of time is told.
constexpr double kSomeTime_s = 1e-2;
// Laws kept besides those that cannot be made again.
constexpr std::size_t kHeld = 4;

}  // namespace

StretchWalk::StretchWalk(std::shared_ptr<const StretchProgram> program)
    : program_(std::move(program)), rests_from_s_(kNever_s), changed_from_s_(kNever_s) {
  Append(0, 0.0, 0.0);
}

StretchWalk::StretchWalk(const StretchWalk& other)
    : program_(other.program_),
      gone_(other.gone_),
      forgets_(other.forgets_),
      held_(other.held_),
      complete_(other.complete_),
      end_s_(other.end_s_),
      scale_(other.scale_),
      not_before_s_(other.not_before_s_),
      rests_from_s_(other.rests_from_s_),
      changed_from_s_(other.changed_from_s_) {
  for (const Leg& l : other.legs_)
    legs_.push_back({l.part, l.of, l.from_m, l.scale, l.begin_s, l.changed,
                     l.law ? std::make_unique<TimeLaw>(*l.law) : nullptr});
  if (other.own_) own_ = std::make_unique<StretchWalk>(*other.own_);
}

void StretchWalk::Append(std::size_t part, double from_m, double begin_s) {
  legs_.push_back({part, program_->parts()[part], from_m, scale_, begin_s, false, nullptr});
}

TimeLaw* StretchWalk::LawOf(std::size_t leg) {
  Leg& l = legs_[leg];
  if (l.of.first == l.of.end) return nullptr;
  if (!l.law) {
    l.law = std::make_unique<TimeLaw>(StretchOf(l), l.from_m, l.scale);
    held_.push_back(leg);
    if (!forgets_) GiveUpLaws(leg);
  }
  return l.law.get();
}

// What is left of a stretch is the same stretch.
Stretch StretchWalk::StretchOf(const Leg& leg) const {
  for (const std::size_t other : held_) {
    if (other >= legs_.size() || !legs_[other].law || legs_[other].part != leg.part) continue;
    const Stretch& stretch = legs_[other].law->stretch();
    if (stretch.known_from_m() <= leg.from_m) return stretch;
  }
  return {program_, leg.part};
}

void StretchWalk::GiveUpLaws(std::size_t but) {
  if (held_.size() <= kHeld) return;
  const std::size_t oldest = held_.front();
  held_.erase(held_.begin());
  if (oldest < legs_.size() && oldest != but && !legs_[oldest].changed) legs_[oldest].law.reset();
}

void StretchWalk::ForgetBefore(double time_s) {
  // Where one leg ends and the next begins, either may be asked for.
  if (own_) own_->ForgetBefore(ProgramTime_s(time_s) - kBetweenLegs_s);
  forgets_ = true;
  const std::size_t leg = LegAt(time_s);
  legs_.erase(legs_.begin(), legs_.begin() + static_cast<std::ptrdiff_t>(leg));
  if (legs_.front().law) legs_.front().law->ForgetBefore(time_s - legs_.front().begin_s);
  gone_ += leg;
  std::vector<std::size_t> held;
  for (const std::size_t h : held_)
    if (h >= leg) held.push_back(h - leg);
  held_ = std::move(held);
}

double StretchWalk::planned_s() {
  if (complete_ || rests_from_s_ < kNever_s) return kNever_s;
  const Leg& last = legs_.back();
  return last.begin_s + (last.law ? last.law->planned_s() : 0.0);
}

void StretchWalk::PlanStep() {
  const double planned = planned_s();
  if (!(planned < kNever_s)) return;
  Extend(planned + kRounding_s);
  // Where that is in the program is asked for with every point.
  const double reached = complete_ ? end_s_ : planned_s();
  if (own_) static_cast<void>(ProgramTime_s(reached - kRounding_s));
}

PathWalk::Estimate StretchWalk::ProgramDuration() {
  if (own_) return own_->ProgramDuration();
  if (complete_) return {end_s_, true};
  const Leg& last = legs_.back();
  const double planned = planned_s();
  // As far as it is planned, it has taken so much longer than feeds and lengths alone say.
  const double way_m = last.law ? last.law->planned_way_m() : 0.0;
  const double nominal_s = program_->Nominal_s(last.of, way_m);
  const double longer = planned > 0.0 && nominal_s > 0.0 ? planned / nominal_s : 1.0;
  return {planned + longer * (program_->nominal_s() - nominal_s), false};
}

double StretchWalk::TimeShare(double time_s) {
  const double planned = complete_ ? end_s_ : planned_s();
  if (!own_ || !(planned < kNever_s)) return 1.0;
  const double takes_s = planned - kRounding_s - time_s;
  const double at_feed_s = ProgramTime_s(planned - kRounding_s) - ProgramTime_s(time_s);
  return takes_s > kSomeTime_s && at_feed_s > kSomeTime_s ? takes_s / at_feed_s : 1.0;
}

void StretchWalk::Extend(double time_s) {
  while (!complete_ && !(rests_from_s_ < kNever_s)) {
    const std::size_t last = legs_.size() - 1;
    if (legs_[last].begin_s > time_s) return;
    TimeLaw* law = LawOf(last);
    const double since = time_s - legs_[last].begin_s;
    if (law != nullptr && law->GoesOnAfter(since)) return;
    const Leg& leg = legs_[last];
    const double moved_s = leg.begin_s + (law != nullptr ? law->duration_s() : 0.0);
    const bool on_the_way = law != nullptr && law->stops_on_the_way();
    const bool ends = !on_the_way && leg.part + 1 == program_->parts().size();
    const double dwelt_s = moved_s + (on_the_way ? 0.0 : leg.of.dwell_s);
    if (ends) {
      complete_ = true;
      end_s_ = dwelt_s;
    } else if (scale_ == 0.0) {
      rests_from_s_ = moved_s;
    } else if (on_the_way) {
      const double way_m = law->At(law->duration_s()).way_m;
      Append(leg.part, way_m, std::max(moved_s, not_before_s_));
    } else {
      Append(leg.part + 1, 0.0, std::max(dwelt_s, not_before_s_));
    }
  }
}

std::size_t StretchWalk::LegAt(double time_s) {
  const auto after = std::upper_bound(legs_.begin(), legs_.end(), time_s,
                                      [](double t, const Leg& l) { return t < l.begin_s; });
  return after == legs_.begin() ? 0 : static_cast<std::size_t>(after - legs_.begin()) - 1;
}

PerAxis<double> StretchWalk::StartOf(const StretchProgram::Part& part) const {
  return program_->moves().Begin(part.first);
}

void StretchWalk::At(double time_s, PerAxis<ReferencePoint>& axes) {
  Extend(time_s);
  const std::size_t leg = LegAt(time_s);
  TimeLaw* law = LawOf(leg);
  axes.resize(program_->start_m().size());
  std::fill(axes.begin(), axes.end(), ReferencePoint{});
  if (law == nullptr) {
    const PerAxis<double> at_m = StartOf(legs_[leg].of);
    for (std::size_t i = 0; i < axes.size(); ++i) axes[i].position_m = at_m[i];
    return;
  }
  const TimeLaw::State s = law->At(time_s - legs_[leg].begin_s);
  const PathDerivatives q = law->stretch().At(s.way_m);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    axes[i].position_m = q.position_m[i];
    axes[i].velocity_m_s = q.first[i] * s.speed_m_s;
    axes[i].acceleration_m_s2 = q.second[i] * s.speed_m_s * s.speed_m_s + q.first[i] * s.acceleration_m_s2;
  }
}

bool StretchWalk::GoesOnAfter(double time_s) {
  Extend(time_s);
  return !complete_ || time_s < end_s_;
}

double StretchWalk::duration_s() {
  Extend(kNever_s);
  return complete_ ? end_s_ : kNever_s;
}

double StretchWalk::ChangeFeed(double time_s, double scale) {
  Extend(time_s);
  if (!own_) {
    own_ = std::make_unique<StretchWalk>(*this);
    changed_from_s_ = time_s;
  }
  complete_ = false;
  while (legs_.size() > 1 && legs_.back().begin_s > time_s) legs_.pop_back();
  scale_ = scale;
  not_before_s_ = scale > 0.0 ? std::max(time_s, 0.0) : 0.0;
  rests_from_s_ = kNever_s;
  const std::size_t last = legs_.size() - 1;
  TimeLaw* law = LawOf(last);
  double from_s = time_s;
  if (law != nullptr) {
    legs_[last].changed = true;
    from_s = legs_[last].begin_s + law->ChangeFeed(time_s - legs_[last].begin_s, scale);
  }
  if (scale == 0.0) Extend(legs_[last].begin_s + (law != nullptr ? law->duration_s() : 0.0) + 1.0);
  return from_s;
}

std::uint32_t StretchWalk::Halts(double time_s) {
  Extend(time_s);
  return legs_[LegAt(time_s)].of.halts;
}

int StretchWalk::Line(double time_s) {
  Extend(time_s);
  const std::size_t leg = LegAt(time_s);
  TimeLaw* law = LawOf(leg);
  if (law == nullptr) return 0;
  return law->stretch().Line(law->At(time_s - legs_[leg].begin_s).way_m);
}

double StretchWalk::BeginOf_s(std::size_t part) {
  while (gone_ + legs_.size() <= part) {
    TimeLaw* law = LawOf(legs_.size() - 1);
    Extend(legs_.back().begin_s + (law != nullptr ? law->duration_s() : 0.0) + kRounding_s);
  }
  return legs_[part - gone_].begin_s;
}

double StretchWalk::TimeAt_s(std::size_t part, double way_m) {
  const double begin_s = BeginOf_s(part);
  TimeLaw* law = LawOf(part - gone_);
  return begin_s + (law != nullptr ? law->TimeAt_s(way_m) : 0.0);
}

double StretchWalk::ProgramTime_s(double time_s) {
  if (time_s <= changed_from_s_) return time_s;
  Extend(time_s);
  const std::size_t leg = LegAt(time_s);
  const std::size_t part = legs_[leg].part;
  TimeLaw* law = LawOf(leg);
  const double since_s = time_s - legs_[leg].begin_s;
  const double moves_s =
      law != nullptr ? own_->TimeAt_s(part, law->At(since_s).way_m) : own_->BeginOf_s(part);
  const double moved_s = law != nullptr ? law->planned_s() : 0.0;
  // A dwell takes the time that it takes.
  const double dwelt_s = law != nullptr && law->stops_on_the_way() ? 0.0 : std::max(0.0, since_s - moved_s);
  return moves_s + std::min(dwelt_s, legs_[leg].of.dwell_s);
}

StretchWalk::Kept StretchWalk::kept() const {
  Kept kept = own_ ? own_->kept() : Kept{};
  for (const Leg& l : legs_) {
    if (!l.law) continue;
    kept.moves += l.law->stretch().moves_kept();
    kept.nodes += l.law->nodes();
  }
  return kept;
}

}  // namespace contour
