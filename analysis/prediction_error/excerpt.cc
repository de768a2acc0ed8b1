#include "analysis/prediction_error/excerpt.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "analysis/diagnosis/tuning/prediction_tuning.h"

namespace contour::diagnosis {
Excerpt ChooseExcerpt(const std::vector<double>& position, const std::vector<double>& velocity,
                      const std::vector<std::uint8_t>& valid, const std::vector<std::uint8_t>& counted,
                      double period_s, double bristle) {
  Excerpt out;
  const std::size_t n = position.size();
  const auto length = static_cast<std::size_t>(kExcerpts.segment_s / period_s),
             settling = static_cast<std::size_t>(kExcerpts.settling_s / period_s);
  if (settling < 1 || n < 2 * length) return out;
  const auto places = static_cast<std::size_t>(kExcerpts.share * static_cast<double>(n) /
                                               static_cast<double>(length - settling));
  if (places < kExcerpts.fewest) return out;
  // One in every part of the log, at random in it: a program's period must not decide what is seen.
  std::mt19937 random(1);
  const std::size_t part = n / places;
  for (std::size_t p = 0; p < places; ++p) {
    const std::size_t begin = p * part, end = std::min(begin + part, n - length);
    std::size_t from = begin + random() % part;
    const auto slides = [&](std::size_t k) {
      return k < end && valid[k] != 0 &&
             std::fabs(position[k + settling] - position[k]) > kExcerpts.settling_lengths * bristle;
    };
    while (from < end && !slides(from)) ++from;
    if (from >= end) {
      from = begin;
      while (from < end && !slides(from)) ++from;
    }
    if (from >= end ||
        (p > 0 && !out.segments.empty() && from < out.segments.back().from + out.segments.back().rows))
      continue;
    out.segments.push_back({from, length, out.row.size(), position[from], velocity[from]});
    for (std::size_t k = 0; k < length; ++k) {
      out.row.push_back(from + k);
      out.counts.push_back(k >= settling && counted[from + k] != 0 ? 1 : 0);
    }
  }
  if (out.segments.size() < kExcerpts.fewest) return {};
  const auto sum = [](const std::vector<std::uint8_t>& v) {
    return static_cast<double>(std::count(v.begin(), v.end(), std::uint8_t{1}));
  };
  out.per_row = sum(counted) / std::max(1.0, sum(out.counts));
  return out;
}

}  // namespace contour::diagnosis
