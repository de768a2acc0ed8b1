#include "tools/validation/emps/inverse_dynamics.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>

namespace contour::emps {
namespace {

constexpr double kSlowest_m_s = 2e-3;
constexpr double kMiddle_m = 0.12;

bool Counts(const Recording& r, std::size_t k) { return std::abs(r.slow_velocity_m_s[k]) > kSlowest_m_s; }

}  // namespace

ForceFit::ForceFit(const ForceTerms& terms, const Recording& r, const Segment& segment) : terms_(terms) {
  double best = std::numeric_limits<double>::infinity();
  double best_vs = vs_m_s_;
  for (const double vs : {3e-3, 5e-3, 8e-3, 12e-3, 18e-3, 27e-3}) {
    vs_m_s_ = vs;
    Solve(r, segment);
    const double residual = Residual_N(r, segment);
    if (residual < best) {
      best = residual;
      best_vs = vs;
    }
    if (!terms.stribeck) break;
  }
  vs_m_s_ = best_vs;
  Solve(r, segment);
}

void ForceFit::Row(const Recording& r, std::size_t k, std::vector<double>& c) const {
  c.clear();
  const double v = r.slow_velocity_m_s[k];
  const double sign = v > 0.0 ? 1.0 : -1.0;
  const double forward = v > 0.0 ? 1.0 : 0.0;
  c.push_back(r.slow_acceleration_m_s2[k]);
  c.push_back(v);
  c.push_back(sign);
  c.push_back(1.0);  // with a level per direction this is the same as the difference of the levels
  if (terms_.direction) c.push_back(v * forward);
  if (terms_.stribeck) {
    const double low = std::exp(-std::abs(v) / vs_m_s_);
    c.push_back(low * forward);
    c.push_back(low * (1.0 - forward));
  }
  if (terms_.stroke) {
    const double s = (r.slow_position_m[k] - kMiddle_m) / kMiddle_m;
    c.push_back(sign * s);
    c.push_back(sign * s * s);
  }
  if (terms_.ripple)
    for (const double order : {1.0, 2.0}) {
      const double angle = 2.0 * std::numbers::pi * order * r.slow_position_m[k] / kTurn_m;
      for (const double factor : {1.0, sign}) {
        c.push_back(factor * std::cos(angle));
        c.push_back(factor * std::sin(angle));
      }
    }
}

void ForceFit::Solve(const Recording& r, const Segment& segment) {
  std::vector<double> row;
  Row(r, segment.from, row);
  const auto n = static_cast<Eigen::Index>(row.size());
  ripple_column_ = row.size() - 8;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  for (std::size_t k = segment.from; k < segment.to; ++k) {
    if (!Counts(r, k)) continue;
    Row(r, k, row);
    const Eigen::Map<const Eigen::VectorXd> x(row.data(), n);
    normal += x * x.transpose();
    right += x * r.slow_force_N[k];
  }
  const Eigen::VectorXd solution = normal.ldlt().solve(right);
  coefficients_.assign(solution.begin(), solution.end());
}

double ForceFit::ResidualAt_N(const Recording& r, std::size_t k) const {
  if (!Counts(r, k)) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> row;
  Row(r, k, row);
  double force = r.slow_force_N[k];
  for (std::size_t i = 0; i < row.size(); ++i) force -= coefficients_[i] * row[i];
  return force;
}

double ForceFit::Residual_N(const Recording& r, const Segment& segment) const {
  double square = 0.0;
  std::size_t count = 0;
  for (std::size_t k = segment.from; k < segment.to; ++k) {
    const double left = ResidualAt_N(r, k);
    if (std::isnan(left)) continue;
    square += left * left;
    ++count;
  }
  return std::sqrt(square / static_cast<double>(count));
}

std::complex<double> ForceFit::OncePerTurn_N() const {
  return terms_.ripple
             ? std::complex<double>(coefficients_[ripple_column_], coefficients_[ripple_column_ + 1])
             : std::complex<double>();
}

ForceFit::Levels ForceFit::FrictionLevels() const {
  const double more = terms_.direction ? coefficients_[4] : 0.0;
  return {coefficients_[2] + coefficients_[3], coefficients_[2] - coefficients_[3], coefficients_[1] + more,
          coefficients_[1]};
}

}  // namespace contour::emps
