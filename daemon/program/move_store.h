#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "daemon/program/programmed_path.h"
#include "daemon/program/spooled_list.h"

namespace contour {

/// All moves of a program, one after the other, in few bytes: 8 for each axis and 12, and 40 more for an arc;
/// of a long program a window of them is in memory (Spool).
/// They become curves again when they are asked for, the same ones every time.
class MoveStore {
 public:
  explicit MoveStore(const PerAxis<double>& start_m) : start_m_(start_m) {}

  /// `move` begins where the last one ended, and ends at `end_m` but for rounding.
  void Add(const ProgrammedMove& move, const PerAxis<double>& end_m);

  [[nodiscard]] std::size_t size() const { return records_.size(); }
  [[nodiscard]] bool empty() const { return records_.empty(); }
  [[nodiscard]] const PerAxis<double>& start_m() const { return start_m_; }
  /// Where move i begins; i == size(): where the last one ends.
  [[nodiscard]] PerAxis<double> Begin(std::size_t i) const;
  [[nodiscard]] CurvePiece Curve(std::size_t i) const;
  [[nodiscard]] ProgrammedMove Move(std::size_t i) const;

  [[nodiscard]] std::size_t bytes_in_memory() const;

 private:
  /// What moves next to each other often have in common.
  struct Mode {
    double feed_m_s = 0.0;
    double tolerance_m = 0.0;
  };
  struct Arc {
    std::array<double, 2> centre_m{};
    double sweep_rad = 0.0;
    std::array<std::uint8_t, 2> plane{};
  };
  struct Record {
    std::int32_t line = 0;
    std::uint32_t mode = 0;
    std::uint32_t arc = 0;  ///< counted from 1; 0: it is straight
  };
  [[nodiscard]] std::uint32_t ModeOf(const Mode& mode);
  [[nodiscard]] CurvePiece CurveOf(std::size_t i, const Record& record) const;

  PerAxis<double> start_m_;
  Spool ends_m_;  ///< of every move on every axis
  SpooledList<Record> records_;
  SpooledList<Mode> modes_;
  SpooledList<Arc> arcs_;
};

}  // namespace contour
