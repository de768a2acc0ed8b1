#pragma once

#include <cstdint>
#include <vector>

namespace contour {

/// At rest until somebody lets it go, whatever pace is wanted. A program's own halt is not let go by who
/// resumes at the end of a line, nor the other way round.
enum class Held : std::uint8_t { kNot, kEndOfLine, kHalt };

/// Where a program is at a point, in periods of its own time, and how fast it goes there.
struct PaceState {
  double time = 0.0;    ///< of the program, in periods
  double rate = 1.0;    ///< program time per time; 1 as programmed, 0 paused
  double change = 0.0;  ///< of the rate, per period
  Held held = Held::kNot;
};

/// A program's own time as a function of time: the rate is constant, or goes from one constant to the next by
/// a cubic without a jump of itself or of its first derivative. Time is counted in periods from the first
/// point.
///
/// What the reference of an axis becomes: with v, a, j of the program at that time, velocity r v,
/// acceleration r^2 a + r' v, jerk r^3 j + 3 r r' a + r'' v.
class PaceLaw {
 public:
  explicit PaceLaw(double rate = 1.0) : pieces_{{0.0, 0.0, {0.0, rate, 0.0, Held::kNot}, rate, Held::kNot}} {}

  [[nodiscard]] PaceState At(double index) const;

  /// From `begin` on the rate goes to `rate` within `length` periods; what came after `begin` is forgotten.
  void Ramp(double begin, double length, double rate);
  /// The same to a rest that lasts until somebody lets it go.
  void Hold(double begin, double length, Held held);
  /// Nothing before this will be asked for.
  void ForgetBefore(double index);

  /// The constant rate that it goes to at a point, and whether it has got there.
  struct Aim {
    double rate = 1.0;
    bool reached = true;
  };
  [[nodiscard]] Aim AimAt(double index) const;

  /// From here on the rate is constant.
  [[nodiscard]] double settled() const { return pieces_.back().begin + pieces_.back().length; }
  /// That constant.
  [[nodiscard]] double rate() const { return pieces_.back().to; }

 private:
  struct Piece {
    double begin = 0.0;
    double length = 0.0;  ///< of the ramp that it begins with
    PaceState from;
    double to = 1.0;
    Held held = Held::kNot;  ///< when it has settled
  };
  [[nodiscard]] const Piece& PieceAt(double index) const;
  [[nodiscard]] static PaceState On(const Piece& piece, double index);

  std::vector<Piece> pieces_;  ///< never empty
};

}  // namespace contour
