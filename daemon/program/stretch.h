#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <vector>

#include "daemon/program/rest_map.h"
#include "daemon/program/smooth_path.h"
#include "daemon/program/stretch_program.h"

namespace contour {

/// A part of a program from one stop to the next: the smooth path through it, by the programmed way, feeds
/// and lines. It is fitted piece by piece from its begin, as far as it is asked for, and given up behind; so
/// what is kept does not grow with the program. Where the path is does not depend on when it was asked for.
/// Copies share what is fitted.
class Stretch {
 public:
  Stretch(std::shared_ptr<const StretchProgram> program, std::size_t part);

  [[nodiscard]] const PerAxis<PlanLimits>& limits() const { return *limits_; }
  /// Of all of it.
  [[nodiscard]] double length_m() const { return part_.length_m; }
  /// The path is known from here, up to here.
  [[nodiscard]] double known_from_m() const { return sections_.empty() ? 0.0 : sections_.front()->from_m; }
  [[nodiscard]] double known_to_m() const { return sections_.empty() ? 0.0 : sections_.back()->to_m; }
  [[nodiscard]] bool all_known() const { return front_ == nullptr; }
  /// Fits the next piece.
  void Extend();
  /// Ways before this one are not asked for any more.
  void ForgetBefore(double way_m);

  /// Where the path is known. The second is taken from the piece on which `within_m` lies.
  [[nodiscard]] PathDerivatives At(double way_m) const;
  [[nodiscard]] PathDerivatives At(double way_m, double within_m) const;
  [[nodiscard]] double Feed_m_s(double way_m) const { return WordsAt(way_m).feed_m_s; }
  [[nodiscard]] int Line(double way_m) const { return WordsAt(way_m).line; }
  /// Ways between these two at which the path's third derivative or the feed jumps.
  [[nodiscard]] std::vector<double> Jumps_m(double from_m, double to_m) const;
  /// At the very end: direction, and the last feed.
  [[nodiscard]] PerAxis<double> EndTangent() const;
  [[nodiscard]] double EndFeed_m_s() const;

  /// Moves whose path is kept, fitted or being fitted.
  [[nodiscard]] std::size_t moves_kept() const;

 private:
  /// What else is known of the moves of a section.
  struct Words {
    double from_m = 0.0;
    double feed_m_s = 0.0;
    int line = 0;
  };
  struct Section {
    double from_m = 0.0;
    double to_m = 0.0;
    SmoothPath path;
    std::vector<Words> words;
  };
  /// Where fitting goes on.
  struct Front {
    std::vector<ProgrammedMove> moves;  ///< from before what is settled
    double from_m = 0.0;                ///< where the first of them begins
    std::size_t next = 0;               ///< move of the program that comes next
    double next_from_m = 0.0;           ///< from here on, where a part of that arc has come already
    FixedKnots fixed;
  };
  void TakeMoves(Front& front, std::size_t count) const;
  [[nodiscard]] const Section& SectionAt(double way_m) const;
  [[nodiscard]] const Words& WordsAt(double way_m) const;
  void AddSection(const ProgrammedPath& path, const SmoothPath& smooth, std::size_t first, std::size_t last);

  std::shared_ptr<const StretchProgram> program_;
  StretchProgram::Part part_;
  std::shared_ptr<const PerAxis<PlanLimits>> limits_;
  std::deque<std::shared_ptr<const Section>> sections_;
  std::shared_ptr<const Front> front_;  ///< null: all is fitted
};

/// The path's derivatives by the parameter of a RestMap.
struct ParameterDerivatives {
  PerAxis<double> first, second, third;
  double way_m = 0.0;
};

/// Within the interval of u in which `within` lies, its borders included.
inline ParameterDerivatives AtParameter(const Stretch& stretch, const RestMap& map, double u, double within) {
  const RestMap::Derivatives s = map.At(u, within);
  const PathDerivatives q = stretch.At(s.way_m, map.At(within).way_m);
  const std::size_t n = q.first.size();
  ParameterDerivatives x{PerAxis<double>(n), PerAxis<double>(n), PerAxis<double>(n), s.way_m};
  for (std::size_t i = 0; i < n; ++i) {
    x.first[i] = q.first[i] * s.first;
    x.second[i] = q.second[i] * s.first * s.first + q.first[i] * s.second;
    x.third[i] = q.third[i] * s.first * s.first * s.first + 3.0 * q.second[i] * s.first * s.second +
                 q.first[i] * s.third;
  }
  return x;
}

}  // namespace contour
