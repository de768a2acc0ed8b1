#include "analysis/circle_test/circle_test.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <stdexcept>

namespace contour {
namespace {

constexpr double kMicro = 1e6;
constexpr std::size_t kReadings = 360;  // per turn
constexpr double kTwoPi = 2.0 * std::numbers::pi;
// Points of a turn at which record and measurement meet.
constexpr std::size_t kBins = 720;
// What is measured hangs together over a part of the turn: errors are counted in blocks.
constexpr std::size_t kBlocks = 36;
// A wobble can be told from the circle's other errors when an axis goes over two thirds of a turn and more.
constexpr double kLeastTurns = 0.67;
// By so much of the radius the widths in the two axes may differ.
constexpr double kRoundness = 0.05;
// Of the highest speed: at less the path begins or ends.
constexpr double kFullSpeed = 0.98;
constexpr double kMostShareStd = 0.1;
constexpr double kMostShare = 0.9;
// An estimate below zero by less than this is a share of none.
constexpr double kSigmas = 3.0;

/// The circle that the motors went.
struct Motion {
  std::array<double, kCircleAxes> centre_m{};
  double radius_m = 0.0;
  double rate_rad_s = 0.0;  ///< signed
  RowRange turns;           ///< whole ones
};

double AngleOf(const CircleRow& row, const Motion& m) {
  return std::atan2(row.motor_m[1] - m.centre_m[1], row.motor_m[0] - m.centre_m[0]);
}
double Wrapped(double angle) { return angle - kTwoPi * std::floor(angle / kTwoPi); }

RowRange AtFullSpeed(const std::vector<CircleRow>& rows) {
  double highest_m_s = 0.0;
  for (const CircleRow& row : rows) highest_m_s = std::max(highest_m_s, row.speed_m_s);
  RowRange best;
  for (std::size_t from = 0; from < rows.size(); ++from) {
    std::size_t to = from;
    while (to < rows.size() && rows[to].speed_m_s > kFullSpeed * highest_m_s) ++to;
    if (to - from > best.end - best.begin) best = {from, to};
    from = to;
  }
  if (best.end - best.begin < kBins)
    throw std::invalid_argument(
        "the record has too few rows at one speed: at least a turn of a circle is needed");
  return best;
}

/// Between the outermost places of the motors. Throws when they are those of no circle.
Motion BoundsOf(const std::vector<CircleRow>& rows, const RowRange& range) {
  Motion m;
  std::array<double, kCircleAxes> width_m{};
  for (std::size_t i = 0; i < kCircleAxes; ++i) {
    double low_m = rows[range.begin].motor_m[i], high_m = low_m;
    for (std::size_t k = range.begin; k < range.end; ++k) {
      low_m = std::min(low_m, rows[k].motor_m[i]);
      high_m = std::max(high_m, rows[k].motor_m[i]);
    }
    m.centre_m[i] = 0.5 * (low_m + high_m);
    width_m[i] = high_m - low_m;
  }
  m.radius_m = 0.25 * (width_m[0] + width_m[1]);
  if (!(m.radius_m > 0.0) || std::abs(width_m[0] - width_m[1]) > kRoundness * m.radius_m)
    throw std::invalid_argument("the recorded motion is no circle of the two axes");
  return m;
}

/// Whole turns at constant rate, the first left out where there are more: the axes settle on it.
Motion MotionOf(const std::vector<CircleRow>& rows) {
  const RowRange range = AtFullSpeed(rows);
  Motion m = BoundsOf(rows, range);
  std::vector<double> turned_rad{0.0};
  for (std::size_t k = range.begin + 1; k < range.end; ++k) {
    const double step = AngleOf(rows[k], m) - AngleOf(rows[k - 1], m);
    turned_rad.push_back(turned_rad.back() + step - kTwoPi * std::round(step / kTwoPi));
  }
  const double all_rad = std::abs(turned_rad.back());
  const double whole = std::floor(all_rad / kTwoPi);
  if (whole < 1.0) throw std::invalid_argument("the recorded circle is less than one turn");
  const double from_rad = all_rad - kTwoPi * std::max(1.0, whole - 1.0);
  const auto first = std::find_if(turned_rad.begin(), turned_rad.end(),
                                  [&](double angle) { return std::abs(angle) >= from_rad; });
  m.turns = {range.begin + static_cast<std::size_t>(first - turned_rad.begin()), range.end};
  m.rate_rad_s = (turned_rad.back() - *first) / (rows[range.end - 1].time_s - rows[m.turns.begin].time_s);
  return m;
}

/// Means over the turns, by angle.
struct Bin {
  double count = 0.0;
  std::array<double, kCircleAxes> motor_m{}, friction_N{};
};

std::vector<Bin> BinsOf(const std::array<CircleAxis, kCircleAxes>& axes, const std::vector<CircleRow>& rows,
                        const Motion& m) {
  std::vector<Bin> bins(kBins);
  for (std::size_t k = m.turns.begin; k < m.turns.end; ++k) {
    const double turn = Wrapped(AngleOf(rows[k], m)) / kTwoPi;
    Bin& bin = bins[std::min(static_cast<std::size_t>(turn * kBins), kBins - 1)];
    bin.count += 1.0;
    for (std::size_t i = 0; i < kCircleAxes; ++i) {
      const double accelerates_m_s2 = -m.rate_rad_s * m.rate_rad_s * (rows[k].motor_m[i] - m.centre_m[i]);
      bin.motor_m[i] += rows[k].motor_m[i];
      bin.friction_N[i] += rows[k].force_N[i] - axes[i].mass_kg * accelerates_m_s2;
    }
  }
  for (Bin& bin : bins)
    for (std::size_t i = 0; i < kCircleAxes && bin.count > 0.0; ++i) {
      bin.motor_m[i] /= bin.count;
      bin.friction_N[i] /= bin.count;
    }
  return bins;
}

/// The measured radius there, by straight lines between the points on either side.
class Measured {
 public:
  explicit Measured(std::vector<CirclePoint> points) : points_(std::move(points)) {
    for (CirclePoint& p : points_) p.angle_rad = Wrapped(p.angle_rad);
    std::sort(points_.begin(), points_.end(),
              [](const auto& a, const auto& b) { return a.angle_rad < b.angle_rad; });
    if (points_.size() < kBlocks) throw std::invalid_argument("the measured circle has too few points");
  }
  [[nodiscard]] std::optional<double> At(double angle_rad) const {
    const auto after = std::upper_bound(points_.begin(), points_.end(), angle_rad,
                                        [](double a, const auto& p) { return a < p.angle_rad; });
    const CirclePoint& b = after == points_.end() ? points_.front() : *after;
    const CirclePoint& a = after == points_.begin() ? points_.back() : *(after - 1);
    const double gap = Wrapped(b.angle_rad - a.angle_rad);
    if (gap > kTwoPi / kBlocks) return std::nullopt;
    const double share = gap > 0.0 ? Wrapped(angle_rad - a.angle_rad) / gap : 0.0;
    return a.radius_m + share * (b.radius_m - a.radius_m);
  }

