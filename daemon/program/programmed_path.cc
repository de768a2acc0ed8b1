#include "daemon/program/programmed_path.h"

#include <algorithm>
#include <utility>

namespace contour {
namespace {

// Of an arc, for Simpson's rule: its error is this to the fourth, over 2880, of the radius.
constexpr double kStep_rad = 0.05;

}  // namespace

ProgrammedPath::ProgrammedPath(std::vector<ProgrammedMove> moves, double from_m,
                               const std::optional<Extent>& travel)
    : moves_(std::move(moves)), travel_(travel) {
  begin_m_.reserve(moves_.size() + 1);
  double way_m = from_m;
  for (const ProgrammedMove& m : moves_) {
    begin_m_.push_back(way_m);
    way_m += m.curve.length_m;
  }
  begin_m_.push_back(way_m);
}

std::size_t ProgrammedPath::MoveAt(double way_m) const {
  const auto after = std::upper_bound(begin_m_.begin(), begin_m_.end() - 1, way_m);
  return after == begin_m_.begin() ? 0 : static_cast<std::size_t>(after - begin_m_.begin()) - 1;
}

PerAxis<double> ProgrammedPath::At(double way_m) const {
  const std::size_t i = MoveAt(way_m);
  const CurvePiece& curve = moves_[i].curve;
  return PointAt(curve, std::clamp(way_m - begin_m_[i], 0.0, curve.length_m)).position_m;
}

PerAxis<double> ProgrammedPath::Mean(double from_m, double to_m) const {
  const std::size_t first = MoveAt(from_m);
  if (to_m <= begin_m_[first + 1] && moves_[first].curve.radius_m == 0.0) return At(0.5 * (from_m + to_m));
  PerAxis<double> sum(axis_count());
  std::fill(sum.begin(), sum.end(), 0.0);
  for (std::size_t i = first; i < size() && begin_m_[i] < to_m; ++i) {
    const CurvePiece& curve = moves_[i].curve;
    const double begin = std::max(from_m - begin_m_[i], 0.0);
    const double end = std::min(to_m - begin_m_[i], curve.length_m);
    const int steps =
        curve.radius_m > 0.0 ? 1 + static_cast<int>((end - begin) / (kStep_rad * curve.radius_m)) : 1;
    const double step = (end - begin) / steps;
    for (int k = 0; k < steps; ++k) {
      const double at = begin + k * step;
      const auto a = PointAt(curve, at).position_m, b = PointAt(curve, at + 0.5 * step).position_m,
                 c = PointAt(curve, at + step).position_m;
      for (std::size_t n = 0; n < sum.size(); ++n) sum[n] += step / 6.0 * (a[n] + 4.0 * b[n] + c[n]);
    }
  }
  for (double& x : sum) x /= to_m - from_m;
  return sum;
}

double ProgrammedPath::Tolerance_m(double way_m) const {
  const std::size_t i = MoveAt(way_m);
  const bool first_half = way_m - begin_m_[i] < 0.5 * moves_[i].curve.length_m;
  return moves_[first_half && i > 0 ? i - 1 : i].tolerance_m;
}

}  // namespace contour
