#include "design/drive_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "design/evolution_search.h"

namespace contour {
namespace {

using Complex = std::complex<double>;

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr std::size_t kFewestLines = 12;
constexpr int kEvaluations = 9000;
/// No line is believed better than this, and none worse than the other is used.
constexpr double kLeastScatter = 0.02, kMostScatter = 0.5;
/// What a relative error counts at most: a mode that the model has elsewhere must not decide.
constexpr double kMostError = 1.0;
/// Ranges of the search, gains in 1/s of the axis's mass: from a loop that hardly holds to one that no
/// sampled drive has.
constexpr double kLeastVelocity_1_s = 20.0, kMostVelocity_1_s = 1e4;
constexpr double kLeastPosition_1_s = 3.0, kMostPosition_1_s = 3e3;
constexpr double kLeastIntegral_1_s = 0.3, kMostIntegral_1_s = 3e3;
constexpr double kMostLate_s = 3e-3;
constexpr double kMostOffsetPeriods = 4.0;
/// Of the stated masses and stiffness: what lies above the loop's bandwidth shows them, and a loop must not
/// make up for them.
constexpr double kLeastOfStated = 0.6, kMostOfStated = 1.6;

double Between(double low, double high, double share) { return low * std::pow(high / low, share); }

DriveLoop LoopAt(const std::vector<double>& x, double mass_kg, double period_s) {
  return {.velocity_Ns_m = mass_kg * Between(kLeastVelocity_1_s, kMostVelocity_1_s, x[0]),
          .position_1_s = Between(kLeastPosition_1_s, kMostPosition_1_s, x[1]),
          .integral_1_s = Between(kLeastIntegral_1_s, kMostIntegral_1_s, x[2]),
          .late_s = kMostLate_s * x[3],
          .offset_late_s = kMostOffsetPeriods * period_s * x[4]};
}

TwoInertiaAxis AxisAt(const std::vector<double>& x, TwoInertiaAxis axis) {
  const double mass = Between(kLeastOfStated, kMostOfStated, x[5]);
  axis.motor_mass_kg *= mass;
  axis.table_mass_kg *= mass;
  axis.stiffness_N_m *= Between(kLeastOfStated, kMostOfStated, x[6]);
  return axis;
}

double RelativeError(const DriveResponse::Line& line, const DriveLoopOn& on, double period_s) {
  return std::abs(line.compliance_m_N - on.OffsetToMotor(line.frequency_Hz, period_s)) /
         std::abs(line.compliance_m_N);
}

/// Position under a force of one newton in one period, by the inverse Fourier sum.
std::vector<double> ImpulseResponse(const DriveLoopOn& on, double period_s, std::size_t length) {
  std::vector<double> out(length, 0.0);
  const std::size_t lines = length / 2;
  std::vector<Complex> response(lines);
  for (std::size_t n = 1; n < lines; ++n)
    response[n] =
        on.OffsetToMotor(static_cast<double>(n) / (static_cast<double>(length) * period_s), period_s);
  for (std::size_t k = 0; k < length; ++k) {
    double sum = 0.0;
    for (std::size_t n = 1; n < lines; ++n)
      sum += (response[n] *
              std::polar(1.0, kTwoPi * static_cast<double>((n * k) % length) / static_cast<double>(length)))
                 .real();
    out[k] = 2.0 * sum / static_cast<double>(length);
  }
  return out;
}

}  // namespace

DriveFit FitDrive(const DriveResponse& response, const TwoInertiaAxis& axis, double period_s) {
  std::vector<DriveResponse::Line> lines;
  for (const auto& line : response.lines)
    if (line.scatter_rel < kMostScatter && std::abs(line.compliance_m_N) > 0.0) lines.push_back(line);
  if (lines.size() < kFewestLines)
    throw std::runtime_error("the response of the drive's loop shows at " + std::to_string(lines.size()) +
                             " frequencies only: more torque or more strokes are needed");
  const double mass_kg = axis.motor_mass_kg + axis.table_mass_kg;
  const auto cost = [&](const std::vector<double>& x) {
    const DriveLoopOn on(AxisAt(x, axis), LoopAt(x, mass_kg, period_s));
    double sum = 0.0;
    for (const auto& line : lines) {
      const double error = std::min(RelativeError(line, on, period_s), kMostError);
      const double scatter = std::max(line.scatter_rel, kLeastScatter);
      sum += error * error / (scatter * scatter);
    }
    return sum;
  };
  SearchResult best;
  std::uint64_t seed = 0;
  for (const double fast : {0.4, 0.55, 0.7}) {
    const EvolutionOptions options{.first_step = 0.15, .evaluations = kEvaluations / 3, .seed = ++seed};
    const SearchResult found = EvolutionSearch(cost, {fast, fast, 0.5, 0.1, 0.4, 0.5, 0.5}, options);
    if (best.best.empty() || found.cost < best.cost) best = found;
  }
  DriveFit out;
  out.loop = LoopAt(best.best, mass_kg, period_s);
  // Both are the same to what a force does: (s + position) (s + integral). Which is which does not show.
  if (out.loop.position_1_s < out.loop.integral_1_s) std::swap(out.loop.position_1_s, out.loop.integral_1_s);
  out.axis = AxisAt(best.best, axis);
  out.lines = lines.size();
  std::vector<double> errors;
  const DriveLoopOn on(out.axis, out.loop);
  for (const auto& line : lines) {
    errors.push_back(RelativeError(line, on, period_s));
    out.highest_Hz = std::max(out.highest_Hz, line.frequency_Hz);
  }
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2),
                   errors.end());
  out.error_rel = errors[errors.size() / 2];
  return out;
}

