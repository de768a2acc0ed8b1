#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/axis.h"
#include "daemon/program/curve_piece.h"

namespace contour {

/// One move of a stretch that is driven without a stop.
struct ProgrammedMove {
  CurvePiece curve;          ///< longer than 0
  double feed_m_s = 0.0;     ///< 0: as fast as the axes allow
  double tolerance_m = 0.0;  ///< how far the smooth path may leave the programmed one towards the next move
  int line = 0;
};

/// Moves one after the other, by the way covered since the first of their stretch began.
class ProgrammedPath {
 public:
  /// `from_m`: way at which the first of them begins. `travel`: where the axes may be, and all of the moves
  /// are.
  explicit ProgrammedPath(std::vector<ProgrammedMove> moves, double from_m = 0.0,
                          const std::optional<Extent>& travel = std::nullopt);

  [[nodiscard]] std::size_t axis_count() const { return moves_.front().curve.start_m.size(); }
  [[nodiscard]] double from_m() const { return begin_m_.front(); }
  [[nodiscard]] double to_m() const { return begin_m_.back(); }
  [[nodiscard]] std::size_t size() const { return moves_.size(); }
  [[nodiscard]] const ProgrammedMove& move(std::size_t i) const { return moves_[i]; }
  [[nodiscard]] double begin_m(std::size_t i) const { return begin_m_[i]; }  ///< i == size(): the end

  /// Nothing: not bounded.
  [[nodiscard]] const std::optional<Extent>& travel() const { return travel_; }

  /// The move at a way, clamped to the path; at a junction the later one.
  [[nodiscard]] std::size_t MoveAt(double way_m) const;
  [[nodiscard]] PerAxis<double> At(double way_m) const;
  /// Mean position over a piece of way.
  [[nodiscard]] PerAxis<double> Mean(double from_m, double to_m) const;
  /// How far a smooth path may be away at this way: as the junction next to it says.
  [[nodiscard]] double Tolerance_m(double way_m) const;

 private:
  std::vector<ProgrammedMove> moves_;
  std::vector<double> begin_m_;
  std::optional<Extent> travel_;
};

}  // namespace contour
