#include "analysis/identification/response_fit.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>
#include <utility>

namespace contour::identify {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
/// [of the sampling rate] Above it a second difference is an acceleration no more: a quarter is missing.
constexpr double kHighest_share = 0.3;
/// A coherence of 1 has no noise; what the windows smear is left.
constexpr double kLeastNoise = 0.02;
/// Starts: shares of the table in all that moves, and of the part in the table; frequencies a tenth apart.
constexpr double kShares[] = {0.1, 0.25, 0.5};
constexpr double kSideShares[] = {0.05, 0.12, 0.25};
constexpr double kNext = 1.1;
/// So many of the best are fitted, half a second of work in all.
constexpr std::size_t kRefined = 16;
constexpr int kMostEvaluations = 2000;

/// Logarithms of motor, table, stiffness and damping; logit of the part's share, logarithms of its frequency
/// and damping ratio; the delay in periods.
enum Number { kMotor, kTable, kStiffness, kDamping, kShare, kFrequency, kRatio, kDelay, kNumbers };
using Numbers = Eigen::VectorXd;

struct Measurement {
  std::complex<double> s, accelerance;
  double weight;
};

/// Motor's acceleration per force: two masses on the screw, the swinging part on its spring.
std::complex<double> Accelerance(const Numbers& q, std::complex<double> s, double viscous_Ns_m,
                                 double period_s) {
  const double table_kg = std::exp(q(kTable)), side_kg = table_kg / (1.0 + std::exp(-q(kShare)));
  const double frequency = kTwoPi * std::exp(q(kFrequency));
  const double spring = side_kg * frequency * frequency;
  const std::complex<double> side = spring + 2.0 * std::exp(q(kRatio)) * side_kg * frequency * s;
  const std::complex<double> screw = std::exp(q(kStiffness)) + std::exp(q(kDamping)) * s;
  const std::complex<double> swings = side_kg * s * s * side / (side_kg * s * s + side);
  const std::complex<double> table = (table_kg - side_kg) * s * s + swings + viscous_Ns_m * s;
  const std::complex<double> motor = std::exp(q(kMotor)) * s * s + screw * table / (screw + table);
  return s * s / motor * std::exp(-s * q(kDelay) * period_s);
}

/// Differences of logarithms: of size and phase.
struct Residuals {
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  const std::vector<Measurement>& measured;
  double viscous_Ns_m, period_s;

  [[nodiscard]] int inputs() const { return kNumbers; }
  [[nodiscard]] int values() const { return static_cast<int>(2 * measured.size()); }
  int operator()(const Eigen::VectorXd& q, Eigen::VectorXd& out) const {
    for (std::size_t i = 0; i < measured.size(); ++i) {
      const Measurement& m = measured[i];
      const std::complex<double> off = std::log(Accelerance(q, m.s, viscous_Ns_m, period_s) / m.accelerance);
      const auto at = static_cast<Eigen::Index>(2 * i);
      out(at) = std::isfinite(off.real()) ? m.weight * off.real() : 1e3;
      out(at + 1) = std::isfinite(off.imag()) ? m.weight * off.imag() : 1e3;
    }
    return 0;
  }
};

std::vector<Measurement> Coherent(const std::vector<ResponsePoint>& response, double period_s) {
  std::vector<Measurement> out;
  for (const ResponsePoint& p : response) {
    if (p.coherence <= kGoodCoherence || p.frequency_Hz > kHighest_share / period_s) continue;
    out.push_back({{0.0, kTwoPi * p.frequency_Hz},
                   std::polar(p.accelerance_1_kg, p.phase_rad),
                   std::sqrt(p.coherence / (1.0 - p.coherence + kLeastNoise))});
  }
  return out;
}

/// The best of a grid of antiresonances, frequencies of the part and shares.
std::vector<Numbers> Starts(const Residuals& residuals, double mass_kg, double low_Hz, double high_Hz) {
  std::vector<std::pair<double, Numbers>> tried;
  Eigen::VectorXd off(residuals.values());
  for (double screw_Hz = low_Hz; screw_Hz < high_Hz; screw_Hz *= kNext)
    for (double side_Hz = low_Hz; side_Hz < high_Hz; side_Hz *= kNext)
      for (const double share : kShares)
        for (const double side_share : kSideShares) {
          const double table_kg = share * mass_kg, motor_kg = mass_kg - table_kg;
          const double stiffness = table_kg * std::pow(kTwoPi * screw_Hz, 2);
          Numbers q(static_cast<Eigen::Index>(kNumbers));
          // Damping ratios of 0.03 and 0.02.
          q << std::log(motor_kg), std::log(table_kg), std::log(stiffness),
              std::log(0.06 * std::sqrt(stiffness * table_kg * motor_kg / mass_kg)),
              std::log(side_share / (1.0 - side_share)), std::log(side_Hz), std::log(0.02), 0.5;
          residuals(q, off);
          tried.emplace_back(off.squaredNorm(), q);
        }
  std::sort(tried.begin(), tried.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  if (tried.size() > kRefined) tried.resize(kRefined);
  std::vector<Numbers> starts;
  for (auto& [error, q] : tried) starts.push_back(std::move(q));
  return starts;
}

}  // namespace

std::optional<TableAxis> FitResponse(const TableAxis& axis, const std::vector<ResponsePoint>& response,
                                     double period_s) {
  const std::vector<Measurement> measured = Coherent(response, period_s);
  if (measured.size() < 2 * kNumbers) return {};
  const Residuals residuals{measured, axis.friction.s2, period_s};
  const double low_Hz = measured.front().s.imag() / kTwoPi, high_Hz = measured.back().s.imag() / kTwoPi;
  std::pair<double, Numbers> best{std::numeric_limits<double>::infinity(), {}};
  for (Numbers q : Starts(residuals, axis.mass_kg(), low_Hz, high_Hz)) {
    Eigen::NumericalDiff<Residuals, Eigen::Central> with_slopes(residuals);
    Eigen::LevenbergMarquardt<Eigen::NumericalDiff<Residuals, Eigen::Central>> fit(with_slopes);
    fit.parameters.maxfev = kMostEvaluations;
    fit.minimize(q);
    if (q.allFinite() && fit.fnorm < best.first) best = {fit.fnorm, q};
  }
  if (!std::isfinite(best.first)) return {};
  const Numbers& q = best.second;
  TableAxis out = axis;
  out.two_inertia = true;
  out.motor_inertia = std::exp(q(kMotor));
  out.load_inertia = std::exp(q(kTable));
  out.stiffness = std::exp(q(kStiffness));
  out.damping = std::exp(q(kDamping));
  out.side = {1.0 / (1.0 + std::exp(-q(kShare))), std::exp(q(kFrequency)), std::exp(q(kRatio))};
  return out;
}

}  // namespace contour::identify
