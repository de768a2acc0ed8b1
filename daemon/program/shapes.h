#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/visit.h"
#include "daemon/program/gcode/move_tape.h"

// The shapes a program can have. The names in the Visit methods are the YAML keys; docs/programs.md describes
// them for users.
namespace contour {

enum class Direction { kCcw, kCw };
bool FromName(std::string_view name, Direction& direction);
std::string_view Name(Direction direction);
std::string_view Choices(Direction);

enum class Corners {
  kVelocityJump,  ///< full feed through every corner, beyond all limits: an experiment on controllers
  kExactStop,     ///< the reference stops in every corner
};
bool FromName(std::string_view name, Corners& corners);
std::string_view Name(Corners corners);
std::string_view Choices(Corners);

inline constexpr Range kCount{1, 1000000};
inline constexpr Range kPolygonCount{1, 10000};  ///< every side is kept in memory

/// Speed along a curve: exactly one of the two.
struct Feed {
  std::optional<double> feed_mm_min;
  std::optional<double> frequency_hz;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("feed_mm_min", feed_mm_min, kPositive, "speed along the path (sine: the largest speed)");
    v.Optional("frequency_hz", frequency_hz, kPositive, "revolutions or periods per second, instead");
  }
};

/// The axes that a plane shape uses; empty: the machine's x and y, or else its first two.
using PlaneAxes = std::vector<std::string>;

struct CircleShape {
  double radius_mm = 0.0;
  int turns = 3;
  Direction direction = Direction::kCcw;
  Feed feed;
  PlaneAxes axes;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("radius_mm", radius_mm, kPositive, "radius of the circle");
    v.Optional("turns", turns, kCount, "whole turns");
    v.Optional("direction", direction, "ccw or cw");
    feed.Visit(v);
    v.Optional("axes", axes, "the two axes of the plane");
  }
};

struct SquareShape {
  double side_mm = 0.0;
  int turns = 1;
  Direction direction = Direction::kCcw;
  std::optional<Corners> corners;  ///< none, and no tolerance: the machine's tolerance
  std::optional<double> corner_tolerance_mm;
  Feed feed;
  PlaneAxes axes;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("side_mm", side_mm, kPositive, "length of a side");
    v.Optional("turns", turns, kPolygonCount, "whole turns");
    v.Optional("direction", direction, "ccw or cw");
    v.Optional("corners", corners, "a stop in each, or, as an experiment, full feed through them");
    v.Optional("corner_tolerance_mm", corner_tolerance_mm, kPositive,
               "instead: corners blended within this distance from the path; without either, within the "
               "machine's path_tolerance_mm");
    feed.Visit(v);
    v.Optional("axes", axes, "the two axes of the plane");
  }
};

/// A square standing on a corner.
struct DiamondShape : SquareShape {};

struct LineShape {
  double dx_mm = 0.0;
  double dy_mm = 0.0;
  Feed feed;
  PlaneAxes axes;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("dx_mm", dx_mm, "way of the first axis");
    v.Optional("dy_mm", dy_mm, "way of the second axis");
    v.Required("feed_mm_min", feed.feed_mm_min, kPositive, "speed along the line");
    v.Optional("axes", axes, "the two axes of the plane");
  }
};

struct SineShape {
  std::string axis;
  double amplitude_mm = 0.0;
  int cycles = 3;
  Feed feed;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("axis", axis, "the axis that moves");
    v.Required("amplitude_mm", amplitude_mm, kPositive, "from the middle to a reversal");
    v.Optional("cycles", cycles, kCount, "whole periods");
    feed.Visit(v);
  }
};

struct HoldShape {
  double seconds = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("seconds", seconds, Range{0.0, 1e6, true}, "how long to stand still");
  }
};

/// Slow strokes forth and back at constant speed: presliding, Stribeck and Coulomb friction.
struct CreepShape {
  std::string axis;
  double stroke_mm = 0.0;
  std::vector<double> velocities_mm_s;
  int repeats = 1;
  double dwell_s = 0.5;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("axis", axis, "the axis that moves");
    v.Required("stroke_mm", stroke_mm, kAny, "way of a stroke; negative: the first stroke goes down");
    v.Required("velocities_mm_s", velocities_mm_s, kPositive, "a stroke forth and back at each of them");
    v.Optional("repeats", repeats, kPolygonCount, "how often to go through the list");
    v.Optional("dwell_s", dwell_s, kNotNegative, "rest at each end of a stroke");
  }
};

/// A sum of sines, spread evenly over the logarithm of frequency, of equal velocity amplitude.
struct MultisineShape {
  std::string axis;
  double velocity_mm_s = 0.0;
  double frequency_min_hz = 0.0;
  double frequency_max_hz = 0.0;
  int lines = 10;
  double seconds = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("axis", axis, "the axis that moves");
    v.Required("velocity_mm_s", velocity_mm_s, kPositive, "velocity amplitude of each sine");
    v.Required("frequency_min_hz", frequency_min_hz, kPositive, "lowest frequency");
    v.Required("frequency_max_hz", frequency_max_hz, kPositive, "highest frequency");
    v.Optional("lines", lines, Range{1, 200}, "number of sines");
    v.Required("seconds", seconds, Range{0.0, 3600.0, true}, "duration");
  }
};

