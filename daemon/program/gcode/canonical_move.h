#pragma once

#include <array>
#include <cstdint>

#include "daemon/program/gcode/block.h"

namespace contour {

/// What a block asks of the machine, without any modal state: positions count from program zero, in metres.
struct CanonicalMove {
  enum class Kind { kTraverse, kFeed, kArc, kDwell, kEvent };
  Kind kind = Kind::kTraverse;
  int line = 0;
  bool in_sub = false;  ///< the line may be run more than once
  AxisValues target_m{};
  unsigned named = 0;  ///< bit per axis: its word is in the block, it moves or not
  std::array<std::uint8_t, 2> plane{0,
                                    1};  ///< arc: its axes; counter-clockwise turns the first into the second
  std::array<double, 2> centre_m{};
  int turns = 0;          ///< arc: positive counter-clockwise; 1 is less than a turn, or a whole one
  double feed_m_s = 0.0;  ///< feed, arc: of the tool, along X Y Z where any of them moves
  double dwell_s = 0.0;
  GcodeMove::Corner corner = GcodeMove::Corner::kContinuous;
  double tolerance_m = 0.0;
  GcodeEvent event;
  double naive_cam_m = 0.0;  ///< G64 Q: straight moves within it become one; 0: they stay as they are
};

}  // namespace contour
