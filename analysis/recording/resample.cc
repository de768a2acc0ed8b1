#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/recording/axis_log.h"
#include "analysis/recording/table_rows.h"
#include "config/config_error.h"
#include "config/number_text.h"

namespace contour::diagnosis {
namespace {

using Column = std::vector<double>;

/// Rows [from, to) without a gap.
struct Stretch {
  std::size_t from, to;
};

std::vector<Stretch> StretchesOf(const Column& time_s) {
  Column steps;
  for (std::size_t i = 1; i < time_s.size(); ++i) steps.push_back(time_s[i] - time_s[i - 1]);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  const double median = *middle;
  std::vector<Stretch> out = {{0, 0}};
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    const double missing = std::round((time_s[i] - time_s[i - 1]) / median) - 1.0;
    if (missing < 1.0 || !IsGap(static_cast<std::size_t>(missing), median)) continue;
    out.back().to = i;
    out.push_back({i, 0});
  }
  out.back().to = time_s.size();
  return out;
}

/// Cubic through rows i and i + 1 with the slopes of parabolas through each and its neighbours; straight
/// next to a value that is not known, and none where one of the two is not.
double CubicAt(const Column& t, const Column& y, const Stretch& s, std::size_t i, double at) {
  const double h = t[i + 1] - t[i], x = (at - t[i]) / h, rise = y[i + 1] - y[i];
  const auto slope = [&](std::size_t k) {
    if (k == s.from || k + 1 == s.to) return rise / h;
    const double before = t[k] - t[k - 1], after = t[k + 1] - t[k];
    const double parabola =
        ((y[k] - y[k - 1]) / before * after + (y[k + 1] - y[k]) / after * before) / (before + after);
    return std::isfinite(parabola) ? parabola : rise / h;
  };
  const double m0 = slope(i) * h, m1 = slope(i + 1) * h;
  return y[i] + x * (m0 + x * (3.0 * rise - 2.0 * m0 - m1 + x * (m0 + m1 - 2.0 * rise)));
}

/// Integral of the command from the first row of a stretch, row by row.
Column IntegralOf(const Column& t, const Column& u, const Stretch& s, bool measured) {
  Column out(s.to - s.from, 0.0);
  for (std::size_t i = s.from; i + 1 < s.to; ++i)
    out[i + 1 - s.from] = out[i - s.from] + (t[i + 1] - t[i]) * (measured ? 0.5 * (u[i] + u[i + 1]) : u[i]);
  return out;
}

class Resampler {
 public:
  Resampler(const TableRows& rows, bool measured, double rate_Hz)
      : rows_(rows), measured_(measured), rate_Hz_(rate_Hz) {}

  void Take(const Stretch& s, TableRows& out, std::vector<std::size_t>& index) {
    const Column& t = rows_.time_s;
    const Column integral = IntegralOf(t, rows_.command, s, measured_);
    const auto count = static_cast<std::size_t>((t[s.to - 1] - t[s.from]) * rate_Hz_ + 1e-9);
    const std::size_t first =
        index.empty()
            ? 0
            : index.back() + 1 + static_cast<std::size_t>(std::ceil((t[s.from] - ended_s_) * rate_Hz_));
    std::size_t i = s.from;
    for (std::size_t k = 0; k < count; ++k) {
      const double at = t[s.from] + static_cast<double>(k) / rate_Hz_;
      while (i + 2 < s.to && t[i + 1] <= at) ++i;
      std::size_t j = i;
      const double end = at + 1.0 / rate_Hz_;
      while (j + 2 < s.to && t[j + 1] <= end) ++j;
      out.line.push_back(rows_.line[i]);
      out.time_s.push_back(at);
      out.command.push_back(rate_Hz_ * (Upto(integral, s, j, end) - Upto(integral, s, i, at)));
      for (const auto column : TableRows::kStates)
        if (!(rows_.*column).empty()) (out.*column).push_back(CubicAt(t, rows_.*column, s, i, at));
      index.push_back(first + k);
    }
    ended_s_ = t[s.to - 1];
  }

 private:
  [[nodiscard]] double Upto(const Column& integral, const Stretch& s, std::size_t i, double at) const {
    const double x = at - rows_.time_s[i], u = rows_.command[i];
    if (!measured_) return integral[i - s.from] + x * u;
    const double slope = (rows_.command[i + 1] - u) / (rows_.time_s[i + 1] - rows_.time_s[i]);
    return integral[i - s.from] + x * (u + 0.5 * slope * x);
  }

  const TableRows& rows_;
  bool measured_;
  double rate_Hz_, ended_s_ = 0.0;
};

}  // namespace

TableRows Resample(const std::string& file, const TableRows& rows, bool measured, double rate_Hz, Grid& grid,
                   std::string& note) {
  DemandRisingTime(file, rows.time_s, rows.line);
  TableRows out;
  grid = {1.0 / rate_Hz, {}};
  Resampler resampler(rows, measured, rate_Hz);
  for (const Stretch& s : StretchesOf(rows.time_s))
    if (s.to - s.from >= 3) resampler.Take(s, out, grid.index);
  if (out.time_s.size() < 3) throw ConfigError({file + ": has fewer than three rows on the new grid"});
  note = "The rows of the log were put on a grid of " + RoundedText(rate_Hz) +
         " Hz, as --resample asks: positions by cubics between the rows, commands as their means.";
  return out;
}

}  // namespace contour::diagnosis