AccelerationShare MissingAcceleration(std::span<const DriveSample> samples, const TwoInertiaAxis& axis,
                                      const DriveLoop& loop, double period_s) {
  const auto length = static_cast<std::size_t>(std::lround(0.5 / period_s));
  DriveLoop at_once = loop;
  // The drive's own feed-forward acts with its target, half a period before a target is reached in the mean.
  at_once.offset_late_s = loop.late_s;
  const std::vector<double> impulse = ImpulseResponse(DriveLoopOn(axis, at_once), period_s, length);
  const double mass_kg = axis.motor_mass_kg + axis.table_mass_kg;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double square = 0.0;
  std::size_t rows = 0;
  for (std::size_t k = length; k < samples.size(); ++k) {
    const DriveSample& s = samples[k];
    if (!s.good || s.extra_N != 0.0 || s.velocity_m_s == 0.0) continue;
    double given_m = 0.0;
    for (std::size_t j = 0; j < length; ++j)
      given_m += impulse[j] * mass_kg * samples[k - j].acceleration_m_s2;
    // A target is for two periods after its row, and a drive is half a period behind its targets, on a curve
    // through them.
    const double wanted_m = 0.5 * (samples[k - 2].target_m + samples[k - 3].target_m) -
                            0.125 * period_s * period_s * s.acceleration_m_s2;
    const Eigen::Vector3d row(given_m, s.velocity_m_s, s.velocity_m_s > 0.0 ? 1.0 : -1.0);
    normal += row * row.transpose();
    right += row * (wanted_m - s.position_m);
    square += (wanted_m - s.position_m) * (wanted_m - s.position_m);
    ++rows;
  }
  if (rows < length) return {0.0, 1.0};
  // Each column has its own unit.
  const Eigen::Vector3d unit = normal.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::Matrix3d scaled = unit.asDiagonal() * normal * unit.asDiagonal();
  const Eigen::Matrix3d inverse = scaled.inverse();
  const Eigen::Vector3d found = unit.asDiagonal() * (inverse * (unit.asDiagonal() * right));
  const double left = std::max(0.0, square - found.dot(right));
  // Errors last as long as the loop takes to settle, a tenth of the response's length.
  const double independent = static_cast<double>(rows) / (0.1 * static_cast<double>(length));
  const double variance = left / static_cast<double>(rows) * unit(0) * unit(0) * inverse(0, 0) *
                          static_cast<double>(rows) / independent;
  return {found(0), std::sqrt(variance)};
}

}  // namespace contour
