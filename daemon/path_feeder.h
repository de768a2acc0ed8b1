#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/program/paced_path.h"
#include "daemon/rt/command_mailbox.h"

namespace contour {

/// Keeps the mailbox's path queue filled with a program's points, and makes the cycle change their feed. But
/// for Announce(), PlanStep(), duration(), time_share(), waits_for_plan() and failure() one thread: the
/// mailbox's path writer.
class PathFeeder {
 public:
  explicit PathFeeder(CommandMailbox& mailbox) : mailbox_(mailbox) {}

  /// Any thread, before the cycle is asked to run the program: points are to come. Lock-step time waits for
  /// them, however late Begin() is called; it could go by for as long as a program is waited for.
  void Announce() { mailbox_.SetPathSupply(true); }
  void Begin(std::unique_ptr<PathGenerator> generator, const PacedPath::Options& options = {});
  /// The feed that the program shall go to as soon as it can, 1 as programmed, 2 at most; 0 is a pause.
  /// `resume`: it leaves the end of a line, where single block has it rest.
  void SetPace(double feed, bool resume = false) {
    wanted_ = feed;
    if (resume_ != Held::kHalt) resume_ = resume ? Held::kEndOfLine : Held::kNot;
    rest_ = 0;
  }
  /// The same for the place where the program halts; its pace is the one wanted.
  void Release() { resume_ = Held::kHalt; }
  /// Any thread, beside the others: plans the program a step further, where its options leave that to
  /// somebody else. False when there is nothing to plan at present.
  bool PlanStep();
  /// Of the program at its own feed, as far as that is known. Any thread.
  [[nodiscard]] PathWalk::Estimate duration() const { return {duration_s_, duration_exact_}; }
  /// What is left of it takes this share of that, at the feed that it has been told to go to, where that is
  /// more than the programmed one. Any thread.
  [[nodiscard]] double time_share() const { return time_share_; }
  /// The program is slow or at rest because planning does not keep up. Any thread.
  [[nodiscard]] bool waits_for_plan() const { return waits_for_plan_; }
  /// Why no more points of the program can come, although it is not at its end: the disk does not give back
  /// what is kept of it there. Empty: they can. Any thread.
  [[nodiscard]] std::string failure() const;
  /// Hands over what the queue has room for. Returns whether more is to come.
  bool Feed();
  /// The program is over or was given up: no more points.
  void Abandon();

  /// The feed wanted is the one that the cycle has been handed, or there is no program any more that could
  /// take it.
  [[nodiscard]] bool settled() const { return !path_ || (!path_->pending() && path_->feed() == wanted_); }
  /// Where the program waits, as far as it has been handed over.
  [[nodiscard]] PacedPath::Halt halt() const { return path_ ? path_->halt() : PacedPath::Halt{}; }
  /// The program that is supplied; null when there is none.
  [[nodiscard]] const PacedPath* path() const { return path_.get(); }

 private:
  bool FeedNow();
  bool Push(const PathPoint& point);
  bool HandOverGathered();
  void ChangePace();
  void Hear();
  void GiveAnew();
  void ForgetHeld();
  void GiveUp(const std::string& why);

  CommandMailbox& mailbox_;
  std::mutex planning_;         ///< guards the path while it is used, and while a plan is taken and given
  mutable std::mutex failing_;  ///< guards the failure
  std::string failure_;
  std::unique_ptr<PacedPath> path_;
  std::uint64_t program_ = 0;  ///< counts them
  std::atomic<double> duration_s_{0.0};
  std::atomic<bool> duration_exact_{true};
  std::atomic<double> time_share_{1.0};
  std::atomic<bool> waits_for_plan_{false};
  double wanted_ = 1.0;
  Held resume_ = Held::kNot;
  Held resuming_ = Held::kNot;  ///< so does the law that is pending
  std::uint64_t margin_ = 0;    ///< points between what the cycle said was possible and what it is handed
  std::size_t burst_ = 0;       ///< points that may go where place is kept
  std::uint32_t rest_ = 0;      ///< calls until the next attempt
  /// The first points of another law, until there are enough of them.
  std::vector<PathPoint> together_;
  bool gathers_ = false;
  bool gathered_ = false;  ///< there are
  PathPoint held_;
  bool holding_ = false;
};

}  // namespace contour
