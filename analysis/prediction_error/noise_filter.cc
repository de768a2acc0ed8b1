#include "analysis/prediction_error/noise_filter.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "analysis/diagnosis/tuning/prediction_tuning.h"
#include "analysis/prediction_error/simd/lane_linear.h"
#include "analysis/prediction_error/simd/lane_loops.h"

namespace contour::diagnosis {
namespace {

void ApplyAll(const LaneWhiten& whole, std::span<const double* const> in, std::span<double* const> out,
              std::span<const Segment> segments) {
  constexpr std::size_t kAtOnce = kMostGroups * kLanes;
  LaneWhiten m = whole;
  std::vector<double> spare(m.rows);
  for (std::size_t first = 0; first < in.size(); first += kAtOnce) {
    m.groups = in.size() - first > kLanes ? kMostGroups : 1;
    for (std::size_t i = 0; i < kAtOnce; ++i) {
      const bool used = first + i < in.size();
      m.in[i / kLanes][i % kLanes] = in[used ? first + i : first];
      m.out[i / kLanes][i % kLanes] = used ? out[first + i] : spare.data();
    }
    if (segments.empty()) BestLoops().whiten(m);
    for (const Segment& s : segments) {
      LaneWhiten part = m;
      part.rows = s.rows;
      part.counted += s.from;
      part.weight += s.at;
      if (m.states > 0) {
        part.step += s.from * m.stride;
        part.gain += s.from * static_cast<std::size_t>(m.states + 1);
      }
      for (std::size_t i = 0; i < kAtOnce; ++i) {
        part.in[i / kLanes][i % kLanes] += s.at;
        part.out[i / kLanes][i % kLanes] += s.at;
      }
      BestLoops().whiten(part);
    }
  }
}

}  // namespace

NoiseFilter::NoiseFilter(std::shared_ptr<const LinearModel> linear, const std::vector<std::uint8_t>& counted,
                         const NoiseSetup& setup, const NoiseFilter* before)
    : linear_(std::move(linear)) {
  const LinearModel& m = *linear_;
  const std::size_t n = m.rows;
  const double unit = setup.inertia / (setup.period_s * setup.period_s);
  const double reading = std::max(setup.reading_step * setup.reading_step / 12.0, 1e-24);
  levels_ = LikeliestLevels(m, {counted, setup.period_s, reading, unit, setup.slow_torque},
                            before != nullptr ? &before->levels_ : nullptr);
  const NoiseVariances noise = VariancesOf(levels_, reading, unit);
  states_ = FilterStates(m, noise);
  step_ = std::make_shared<const std::vector<float>>(levels_.slow_there ? WithSlowTorque(m, noise.keep)
                                                                        : StatesAlone(m));
  gain_.resize((n - 1) * (static_cast<std::size_t>(states_) + 1));
  LikelihoodSums sums;
  KalmanPass({m, counted, setup.period_s, 0, n}, noise, sums, gain_.data());
  torque_noise_ = std::sqrt(noise.torque * sums.squares / std::max(sums.count, 1.0));
  taps_.assign(kWhitenTaps, 0.0);
  taps_[0] = 1.0;
  std::vector<double> white(n), weight(n, 1.0);
  const double* in[] = {m.innovation.data()};
  double* out[] = {white.data()};
  Apply(in, out, counted, weight.data());
  const std::vector<double> taps = Whitener(white, counted).taps();
  std::copy(taps.begin(), taps.end(), taps_.begin());
}

std::size_t NoiseFilter::Stride() const {
  const auto n = static_cast<std::size_t>(states_);
  return n * (n + 1);
}

double NoiseFilter::LogVariances(const std::vector<std::uint8_t>& counted) const {
  const auto columns = static_cast<std::size_t>(states_) + 1;
  double sum = 0.0;
  for (std::size_t k = 1; k < counted.size(); ++k)
    if (counted[k] != 0) sum -= 2.0 * std::log(static_cast<double>(gain_[k * columns - 1]) * taps_[0]);
  return sum;
}

double NoiseFilter::ObserverBandwidth_Hz(double period_s) const {
  // The ratio is of what a row's torque moves the axis by, over the reading's noise: the index of
  // SteadyObserverGain, squared.
  return std::pow(10.0, 0.25 * levels_.log10_torque) / (2.0 * std::numbers::pi * period_s);
}

void NoiseFilter::Apply(std::span<const double* const> in, std::span<double* const> out,
                        const std::vector<std::uint8_t>& counted, const double* weight,
                        std::span<const Segment> segments) const {
  LaneWhiten m;
  m.rows = linear_->rows;
  m.stride = Stride();
  m.states = states_;
  m.step = step_->data();
  m.gain = gain_.data();
  m.taps = taps_.data();
  m.counted = counted.data();
  m.weight = weight;
  ApplyAll(m, in, out, segments);
}

std::vector<double> NoiseFilter::Pulse(std::size_t row, bool reading, std::size_t length,
                                       const std::vector<std::uint8_t>& counted) const {
  // Before the pulse there is nothing, and what comes after the length is not asked for.
  const std::size_t n = linear_->rows, from = row - std::min<std::size_t>(row, 1);
  const std::size_t first = reading ? row : row + 1, to = std::min(n, first + length), rows = to - from;
  LinearModel part;
  part.rows = rows;
  part.stride = linear_->stride;
  part.states = linear_->states;
  part.table_state = linear_->table_state;
  const auto at = linear_->step.begin() + static_cast<std::ptrdiff_t>(from * part.stride);
  part.step.assign(at, at + static_cast<std::ptrdiff_t>((rows - 1) * part.stride));
  const auto valid = linear_->valid.begin() + static_cast<std::ptrdiff_t>(from);
  part.valid.assign(valid, valid + static_cast<std::ptrdiff_t>(rows));
  auto pulse = std::make_shared<Signal>(reading ? rows : 2 * rows, 0.0);
  (*pulse)[row - from] = 1.0;
  if (!reading) (*pulse)[rows + row - from] = 1.0;
  LinearInput input;
  (reading ? input.reading_error : input.motor_force) = pulse;
  const auto run = LinearColumns(part, std::span(&input, 1), false);
  std::vector<double> white(rows);
  const std::vector<double> weight(rows, 1.0);
  const double* in[] = {run[0].innovation.data()};
  double* out[] = {white.data()};
  const Segment all{.from = from, .rows = rows};
  Apply(in, out, counted, weight.data(), std::span(&all, 1));
  white.resize(first - from + length, 0.0);
  return {white.begin() + static_cast<std::ptrdiff_t>(first - from), white.end()};
}

NoiseFilter::Gradient NoiseFilter::Back(const std::vector<double>& white,
                                        const std::vector<std::uint8_t>& counted,
                                        const double* weight) const {
  const LinearModel& m = *linear_;
  const std::size_t rows = m.rows;
  // No signal moves the slow torque, which is the last state where there is one.
  const auto own = static_cast<std::size_t>(m.states), n = static_cast<std::size_t>(states_);
  Gradient out{Signal(rows, 0.0), Signal(rows, 0.0), Signal(rows, 0.0)};
  // The colour filter backwards.
  std::vector<double> weighted(rows + kWhitenTaps, 0.0), b(rows);
  for (std::size_t k = 0; k < rows; ++k) weighted[k] = white[k] * weight[k];
  for (std::size_t k = 0; k < rows; ++k) {
    double sum = 0.0;
    for (std::size_t t = 0; t < kWhitenTaps; ++t) sum += taps_[t] * weighted[k + t];
    b[k] = counted[k] != 0 && k > 0 ? sum * static_cast<double>(gain_[(k - 1) * (n + 1) + n]) : 0.0;
  }
  // The error of the Kalman filter's state: q' = (A + kappa c) q + (B + kappa d) u + (G - kappa) r,
  // nu = -c q - d u + r.
  double eta[kMostStates] = {}, next[kMostStates] = {};
  for (std::size_t k = rows - 1; k-- > 0;) {
    const float* p = step_->data() + k * Stride();
    const float* c = p + n * n;
    const float* g = &m.step[k * m.stride + own * (own + 1)];
    const float* in = g + own;
    const float* gain = &gain_[k * (n + 1)];
    double along = 0.0;  // eta . kappa
    for (std::size_t i = 0; i < n; ++i) along += eta[i] * static_cast<double>(gain[i]);
    const double through = along - b[k + 1];
    double reading = b[k + 1] - along;
    for (std::size_t i = 0; i < own; ++i) reading += eta[i] * static_cast<double>(g[i]);
    // A reading_error that is more takes from the innovation.
    out.reading[k + 1] = m.valid[k + 1] != 0 ? -reading : 0.0;
    const auto input = [&](std::size_t which) {
      double sum = 0.0;
      for (const std::size_t w : {which, which + 1}) {
        const float* u = in + w * (own + 1);
        sum += static_cast<double>(u[0]) * through;
        for (std::size_t i = 0; i < own; ++i) sum += static_cast<double>(u[i + 1]) * eta[i];
      }
      return sum;
    };
    out.motor[k] = input(0);
    out.level[k] = input(4);
    for (std::size_t j = 0; j < n; ++j) {
      double sum = static_cast<double>(c[j]) * through;
      for (std::size_t i = 0; i < n; ++i) sum += static_cast<double>(p[i * n + j]) * eta[i];
      next[j] = sum;
    }
    std::copy_n(next, n, eta);
  }
  return out;
}

void ApplyColourFilter(const Whitener& whitener, std::span<const double* const> in,
                       std::span<double* const> out, const std::vector<std::uint8_t>& counted,
                       const double* weight, std::span<const Segment> segments) {
  std::vector<double> taps = whitener.taps();
  taps.resize(kWhitenTaps, 0.0);
  LaneWhiten m;
  m.rows = counted.size();
  m.taps = taps.data();
  m.counted = counted.data();
  m.weight = weight;
  ApplyAll(m, in, out, segments);
}

}  // namespace contour::diagnosis
