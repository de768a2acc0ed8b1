#pragma once

#include <mutex>
#include <string>

#include "core/cycle_record.h"
#include "daemon/control_socket/operator_desk.h"
#include "daemon/pump.h"

namespace contour {

/// What operators want of a program's pace: a pause, and the feed in percent of the programmed one. The feed
/// stays for the programs to come, a pause ends with its program. Never waits: who supplies the points of the
/// path changes their pace as soon as it can. Any thread.
class PaceControl {
 public:
  explicit PaceControl(Pump& pump) : pump_(pump) {}

  /// `now`: the newest record.
  Answer Change(const PaceRequest& request, const CycleRecord& now);
  /// Throws ProgramError where a program that takes so long at its own feed would take years at the one set.
  void RefuseYears(const std::string& program, double program_s) const;
  /// A program begins: the feed for it, 1 as programmed. `may_exceed`: it can be more than that.
  [[nodiscard]] double Begin(bool may_exceed);
  /// What operators should know of the feed of the program that began last; empty: it is as they want it.
  [[nodiscard]] std::string Note() const;
  /// For the status; `now` is its record.
  [[nodiscard]] PaceStatus Status(const CycleRecord& now) const;

 private:
  [[nodiscard]] std::string NoteNow() const;

  Pump& pump_;
  mutable std::mutex mutex_;  // guards what follows
  bool paused_ = false;
  double feed_percent_ = 100.0;
  bool may_exceed_ = true;  ///< of the program that began last
};

}  // namespace contour
