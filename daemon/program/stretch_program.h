#pragma once

#include <cstddef>

#include "daemon/program/move_store.h"
#include "daemon/program/piecewise_plan.h"

namespace contour {

/// A program of straight moves and arcs, divided into parts that are driven without a stop. All that is kept
/// of it: what moves take in a MoveStore, a quarter of a byte each for times, 64 bytes a stop; of a long
/// program a window of that in memory.
class StretchProgram {
 public:
  struct Part {
    std::size_t first = 0;
    std::size_t end = 0;  ///< moves first..end; none: only a dwell
    double dwell_s = 0.0;
    std::uint32_t halts = 0;  ///< places before it at which the program waits
    double length_m = 0.0;
    double begin_s = 0.0;  ///< by feeds, lengths and dwells alone
    double moves_s = 0.0;
    double share = 1.0;  ///< of the axes' acceleration and jerk that its tolerances leave (FollowedShare)
  };

  /// Feeds are as fast as the axes follow.
  StretchProgram(const PerAxis<double>& start_m, const PerAxis<PlanLimits>& limits);

  /// Checks the way of the move against the axes' ranges. Throws ProgramError. It begins where the last one
  /// ended; `end_m` is where it ends.
  void Add(const PieceRequest& request, const PerAxis<double>& end_m);

  [[nodiscard]] const SpooledList<Part>& parts() const { return parts_; }
  [[nodiscard]] const MoveStore& moves() const { return moves_; }
  [[nodiscard]] const PerAxis<double>& start_m() const { return moves_.start_m(); }
  /// With a jerk above 0.
  [[nodiscard]] const PerAxis<PlanLimits>& limits() const { return limits_; }
  /// What a part has of them.
  [[nodiscard]] PerAxis<PlanLimits> LimitsOf(const Part& part) const;
  /// Around everything.
  [[nodiscard]] const Extent& box() const { return box_; }

  /// How long it takes by feeds, lengths and dwells alone, with no time for getting faster and slower: of all
  /// of it, and up to a way of a part.
  [[nodiscard]] double nominal_s() const;
  [[nodiscard]] double Nominal_s(const Part& part, double way_m) const;

  [[nodiscard]] std::size_t bytes_in_memory() const;

 private:
  void AddDwell(const PieceRequest& request);
  [[nodiscard]] double Time_s(const ProgrammedMove& move) const;
  [[nodiscard]] bool StopsBefore(const PieceRequest& request) const;

  PerAxis<PlanLimits> limits_;  ///< with jerk
  PerAxis<PlanLimits> stated_;
  MoveStore moves_;
  SpooledList<Part> parts_;
  Extent box_;
  PieceRequest last_;  ///< of the newest move; without length: there is none to go on from
  /// Before every so many moves, since the begin of their part.
  struct Mark {
    double since_s = 0.0;
    double since_m = 0.0;
  };
  SpooledList<Mark> marks_;
};

}  // namespace contour
