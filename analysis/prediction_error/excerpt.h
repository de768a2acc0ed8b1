#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace contour::diagnosis {

/// Rows of a log that are run on their own, from a state of their own.
struct Segment {
  std::size_t from = 0, rows = 0;
  std::size_t at = 0;  ///< where its rows begin in what is kept of all segments, back to back
  double start_q = 0.0, start_w = 0.0;
};

enum class Extent { kWhole, kExcerpt };

/// Short segments from all over the log that stand for the whole of it. The observer forgets in some 30 ms
/// and a sliding bristle in its own length, so runs of a segment that begins in a slide are those of the
/// whole log after a little while; their rows count from there.
struct Excerpt {
  std::vector<Segment> segments;     ///< none: the log is too short to leave anything out
  std::vector<std::size_t> row;      ///< of the log, of every row that is kept
  std::vector<std::uint8_t> counts;  ///< whether the segment has settled there
  double per_row = 1.0;              ///< counted rows of the log for every one here

  [[nodiscard]] bool empty() const { return segments.empty(); }
};

/// `counted`: rows of the log whose residual counts; `bristle`: travel in which a bristle goes to its end.
Excerpt ChooseExcerpt(const std::vector<double>& position, const std::vector<double>& velocity,
                      const std::vector<std::uint8_t>& valid, const std::vector<std::uint8_t>& counted,
                      double period_s, double bristle);

}  // namespace contour::diagnosis