 private:
  std::vector<CirclePoint> points_;
};

/// Unknowns in their order, lengths in um: centre and radius, which no instrument knows, then per axis share
/// and wobble.
struct Layout {
  std::array<Eigen::Index, kCircleAxes> share{}, sine{};
  std::array<bool, kCircleAxes> wobbles{};
  Eigen::Index size = 3;
};

Layout LayoutOf(const std::array<CircleAxis, kCircleAxes>& axes, const Motion& m) {
  Layout l;
  for (std::size_t i = 0; i < kCircleAxes; ++i) {
    l.share[i] = l.size++;
    l.wobbles[i] = 2.0 * m.radius_m > kLeastTurns * axes[i].lead_m;
    l.sine[i] = l.size;
    if (l.wobbles[i]) l.size += 2;
  }
  return l;
}

struct Equations {
  Eigen::MatrixXd rows;
  Eigen::VectorXd right;
  std::vector<std::size_t> block;
};

// The radius that is measured, less that of the motors and of the wind-up by the model, is what is not known:
// n . (centre + share F / K + wobble) + radius, n the direction from the centre.
Equations EquationsOf(const std::array<CircleAxis, kCircleAxes>& axes, const std::vector<Bin>& bins,
                      const Motion& m, const Measured& measured, const Layout& l) {
  Equations e{Eigen::MatrixXd::Zero(kBins, l.size), Eigen::VectorXd::Zero(kBins), {}};
  Eigen::Index at = 0;
  for (std::size_t b = 0; b < kBins; ++b) {
    const Bin& bin = bins[b];
    const double angle = kTwoPi * (static_cast<double>(b) + 0.5) / kBins;
    const std::optional<double> radius_m = measured.At(angle);
    if (bin.count == 0.0 || !radius_m) continue;
    const std::array<double, kCircleAxes> n{std::cos(angle), std::sin(angle)};
    double known_m = 0.0;
    e.rows(at, 2) = 1.0;
    for (std::size_t i = 0; i < kCircleAxes; ++i) {
      const CircleAxis& axis = axes[i];
      const double from_m = bin.motor_m[i] - m.centre_m[i];
      const double wound_m = (bin.friction_N[i] - axis.table_mass_kg * m.rate_rad_s * m.rate_rad_s * from_m) /
                             axis.stiffness_N_m;
      known_m += n[i] * (from_m - wound_m);
      e.rows(at, static_cast<Eigen::Index>(i)) = n[i];
      e.rows(at, l.share[i]) = n[i] * kMicro * bin.friction_N[i] / axis.stiffness_N_m;
      if (!l.wobbles[i]) continue;
      const double theta = kTwoPi * bin.motor_m[i] / axis.lead_m;
      e.rows(at, l.sine[i]) = n[i] * std::sin(theta);
      e.rows(at, l.sine[i] + 1) = n[i] * std::cos(theta);
    }
    e.right(at) = kMicro * (*radius_m - (known_m - m.radius_m));
    e.block.push_back(b * kBlocks / kBins);
    ++at;
  }
  if (at < static_cast<Eigen::Index>(kBins) / 2)
    throw std::invalid_argument("less than half of a turn was measured");
  e.rows.conservativeResize(at, l.size);
  e.right.conservativeResize(at);
  return e;
}

double Rms(const Eigen::VectorXd& v) { return std::sqrt(v.squaredNorm() / static_cast<double>(v.size())); }

/// What the nuisance alone leaves.
double BeforeOf(const Equations& e) {
  const Eigen::MatrixXd nuisance = e.rows.leftCols(3);
  return Rms(e.right - nuisance * nuisance.colPivHouseholderQr().solve(e.right));
}

/// Covariance of the solution when residuals hang together within blocks.
Eigen::MatrixXd CovarianceOf(const Equations& e, const Eigen::VectorXd& left,
                             const Eigen::MatrixXd& inverse) {
  const Eigen::Index n = e.rows.cols();
  std::vector<Eigen::VectorXd> score(kBlocks, Eigen::VectorXd::Zero(n));
  for (Eigen::Index k = 0; k < e.rows.rows(); ++k)
    score[e.block[static_cast<std::size_t>(k)]] += left(k) * e.rows.row(k).transpose();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
  for (const Eigen::VectorXd& s : score) sum += s * s.transpose();
  const double spare =
      static_cast<double>(kBlocks) / static_cast<double>(kBlocks - static_cast<std::size_t>(n));
  return spare * inverse * sum * inverse;
}

}  // namespace

RowRange TurnsOfCircle(const std::vector<CircleRow>& rows) { return MotionOf(rows).turns; }

CircleTestResult FitCircle(const std::array<CircleAxis, kCircleAxes>& axes,
                           const std::vector<CircleRow>& rows, const std::vector<CirclePoint>& measured) {
  const Motion motion = MotionOf(rows);
  const Layout layout = LayoutOf(axes, motion);
  const Equations e = EquationsOf(axes, BinsOf(axes, rows, motion), motion, Measured(measured), layout);
  const Eigen::MatrixXd normal = e.rows.transpose() * e.rows;
  const Eigen::MatrixXd inverse = normal.completeOrthogonalDecomposition().pseudoInverse();
  const Eigen::VectorXd found = e.rows.colPivHouseholderQr().solve(e.right);
  const Eigen::VectorXd left = e.right - e.rows * found;
  const Eigen::MatrixXd covariance = CovarianceOf(e, left, inverse);
  const auto take = [&](Eigen::Index i, double unit = 1.0) {
    return Found{unit * found(i), unit * std::sqrt(std::max(0.0, covariance(i, i)))};
  };
  CircleTestResult result;
  result.before_m = BeforeOf(e) / kMicro;
  result.after_m = Rms(left) / kMicro;
  for (std::size_t i = 0; i < kCircleAxes; ++i) {
    CircleAxisFound& axis = result.axes[i];
    axis.motor_share = take(layout.share[i]);
    axis.wobble_seen = layout.wobbles[i];
    if (!axis.wobble_seen) continue;
    axis.wobble_sine = take(layout.sine[i], 1.0 / kMicro);
    axis.wobble_cosine = take(layout.sine[i] + 1, 1.0 / kMicro);
  }
  return result;
}

std::vector<CirclePoint> RadiiOf(const std::vector<std::array<double, kCircleAxes>>& table_m) {
  const double count = static_cast<double>(table_m.size());
  std::array<double, kCircleAxes> centre{};
  for (const auto& p : table_m)
    for (std::size_t i = 0; i < kCircleAxes; ++i) centre[i] += p[i] / count;
  double mean_m = 0.0;
  std::array<double, kReadings> sum{}, readings{};
  for (const auto& p : table_m) {
    const double x = p[0] - centre[0], y = p[1] - centre[1], radius_m = std::hypot(x, y);
    const auto at = static_cast<std::size_t>(Wrapped(std::atan2(y, x)) / kTwoPi * kReadings) % kReadings;
    sum[at] += radius_m;
    readings[at] += 1.0;
    mean_m += radius_m / count;
  }
  std::vector<CirclePoint> points;
  for (std::size_t i = 0; i < kReadings; ++i)
    if (readings[i] > 0.0)
      points.push_back({kTwoPi * (static_cast<double>(i) + 0.5) / kReadings, sum[i] / readings[i] - mean_m});
  return points;
}

std::string WhatIsWrong(const CircleTestResult& result, const std::array<CircleAxis, kCircleAxes>& axes) {
  for (std::size_t i = 0; i < kCircleAxes; ++i) {
    const Found& share = result.axes[i].motor_share;
    char text[200];
    const char* why = nullptr;
    if (!(share.std <= kMostShareStd))
      why = "the circle does not tell it: a smaller or slower one has less but friction";
    else if (share.value < -kSigmas * share.std - 0.02)
      why = "less than none: the screw yields more than stated, or the measurement belongs to another circle";
    else if (share.value > kMostShare)
      why = "the measured table has no wind-up: is it the motor's own position?";
    if (why == nullptr) continue;
    std::snprintf(text, sizeof text, "axis %s: share of friction before the screw %.2f +- %.2f; %s",
                  axes[i].name.c_str(), share.value, share.std, why);
    return text;
  }
  return {};
}

}  // namespace contour
