#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

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

  /// `newest`: gives the newest record. It is asked when no program can begin any more meanwhile.
  Answer Change(const PaceRequest& request, const std::function<CycleRecord()>& newest);
  /// Throws ProgramError where a program that takes so long at its own feed would take years at the one set.
  void RefuseYears(const std::string& program, double program_s) const;
  /// A program begins: the pump supplies it at the feed that is wanted now, and what is wanted from now on
  /// reaches it. Throws as RefuseYears() does, for the feed may have changed since that was asked.
  void Begin(const std::string& program, std::unique_ptr<PathGenerator> generator, PacedPath::Options options,
             std::vector<ProgramHalt> halts);
  /// The cycle has answered whether it runs it.
  void Begun();
  /// What operators should know of the feed of the program that began last; empty: it is as they want it.
  [[nodiscard]] std::string Note() const;
  /// For the status; `now` is its record.
  [[nodiscard]] PaceStatus Status(const CycleRecord& now) const;

 private:
  [[nodiscard]] std::string NoteNow() const;
  void RefuseYearsNow(const std::string& program, double program_s) const;
  [[nodiscard]] double Left_s(const CycleRecord& now) const;

  Pump& pump_;
  mutable std::mutex mutex_;  // guards what follows
  bool paused_ = false;
  double feed_percent_ = 100.0;
  bool may_exceed_ = true;  ///< of the program that began last
  double program_s_ = 0.0;  ///< that one takes at its own feed, as far as was known then
  bool begins_ = false;     ///< it is supplied, and the cycle has not answered yet
};

}  // namespace contour
