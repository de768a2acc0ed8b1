#pragma once

#include <memory>

#include "daemon/program/path_generator.h"
#include "daemon/rt/command_mailbox.h"

namespace contour {

/// Keeps the mailbox's path queue filled from a generator. One thread: the mailbox's path writer.
class PathFeeder {
 public:
  explicit PathFeeder(CommandMailbox& mailbox) : mailbox_(mailbox) {}

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
