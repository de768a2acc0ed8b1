#include "daemon/path_feeder.h"

#include <algorithm>
#include <utility>

#include "daemon/program/spool.h"

namespace contour {
namespace {

/// So much later than the cycle would take it a law begins: it takes time to plan and to hand over. After one
/// that came too late it is twice as much.
constexpr double kFirstMargin_s = 0.016;
constexpr double kLargestMargin_s = 2.0;
/// Calls of Feed() after which is looked again for a way to another pace, where there was none.
constexpr std::uint32_t kLookAgain = 32;
/// That the cycle has besides what a stop needs, where the points that come bring it to rest because planning
/// is late: as long as this the supply may be held up.
constexpr double kBridge_s = 0.256;
/// This part of the queue is kept free, so that behind the first point of another law there are enough at
/// once.
constexpr std::size_t kKeptFree = 4;

/// While it lives, lock-step time waits.
class Planning {
 public:
  explicit Planning(CommandMailbox& mailbox) : mailbox_(mailbox) { mailbox_.SetPathPlanning(true); }
  ~Planning() { mailbox_.SetPathPlanning(false); }
  Planning(const Planning&) = delete;
  Planning& operator=(const Planning&) = delete;

 private:
  CommandMailbox& mailbox_;
};

}  // namespace

void PathFeeder::Begin(std::unique_ptr<PathGenerator> generator, const PacedPath::Options& options) {
  auto path = std::make_unique<PacedPath>(std::move(generator), options);
  {
    const std::scoped_lock lock(planning_);
    path_ = std::move(path);
    ++program_;
    const std::scoped_lock failing(failing_);
    failure_.clear();
  }
  wanted_ = options.feed;
  resume_ = resuming_ = Held::kNot;
  margin_ = path_->generator().PeriodsIn(kFirstMargin_s);
  rest_ = 0;
  burst_ = 0;
  ForgetHeld();
  mailbox_.SetPathSupply(true);
  Feed();
}

// What waits in the queue is of no use any more; what comes now may use the place that was kept for it.
void PathFeeder::GiveAnew() {
  mailbox_.SkipPath();
  burst_ = mailbox_.path_capacity() / kKeptFree;
  ForgetHeld();
}

void PathFeeder::ForgetHeld() {
  holding_ = false;
  together_.clear();
  gathers_ = gathered_ = false;
}

// What became of the law that was handed over last.
void PathFeeder::Hear() {
  const PathProgress progress = mailbox_.path_progress();
  if (progress.law == path_->law_number()) {
    path_->Taken();
    margin_ = std::max(path_->generator().PeriodsIn(kFirstMargin_s), margin_ / 2);
  } else if (progress.refused_law == path_->law_number()) {
    GiveAnew();
    path_->Refused(progress.end);
    margin_ = std::min(2 * margin_, path_->generator().PeriodsIn(kLargestMargin_s));
    if (resume_ == Held::kNot) resume_ = resuming_;
  }
}

void PathFeeder::ChangePace() {
  if (rest_ != 0) {
    --rest_;
    return;
  }
  const Planning planning(mailbox_);
  const PathProgress progress = mailbox_.path_progress();
  if (progress.earliest == PathProgress::kNowhere) return;
  switch (path_->ChangeFeed(progress.earliest + margin_, progress.end, wanted_, resume_)) {
    case PacedPath::Change::kPlanned:
      GiveAnew();
      gathers_ = true;
      mailbox_.SetPathSupply(true);
      resuming_ = resume_;
      resume_ = Held::kNot;
      return;
    case PacedPath::Change::kNothing:
      // The program ends before it could come to another pace.
      wanted_ = path_->feed();
      resume_ = Held::kNot;
      return;
    case PacedPath::Change::kLater:
      rest_ = kLookAgain;
      return;
  }
}

bool PathFeeder::PlanStep() {
  PacedPath::Plan plan;
  std::uint64_t program = 0;
  {
    const std::scoped_lock lock(planning_);
    if (path_) plan = path_->TakePlan();
    program = program_;
  }
  if (!plan.walk) return false;
  try {
    plan.walk->PlanStep();
  } catch (const SpoolError& e) {
    const std::scoped_lock lock(planning_);
    if (program == program_) GiveUp(e.what());  // or another one has followed it
    return false;
  }
  const std::scoped_lock lock(planning_);
  if (path_ && program == program_) path_->GivePlan(std::move(plan));
  return true;
}

bool PathFeeder::Feed() {
  const std::scoped_lock lock(planning_);
  if (!path_) return false;
  bool more = true;
  try {
    more = FeedNow();
    const PathWalk::Estimate duration = path_->ProgramDuration();
    duration_s_ = duration.duration_s;
    duration_exact_ = duration.exact;
  } catch (const SpoolError& e) {
    // The cycle stops on the path when it has no more points, if nobody stops it before.
    GiveUp(e.what());
    return true;
  }
  waits_for_plan_ = path_->waits_for_plan();
  if (more) time_share_ = path_->TimeShare();
  return more;
}

std::string PathFeeder::failure() const {
  const std::scoped_lock lock(failing_);
  return failure_;
}

void PathFeeder::GiveUp(const std::string& why) {
  const std::scoped_lock lock(failing_);
  failure_ = why;
}

bool PathFeeder::FeedNow() {
  const PathProgress progress = mailbox_.path_progress();
  std::uint64_t needed = 0;  // nothing moves
  if (progress.earliest != PathProgress::kNowhere) {
    path_->ForgetBefore(std::min(progress.earliest, progress.end));
    needed = progress.earliest + path_->generator().PeriodsIn(kBridge_s);
  }
  if (path_->pending()) Hear();
  if (!path_->pending() && (path_->feed() != wanted_ || resume_ != Held::kNot)) ChangePace();
  for (;;) {
    // Points of a law that was refused are taken as fast as they come, and lead nowhere.
    if (path_->pending()) Hear();
    if (!HandOverGathered()) return true;
    if (!holding_) {
      if (!path_->Ready(needed)) return true;
      if (!path_->Next(held_)) {
        // It stays: until the cycle has got to its end, a pause may still come.
        mailbox_.SetPathSupply(false);
        return false;
      }
      holding_ = true;
    }
    if (!Push(held_)) return true;
    holding_ = false;
  }
}

bool PathFeeder::HandOverGathered() {
  if (!gathered_) return true;
  if (!mailbox_.PushPathPoints(together_.data(), together_.size())) return false;
  burst_ -= std::min(burst_, together_.size());
  together_.clear();
  gathers_ = gathered_ = false;
  return true;
}

// Without the points behind it, the first one of another law would leave the cycle nothing to go on with.
bool PathFeeder::Push(const PathPoint& point) {
  if (gathers_ && point.law == path_->law_number()) {
    together_.push_back(point);
    const std::size_t enough = std::min<std::size_t>(path_->generator().PeriodsIn(kBridge_s),
                                                     mailbox_.path_capacity() / (2 * kKeptFree));
    gathered_ = together_.size() >= enough || point.last;
    return true;
  }
  const std::size_t kept = burst_ > 0 ? 0 : mailbox_.path_capacity() / kKeptFree;
  if (mailbox_.path_points_waiting() + kept >= mailbox_.path_capacity()) return false;
  if (!mailbox_.PushPathPoint(point)) return false;
  burst_ -= burst_ > 0 ? 1 : 0;
  return true;
}

void PathFeeder::Abandon() {
  const std::scoped_lock lock(planning_);
  path_.reset();
  waits_for_plan_ = false;
  ForgetHeld();
  mailbox_.SetPathSupply(false);
}

}  // namespace contour
