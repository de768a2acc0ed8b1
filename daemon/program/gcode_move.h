#pragma once

#include <array>
#include <cstdint>

namespace contour {

/// One move of a G-code program, in metres from program zero. It carries all that it needs: whoever begins in
/// the middle of a program needs the end of the move before and nothing else.
struct GcodeMove {
  enum class Kind { kRapid, kLine, kArc, kDwell };
  enum class Corner {
    kContinuous,  ///< G64: full feed
    kExactPath,   ///< G61: stops where the direction changes
    kExactStop,   ///< G61.1: stops at the end of the move
    kBlended,     ///< G64 P: the next move begins before this one has ended, within a tolerance
  };
  Kind kind = Kind::kLine;
  Corner corner = Corner::kContinuous;         ///< what happens at the end of the move
  bool in_sub = false;                         ///< its line is in a sub, and may be run more than once
  std::array<std::uint8_t, 2> plane = {0, 1};  ///< arc: indices into GcodeMoves::letters
  int line = 0;                                ///< of the source text
  std::array<double, 6> target_m{};            ///< per letter of GcodeMoves::letters
  std::array<double, 2> centre_m = {0, 0};     ///< arc: in its plane; other axes move along evenly
  double sweep_rad =
      0.0;  ///< arc: positive from the first axis of the plane to the second; a full circle is 2 pi
  double feed_m_s = 0.0;  ///< line, arc: speed along the path, of all axes
  double dwell_s = 0.0;
  double tolerance_m = 0.0;  ///< kBlended: largest distance from the programmed path
};

}  // namespace contour
