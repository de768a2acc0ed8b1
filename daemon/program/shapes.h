#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/visit.h"

// The shapes a program can have. Member names are the YAML keys; docs/programs.md describes them for users.
namespace contour {

enum class Direction { kCcw, kCw };
enum class Corners {
  kContinuous,  ///< full feed through every corner: the velocity of the reference jumps there
  kExactStop,   ///< the reference stops in every corner
};

/// Along a curve: exactly one of the two.
struct Feed {
  std::optional<double> feed_mm_min;
  std::optional<double> frequency_hz;  ///< revolutions (circle, square, diamond), periods (sine) per second

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("feed_mm_min", feed_mm_min, kPositive, "speed along the path");
    v.Optional("frequency_hz", frequency_hz, kPositive, "revolutions or periods per second");
  }
};

/// The axes that a plane shape uses; empty: the machine's first two.
using PlaneAxes = std::vector<std::string>;

struct CircleShape {
  double radius_mm = 0.0;
  double turns = 3.0;
  Direction direction = Direction::kCcw;
  Feed feed;
  PlaneAxes axes;
};

struct SquareShape {
  double side_mm = 0.0;
  double turns = 1.0;
  Direction direction = Direction::kCcw;
  Corners corners = Corners::kContinuous;
  Feed feed;
  PlaneAxes axes;
};

/// A square standing on a corner.
struct DiamondShape : SquareShape {};

struct LineShape {
  double dx_mm = 0.0;
  double dy_mm = 0.0;
  Feed feed;
  PlaneAxes axes;
};

struct SineShape {
  std::string axis;
  double amplitude_mm = 0.0;
  double cycles = 1.0;
  Feed feed;  ///< feed_mm_min is the largest speed
};

struct HoldShape {
  double seconds = 0.0;
};

/// Slow strokes to and fro at constant speed: presliding, Stribeck and Coulomb friction.
struct CreepShape {
  std::string axis;
  double stroke_mm = 0.0;
  std::vector<double> velocities_mm_s;  ///< one stroke forth and back at each
  double repeats = 1.0;
  double dwell_s = 0.5;  ///< at rest at each end
};

/// A sum of sines of equal velocity amplitude.
struct MultisineShape {
  std::string axis;
  double velocity_mm_s = 0.0;  ///< amplitude of each line's velocity
  double frequency_min_hz = 0.0;
  double frequency_max_hz = 0.0;
  double lines = 10.0;
  double seconds = 0.0;
};

/// A sine whose frequency rises exponentially, of constant velocity amplitude.
struct SweepShape {
  std::string axis;
  double velocity_mm_s = 0.0;
  double frequency_min_hz = 0.0;
  double frequency_max_hz = 0.0;
  double seconds = 0.0;
};

/// One move of a G-code program, in metres relative to where the program began, arcs in the XY plane.
struct GcodeMove {
  enum class Kind { kRapid, kLine, kArc, kDwell };
  Kind kind = Kind::kLine;
  int line = 0;                  ///< of the source text
  std::vector<double> target_m;  ///< per letter of GcodeMoves::letters
  double centre_m[2] = {0, 0};   ///< arc: centre in X, Y
  double sweep_rad = 0.0;        ///< arc: positive counter-clockwise, a full circle is 2 pi
  double feed_m_s = 0.0;         ///< line, arc: speed along the path
  double dwell_s = 0.0;
  bool stop_at_end = false;         ///< G61.1
  bool keep_feed_in_corner = true;  ///< G64 (true) or G61 (false: stop where the direction changes)
};

struct GcodeMoves {
  std::string letters;  ///< axis letters in use, e.g. "XY"; axis `x` of the machine is letter X
  std::vector<GcodeMove> moves;
};

}  // namespace contour
