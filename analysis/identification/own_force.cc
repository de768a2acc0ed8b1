#include "analysis/identification/own_force.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "analysis/identification/linear_step.h"

namespace contour::identify {
namespace {

constexpr std::ptrdiff_t kTaps = 4;  ///< reports to either side of a period's middle

double Sinc(double x) {
  const double a = std::numbers::pi * x;
  return std::fabs(a) < 1e-9 ? 1.0 : std::sin(a) / a;
}

/// Weights of the reports around a period in the mean of a band-limited force over it: the integral of the
/// windowed sinc of each. The mean of both ends alone halves what is quick: 0.32 of a wave at a third of the
/// sampling rate is lost.
std::array<double, 2 * kTaps> MakeMeanWeights() {
  constexpr int kPoints = 512;
  std::array<double, 2 * kTaps> weight{};
  double sum = 0.0;
  for (std::ptrdiff_t j = 0; j < 2 * kTaps; ++j) {
    const double at = static_cast<double>(j - kTaps + 1);
    for (int i = 0; i < kPoints; ++i) {
      const double x = (i + 0.5) / kPoints - at;
      weight[static_cast<std::size_t>(j)] +=
          Sinc(x) * std::pow(std::cos(std::numbers::pi * x / (2.0 * kTaps + 1.0)), 2);
    }
    sum += weight[static_cast<std::size_t>(j)];
  }
  for (double& w : weight) w /= sum;
  return weight;
}
const std::array<double, 2 * kTaps>& MeanWeights() {
  static const std::array<double, 2 * kTaps> weights = MakeMeanWeights();
  return weights;
}

/// A ramp from 0 on behind two lags, and its integral: the offset's current has one, the answer's the other.
struct LaggedRamp {
  double lag;
  [[nodiscard]] double At(double t) const {
    return t <= 0.0 ? 0.0 : t - 2.0 * lag + std::exp(-t / lag) * (t + 2.0 * lag);
  }
  [[nodiscard]] double Sum(double t) const {
    if (t <= 0.0) return 0.0;
    return t * (0.5 * t - 2.0 * lag) + 3.0 * lag * lag - lag * std::exp(-t / lag) * (t + 3.0 * lag);
  }
};

/// What the means through the reports miss of the answer's ramp, in the periods before and after that in
/// which it begins; it has a bend within a period, which no band-limited force has.
std::array<double, 2 * kTaps + 1> MissedOfRamp(const TableAxis& axis, double period_s) {
  const std::array<double, 2 * kTaps>& weights = MeanWeights();
  const LaggedRamp ramp{std::max(axis.lag_s, kShortestLag_s) / period_s};
  const double begin =
      std::fmod(std::max(0.0, axis.delay_s) / period_s + 1e-9, 1.0) + axis.answer.delay_s / period_s;
  std::array<double, 2 * kTaps + 1> missed{};
  for (std::ptrdiff_t i = -kTaps; i <= kTaps; ++i) {
    const double at = static_cast<double>(i) - begin;
    double seen = 0.0;
    for (std::ptrdiff_t j = 0; j < 2 * kTaps; ++j)
      seen += weights[static_cast<std::size_t>(j)] * ramp.At(at + static_cast<double>(j - kTaps + 1));
    missed[static_cast<std::size_t>(i + kTaps)] = ramp.Sum(at + 1.0) - ramp.Sum(at) - seen;
  }
  return missed;
}

/// What is in force of the offset at each row's instant.
std::vector<double> OffsetBehindLag_N(const TableAxis& axis, const Measured& data) {
  const double delay_s = std::max(0.0, axis.delay_s);
  const auto whole = static_cast<std::size_t>(delay_s / data.period_s + 1e-9);
  const double edge_s = delay_s - static_cast<double>(whole) * data.period_s;
  const double lag_s = std::max(axis.lag_s, kShortestLag_s);
  const double left_older = std::exp(-edge_s / lag_s);
  const double left_newer = std::exp(-(data.period_s - edge_s) / lag_s);
  std::vector<double> at(data.size(), data.offset_N.front());
  for (std::size_t k = 0; k + 1 < data.size(); ++k) {
    const std::size_t now = k >= whole ? k - whole : 0;
    const double newer = data.offset_N[now];
    const double older = data.offset_N[now > 0 ? now - 1 : 0];
    const double f = older + (at[k] - older) * left_older;
    at[k + 1] = newer + (f - newer) * left_newer;
  }
  return at;
}

}  // namespace

OwnForce OwnForceOf(const TableAxis& axis, const Measured& data) {
  const std::array<double, 2 * kTaps>& weights = MeanWeights();
  OwnForce own;
  own.offset_N = OffsetBehindLag_N(axis, data);
  own.at_N.resize(data.size());
  for (std::size_t k = 0; k < data.size(); ++k) own.at_N[k] = data.reported_N[k] - own.offset_N[k];
  own.mean_N.resize(data.size());
  const auto last = static_cast<std::ptrdiff_t>(data.size()) - 1;
  const auto row = [last](std::ptrdiff_t k) {
    return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(k, 0, last));
  };
  const auto whole = static_cast<std::ptrdiff_t>(std::max(0.0, axis.delay_s) / data.period_s + 1e-9);
  const auto step_N = [&](std::ptrdiff_t period) {
    return data.offset_N[row(period - whole)] - data.offset_N[row(period - whole - 1)];
  };
  const std::array<double, 2 * kTaps + 1> missed = MissedOfRamp(axis, data.period_s);
  for (std::ptrdiff_t k = 0; k <= last; ++k) {
    double mean = 0.0;
    for (std::ptrdiff_t j = 0; j < 2 * kTaps; ++j)
      mean += weights[static_cast<std::size_t>(j)] * own.at_N[row(k + j - kTaps + 1)];
    for (std::ptrdiff_t i = -kTaps; i <= kTaps; ++i)
      mean -= axis.answer.gain * missed[static_cast<std::size_t>(i + kTaps)] * step_N(k - i);
    for (std::size_t i = 0; i < axis.answer.step.size(); ++i)
      mean += axis.answer.step[i] * step_N(k + 1 - static_cast<std::ptrdiff_t>(i));
    own.mean_N[row(k)] = mean;
  }
  return own;
}

bool SameOwnForce(const TableAxis& a, const TableAxis& b) {
  return a.delay_s == b.delay_s && a.lag_s == b.lag_s && a.answer.gain == b.answer.gain &&
         a.answer.delay_s == b.answer.delay_s && a.answer.step == b.answer.step;
}

double PartOfPeriod_N(double from_N, double to_N, double mean_N, double begin, double end) {
  // A parabola.
  const double bow_N = mean_N - 0.5 * (from_N + to_N);
  const auto sum = [&](double u) {
    return u * (from_N + u * (0.5 * (to_N - from_N) + bow_N * (3.0 - 2.0 * u)));
  };
  return (sum(end) - sum(begin)) / (end - begin);
}

}  // namespace contour::identify
