#pragma once

#include <memory>

#include "daemon/program/path_generator.h"
#include "daemon/rt/command_mailbox.h"

namespace contour {

/// Keeps the mailbox's path queue filled from a generator. But for Announce() one thread: the mailbox's path
/// writer.
class PathFeeder {
 public:
  explicit PathFeeder(CommandMailbox& mailbox) : mailbox_(mailbox) {}

  /// Any thread, before the cycle is asked to run the program: points are to come. Lock-step time waits for
  /// them, however late Begin() is called; it could go by for as long as a program is waited for.
  void Announce() { mailbox_.SetPathSupply(true); }
  void Begin(std::unique_ptr<PathGenerator> generator);
  /// Hands over what the queue has room for. Returns whether more is to come.
  bool Feed();
  /// The program is over or was given up: no more points.
  void Abandon();

  [[nodiscard]] const PathGenerator* generator() const { return generator_.get(); }

 private:
  CommandMailbox& mailbox_;
  std::unique_ptr<PathGenerator> generator_;
  PathPoint held_;
  bool holding_ = false;
};

}  // namespace contour
