#pragma once

#include <array>
#include <string>
#include <utility>

#include "daemon/program/gcode/arc_geometry.h"
#include "daemon/program/gcode/canonical_move.h"
#include "daemon/program/gcode/naive_cam.h"
#include "daemon/program/gcode_parser.h"

namespace contour {

/// Canonical moves as a path: without moves that go nowhere, arcs whose two radii differ as arcs that meet
/// both ends, feeds along all axes; straight moves joined as G64 Q says.
class MoveList {
 public:
  MoveList(std::string name, const GcodeSettings& settings)
      : name_(std::move(name)), settings_(settings), start_m_(settings.start_m), at_m_(settings.start_m) {}

  void Add(const CanonicalMove& move);
  /// Throws ProgramError when there is no move.
  GcodeMoves Finish();

 private:
  void Use(std::size_t axis, int line);
  GcodeMove NewMove(const CanonicalMove& canonical, GcodeMove::Kind kind);
  void AddStraight(const CanonicalMove& canonical);
  [[nodiscard]] double JoinsWithin_m(const CanonicalMove& canonical);
  bool AddAsLines(const CanonicalMove& canonical, double sweep_rad);
  void AddArc(const CanonicalMove& canonical);
  void AddPart(const CanonicalMove& canonical, const PlanePoint& centre_m, double sweep_rad,
               const AxisValues& end_m);
  void Push(GcodeMove move, int line);
  void Pack();

  std::string name_;
  GcodeSettings settings_;
  NaiveCam naive_cam_;
  GcodeMoves list_;
  AxisValues start_m_;
  AxisValues at_m_;
  int named_line_ = 0;                       ///< of a move, if only to where the machine stands
  std::array<int, kGcodeAxisCount> used_{};  ///< line of the first use; 0: none
};

}  // namespace contour
