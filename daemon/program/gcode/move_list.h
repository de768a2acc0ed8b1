#pragma once

#include <array>
#include <string>

#include "daemon/program/gcode/arc_geometry.h"
#include "daemon/program/gcode/canonical_move.h"

namespace contour {

/// Canonical moves as a path: without moves that go nowhere, arcs whose two radii differ as arcs that meet
/// both ends, feeds along all axes.
class MoveList {
 public:
  /// `start_m`: where the machine stands, from program zero.
  explicit MoveList(const std::string& name, const AxisValues& start_m = {})
      : name_(name), start_m_(start_m), at_m_(start_m) {}

  void Add(const CanonicalMove& move);
  /// Throws ProgramError when there is no move.
  GcodeMoves Finish();

 private:
  void Use(std::size_t axis, int line);
  GcodeMove NewMove(const CanonicalMove& canonical, GcodeMove::Kind kind);
  void AddStraight(const CanonicalMove& canonical);
  void AddArc(const CanonicalMove& canonical);
  void AddPart(const CanonicalMove& canonical, const PlanePoint& centre_m, double sweep_rad,
               const AxisValues& end_m);
  void Push(GcodeMove move, int line);
  void Pack();

  const std::string& name_;
  GcodeMoves list_;
  AxisValues start_m_;
  AxisValues at_m_;
  int named_line_ = 0;                       ///< of a move, if only to where the machine stands
  std::array<int, kGcodeAxisCount> used_{};  ///< line of the first use; 0: none
};

}  // namespace contour
