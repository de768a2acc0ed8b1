#pragma once

#include <cstdint>
#include <memory>

#include "daemon/program/paced_path.h"
#include "daemon/rt/command_mailbox.h"

namespace contour {

/// Keeps the mailbox's path queue filled with a program's points, and makes the cycle change their feed. But
/// for Announce() one thread: the mailbox's path writer.
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
  void ChangePace();
  void Hear();
  void GiveAnew();

  CommandMailbox& mailbox_;
  std::unique_ptr<PacedPath> path_;
  double wanted_ = 1.0;
  Held resume_ = Held::kNot;
  Held resuming_ = Held::kNot;  ///< so does the law that is pending
  std::uint64_t margin_ = 0;    ///< points between what the cycle said was possible and what it is handed
  std::size_t burst_ = 0;       ///< points that may go where place is kept
  std::uint32_t rest_ = 0;      ///< calls until the next attempt
  PathPoint held_;
  bool holding_ = false;
};

}  // namespace contour