/// A sine whose frequency rises exponentially, of constant velocity amplitude.
struct SweepShape {
  std::string axis;
  double velocity_mm_s = 0.0;
  double frequency_min_hz = 0.0;
  double frequency_max_hz = 0.0;
  double seconds = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("axis", axis, "the axis that moves");
    v.Required("velocity_mm_s", velocity_mm_s, kPositive, "velocity amplitude");
    v.Required("frequency_min_hz", frequency_min_hz, kPositive, "frequency at the start");
    v.Required("frequency_max_hz", frequency_max_hz, kPositive, "frequency at the end");
    v.Required("seconds", seconds, Range{0.0, 3600.0, true}, "duration");
  }
};

/// Sines of one axis about where it stands, one amplitude after the other: loops inside loops, from sticking
/// to sliding.
struct ReversalsShape {
  std::string axis;
  std::vector<double> amplitudes_mm;
  double frequency_hz = 1.0;
  int cycles = 3;
  double dwell_s = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("axis", axis, "the axis that moves");
    v.Required("amplitudes_mm", amplitudes_mm, kPositive,
               "from the middle to a reversal, one after the other");
    v.Required("frequency_hz", frequency_hz, kPositive, "periods per second");
    v.Optional("cycles", cycles, kPolygonCount, "whole periods of each amplitude");
    v.Optional("dwell_s", dwell_s, kNotNegative, "rest after each amplitude");
  }
};

/// Torque put on an axis at rest, in steps; a weak spring holds it in the controller's place, so that it
/// breaks away but does not run off.
struct TorqueStepsShape {
  std::string axis;
  std::vector<double> torques_Nm;
  double travel_mm = 0.0;
  double rise_s = 0.2;
  double hold_s = 0.3;
  double rest_s = 0.3;
  int repeats = 1;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("axis", axis, "the axis that is pushed");
    v.Required("torques_Nm", torques_Nm, kAny, "torque of each step; negative: downwards");
    v.Required("travel_mm", travel_mm, kPositive,
               "how far the largest of them may push the axis, either way");
    v.Optional("rise_s", rise_s, Range{0.001, 100.0}, "time over which torque rises and falls");
    v.Optional("hold_s", hold_s, kNotNegative, "time it stays");
    v.Optional("rest_s", rest_s, kNotNegative, "time without torque after each step");
    v.Optional("repeats", repeats, kPolygonCount, "how often to go through the list");
  }
};

enum class TorqueSignalKind {
  kChirp,      ///< a sine whose frequency rises evenly with time, again and again
  kMultisine,  ///< sines spread evenly over the logarithm of frequency
  kPulses,     ///< plus, minus, minus, plus: speed and position come back to where they were
};
bool FromName(std::string_view name, TorqueSignalKind& kind);
std::string_view Name(TorqueSignalKind kind);
std::string_view Choices(TorqueSignalKind);

/// `torque:` of a program: a torque added to the controller's while the shape runs.
struct TorqueSignal {
  std::string axis;
  TorqueSignalKind kind = TorqueSignalKind::kChirp;
  double amplitude_Nm = 0.0;
  double frequency_min_hz = 0.0;
  double frequency_max_hz = 0.0;
  int lines = 20;
  double period_s = 5.0;
  double width_s = 0.005;
  std::string highest_where;  ///< where frequency_max_hz is written

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("axis", axis, "the axis that is pushed");
    v.Required("kind", kind, "what the torque looks like");
    v.Required("amplitude_Nm", amplitude_Nm, kPositive, "peak of chirp and pulses, and of each line");
    v.Optional("frequency_min_hz", frequency_min_hz, kPositive, "lowest frequency of chirp and multisine");
    v.Optional("frequency_max_hz", frequency_max_hz, kPositive, "highest frequency of chirp and multisine");
    v.Optional("lines", lines, Range{1, 200}, "sines of a multisine");
    v.Optional("period_s", period_s, kPositive, "after which a chirp or a group of pulses comes again");
    v.Optional("width_s", width_s, kPositive, "length of a quarter of a group of pulses");
  }
};

struct Program;

/// `sequence:`: programs one after the other, each from where the one before has ended.
struct SequenceShape {
  std::vector<Program> parts;
  int repeats = 1;
};

/// `together:`: programs of different axes at the same time.
struct TogetherShape {
  std::vector<Program> parts;
};

/// What a program asks for besides motion: M0 and M1 (hold), M3 to M9, S and T.
struct GcodeEvent {
  std::size_t before_move = 0;  ///< index of the move that it precedes
  int line = 0;
  char letter = 'M';   ///< M, S or T
  int code = 0;        ///< of M
  double value = 0.0;  ///< of S and T; of M6 the tool, -1 none
  bool acts = false;   ///< something is done about it: see UseEvents
  bool waits = false;  ///< for the operator
  [[nodiscard]] bool holds() const { return letter == 'M' && code <= 1; }
};

struct GcodeMoves {
  std::string letters;            ///< axis letters in use; letter X is the machine's axis `x`
  std::vector<int> letter_lines;  ///< where each of them is used first
  std::array<double, 6>
      start_m{};  ///< per letter: where the machine stands when it starts, from program zero
  MoveTape moves;
  std::vector<GcodeEvent> events;  ///< in their order; the move before a hold ends in a stop
};

}  // namespace contour
