#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "daemon/program/gcode/arc_geometry.h"
#include "daemon/program/gcode/block.h"
#include "daemon/program/gcode/block_rules.h"
#include "daemon/program/gcode/canonical_move.h"
#include "daemon/program/gcode/drilling_cycle.h"
#include "daemon/program/gcode/work_offsets.h"
#include "daemon/program/gcode_parser.h"

namespace contour {

/// The modal state of a program, and what each block makes of it, in LinuxCNC's order of execution.
class GcodeInterpreter {
 public:
  using Sink = std::function<void(const CanonicalMove&)>;

  GcodeInterpreter(const GcodeSettings& settings, Sink sink)
      : settings_(settings), sink_(std::move(sink)), position_m_(settings.start_m) {}

  /// Throws ProgramError with the place. The block's motion is found here.
  void Execute(Block& block, bool in_sub);

  [[nodiscard]] bool ended() const { return ended_; }  ///< by M2 or M30

  /// Present position in the coordinates and units in force, as #5420 has it.
  void PutPosition(std::array<double, 9>& position) const;
  /// Modal state by LinuxCNC's names; codes are tenfold.
  void PutModes(std::map<std::string, double, std::less<>>& modes) const;

 private:
  void FeedMode(const Block& block);
  void Feed(const Block& block);
  void Events(const Block& block);
  void Event(const Block& block, char letter, int code, double value);
  void Modes(const Block& block);
  void PathControl(const Block& block);
  void ToolLength(const Block& block);
  void NonModal(const Block& block);
  void SetSystem(const Block& block);
  void GoHome(const Block& block);
  void Motion(const Block& block);
  void Straight(const Block& block);
  void Arc(const Block& block);
  void CheckSeries(const Block& block) const;
  void DrillHoles(const Block& block);
  [[nodiscard]] DrillingCycle CycleOf(const Block& block) const;
  [[nodiscard]] Hole HoleOf(const Block& block) const;
  [[nodiscard]] PlanePoint ArcCentre(const Block& block, const ArcEnds& ends) const;
  [[nodiscard]] AxisValues Target(const Block& block) const;
  void PolarTarget(const Block& block, AxisValues& target) const;
  [[nodiscard]] double FeedOf_m_s(const Block& block, double length_m) const;
  [[nodiscard]] CanonicalMove NewMove(CanonicalMove::Kind kind, const AxisValues& target_m) const;
  [[nodiscard]] std::array<std::uint8_t, 3> PlaneAxes() const;  ///< first, second, normal

  const GcodeSettings& settings_;
  Sink sink_;
  bool ended_ = false;
  int line_ = 0;
  bool in_sub_ = false;

  std::shared_ptr<const ToolTable> tools_;  ///< from the first G43 on
  AxisValues position_m_;                   ///< from program zero
  WorkOffsets offsets_;
  std::optional<int> selected_tool_;  ///< by T
  std::optional<int> tool_;           ///< in the spindle, by M6
  double unit_m_ = 1e-3;
  bool absolute_ = true;
  bool absolute_centres_ = false;
  bool inverse_time_ = false;
  double feed_m_s_ = 0.0;
  int plane_ = 170;
  int motion_ = 800;
  DrillingCycle cycle_;
  double strokes_ = 0.0;   ///< of all drilling cycles so far
  bool to_level_ = false;  ///< G98
  GcodeMove::Corner corner_ = GcodeMove::Corner::kContinuous;
  double tolerance_m_ = 0.0;
  double naive_cam_m_ = 0.0;
};

}  // namespace contour
