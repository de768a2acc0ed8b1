#include "analysis/rough_fit/rough_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/rough_fit/smoothed_motion.h"

namespace contour::diagnosis {
namespace {

constexpr std::size_t kFewestRows = 100;
/// [places] Of the travel, at which visits are counted.
constexpr std::size_t kPlaces = 48;

/// The median over the places of the travel: an axis that rests between two of them comes to these often.
double VisitsOf(const Signal& position, double low, double travel) {
  std::vector<double> visits(kPlaces, 0.0);
  std::size_t before = kPlaces;
  for (const double q : position) {
    const auto place = static_cast<std::size_t>((q - low) / travel * static_cast<double>(kPlaces));
    const std::size_t at = std::min(place, kPlaces - 1);
    if (at != before) ++visits[at];
    before = at;
  }
  const auto middle = visits.begin() + static_cast<std::ptrdiff_t>(kPlaces / 2);
  std::nth_element(visits.begin(), middle, visits.end());
  return *middle;
}

/// Acceleration, Coulomb friction up and down, viscous friction, and the position where asked for.
template <int kColumns>
Eigen::Vector<double, kColumns> RowOf(const SmoothedMotion& m, std::size_t k, const RoughFit& out) {
  const double v = m.velocity[k];
  Eigen::Vector<double, kColumns> x;
  x.template head<4>() << m.acceleration[k], v > 0.0 ? 1.0 : 0.0, v < 0.0 ? -1.0 : 0.0, v;
  if constexpr (kColumns > 4) x(4) = m.position[k] - out.middle;
  return x;
}

/// Deviations by the sums of the parts (White, Econometrica 48(4), 1980, over clusters).
template <int kColumns>
void ByParts(const SmoothedMotion& m, const Eigen::Vector<double, kColumns>& x,
             const Eigen::Matrix<double, kColumns, kColumns>& inverse, RoughFit& out) {
  using Matrix = Eigen::Matrix<double, kColumns, kColumns>;
  Matrix sums = Matrix::Zero();
  const std::size_t n = m.counts.size();
  for (std::size_t part = 0; part < kPartsOfLog; ++part) {
    Eigen::Vector<double, kColumns> sum = Eigen::Vector<double, kColumns>::Zero();
    for (std::size_t k = n * part / kPartsOfLog; k < n * (part + 1) / kPartsOfLog; ++k) {
      if (!m.Slides(k)) continue;
      const auto row = RowOf<kColumns>(m, k, out);
      sum += row * (m.command[k] - row.dot(x));
    }
    sums += sum * sum.transpose();
  }
  const double of_freedom = static_cast<double>(kPartsOfLog) / static_cast<double>(kPartsOfLog - kColumns);
  const Matrix covariance = of_freedom * inverse * sums * inverse;
  const auto relative = [&](double variance, double value) {
    return std::sqrt(std::max(0.0, variance)) / std::max(std::fabs(value), 1e-300);
  };
  const double directions = out.one_direction ? 1.0 : 0.5;
  out.inertia_by_parts = relative(covariance(0, 0), x(0));
  out.coulomb_by_parts =
      relative(directions * directions * covariance.template block<2, 2>(1, 1).sum(), out.coulomb);
  out.viscous_by_parts = relative(covariance(3, 3), x(3));
}

/// A direction that the log has not gets no friction.
template <int kColumns>
void Solve(const SmoothedMotion& m, RoughFit& out) {
  using Matrix = Eigen::Matrix<double, kColumns, kColumns>;
  using Vector = Eigen::Vector<double, kColumns>;
  Matrix normal = Matrix::Zero();
  Vector right = Vector::Zero();
  double squares = 0.0, rows = 0.0;
  for (std::size_t k = 0; k < m.counts.size(); ++k) {
    if (!m.Slides(k)) continue;
    const Vector x = RowOf<kColumns>(m, k, out);
    normal += x * x.transpose();
    right += x * m.command[k];
    squares += m.command[k] * m.command[k];
    rows += 1.0;
  }
  if (rows < static_cast<double>(kFewestRows)) {
    out.why_not = "the axis hardly moves in it";
    return;
  }
  const bool up = normal(1, 1) > 0.0, down = normal(2, 2) > 0.0;
  out.one_direction = !(up && down);
  for (int i = 1; i < 3; ++i)
    if (normal(i, i) == 0.0) normal(i, i) = 1.0;
  // In units in which every column has length 1.
  const Vector unit = normal.diagonal().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
  const Matrix scaled = unit.asDiagonal() * normal * unit.asDiagonal();
  const Matrix inverse = (scaled + 1e-9 * Matrix::Identity()).inverse();
  const Vector x = unit.cwiseProduct(inverse * unit.cwiseProduct(right));
  const double left = std::max(0.0, squares - x.dot(right)) / rows;
  const auto sigma = [&](int i) { return std::sqrt(left * inverse(i, i) * m.independent_rows) * unit(i); };
  out.inertia = x(0);
  out.inflation = inverse(0, 0);
  out.inertia_sigma_rel = sigma(0) / std::max(std::fabs(x(0)), 1e-300);
  out.coulomb_forth = up ? x(1) : 0.0;
  out.coulomb_back = down ? x(2) : 0.0;
  out.coulomb = ((up ? x(1) : 0.0) + (down ? x(2) : 0.0)) / (static_cast<int>(up) + static_cast<int>(down));
  out.coulomb_sigma = std::max(up ? sigma(1) : 0.0, down ? sigma(2) : 0.0);
  out.viscous = x(3);
  out.unexplained = left * rows / squares;
  out.typical = std::sqrt(squares / rows);
  ByParts<kColumns>(m, x, unit.asDiagonal() * inverse * unit.asDiagonal(), out);
}

}  // namespace

RoughFit FitRoughly(const AxisLog& log, const StatedAxis& stated, RoughShape shape,
                    const StatedFriction* falling) {
  RoughFit out;
  const SmoothedMotion m = SmoothMotion(log, stated, falling);
  out.max_speed = m.max_speed;
  const auto [low, high] = std::minmax_element(m.position.begin(), m.position.end());
  out.travel = *high - *low;
  out.middle = 0.5 * (*high + *low);
  if (!(out.travel > 0.0 && out.max_speed > 0.0)) {
    out.why_not = "the axis does not move in it";
    return out;
  }
  out.visits = VisitsOf(m.position, *low, out.travel);
  if (shape == RoughShape::kFriction)
    Solve<4>(m, out);
  else
    Solve<5>(m, out);
  return out;
}

}  // namespace contour::diagnosis
