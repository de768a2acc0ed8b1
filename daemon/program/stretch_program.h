#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "daemon/program/piecewise_plan.h"
#include "daemon/program/stretch.h"

namespace contour {

/// A program of straight moves and arcs, divided into stretches that are driven without a stop.
class StretchProgram {
 public:
  struct Part {
    std::size_t first = 0;
    std::size_t end = 0;  ///< moves first..end; none: only a dwell
    double dwell_s = 0.0;
    std::uint32_t halts = 0;  ///< places before it at which the program waits
  };

  /// Checks the way of every move against the axes' ranges; feeds are as fast as the axes follow. Throws
  /// ProgramError.
  StretchProgram(const std::vector<PieceRequest>& requests, const PerAxis<PlanLimits>& limits);

  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }
  [[nodiscard]] const std::vector<ProgrammedMove>& moves() const { return moves_; }
  [[nodiscard]] const PerAxis<double>& start_m() const { return start_m_; }
  [[nodiscard]] std::shared_ptr<const Stretch> MakeStretch(const Part& part) const;

  /// How long it takes by feeds, lengths and dwells alone, with no time for getting faster and slower: of all
  /// of it, and up to a way of a part.
  [[nodiscard]] double nominal_s() const { return nominal_.back().before_s; }
  [[nodiscard]] double Nominal_s(const Part& part, double way_m) const;

 private:
  void CountNominal();

  PerAxis<PlanLimits> limits_;
  PerAxis<double> start_m_;
  std::vector<ProgrammedMove> moves_;
  std::vector<Part> parts_;
  /// Before each move, and after the last.
  struct Nominal {
    double before_s = 0.0;
    double before_m = 0.0;
  };
  std::vector<Nominal> nominal_;
};

}  // namespace contour
