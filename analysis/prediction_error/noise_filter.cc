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

struct Noise {
  double torque = 0.0;   // variance over a row
  double reading = 0.0;  // variance
};

// The rows that a pass of the filter goes over.
struct Rows {
  const LinearModel& model;
  const std::vector<std::uint8_t>& counted;
  double period_s;
  std::size_t from, to;
};

// What -2 log likelihood is made of.
struct Sums {
  double squares = 0.0, logs = 0.0, count = 0.0;
};

// Adds to the sums; writes the gains of all transitions when asked to.
template <int n>
void Likelihood(const Rows& rows, const Noise& noise, Sums& sums, float* gains) {
  const LinearModel& m = rows.model;
  using Matrix = Eigen::Matrix<double, n, n>;
  using Vector = Eigen::Matrix<double, n, 1>;
  using FloatMatrix = Eigen::Matrix<float, n, n, Eigen::RowMajor>;
  using FloatVector = Eigen::Matrix<float, n, 1>;
  Matrix start = Matrix::Zero();
  start(0, 0) = noise.reading;
  start(1, 1) = noise.reading / (rows.period_s * rows.period_s);
  if (n >= 6) {
    start(4, 4) = start(0, 0);
    start(5, 5) = start(1, 1);
  }
  Matrix p = start;
  Vector x = Vector::Zero();
  auto begin = std::upper_bound(m.begins.begin(), m.begins.end(), rows.from);
  for (std::size_t k = rows.from; k + 1 < rows.to; ++k) {
    const float* at = &m.step[k * m.stride];
    const Matrix a = Eigen::Map<const FloatMatrix>(at).template cast<double>();
    const Vector c = Eigen::Map<const FloatVector>(at + n * n).template cast<double>();
    const Vector g = Eigen::Map<const FloatVector>(at + n * n + n).template cast<double>();
    const float* in = at + n * n + 2 * n;
    const double df = in[0], dt = in[n + 1];
    const Vector bf = Eigen::Map<const FloatVector>(in + 1).template cast<double>();
    const Vector bt = Eigen::Map<const FloatVector>(in + n + 2).template cast<double>();
    // White inside the row: its mean and, of three times the variance, its slope.
    const Vector b0 = bf + bt, b1 = bt - bf;
    const double d0 = df + dt, d1 = dt - df, q0 = noise.torque, q1 = 3.0 * noise.torque;
    const double r = m.valid[k + 1] != 0 ? noise.reading : 0.0;
    const Vector pc = p * c;
    const double s = c.dot(pc) + q0 * d0 * d0 + q1 * d1 * d1 + noise.reading;
    Vector kappa = Vector::Zero();
    if (r > 0.0) kappa = (-(a * pc) - b0 * (q0 * d0) - b1 * (q1 * d1) + g * r) / s;
    const double nu = r > 0.0 ? m.innovation[k + 1] + c.dot(x) : 0.0;
    if (gains != nullptr) {
      float* out = gains + k * (n + 1);
      for (int i = 0; i < n; ++i) out[i] = static_cast<float>(kappa(i));
      out[n] = static_cast<float>(1.0 / std::sqrt(s));
    }
    if (rows.counted[k + 1] != 0 && k >= rows.from + kNoise.settling_rows) {
      sums.squares += std::min(nu * nu / s, 100.0 * (sums.squares + 1.0) / (sums.count + 1.0));
      sums.logs += std::log(s);
      sums.count += 1.0;
    }
    x = a * x + kappa * nu;
    const Matrix f = a + kappa * c.transpose();
    const Vector h0 = b0 + kappa * d0, h1 = b1 + kappa * d1, hr = g - kappa;
    p = (f * p * f.transpose()).eval();
    p.noalias() += q0 * h0 * h0.transpose();
    p.noalias() += q1 * h1 * h1.transpose();
    p.noalias() += r * hr * hr.transpose();
    if (begin == m.begins.end() || *begin != k + 1) continue;
    p = start;
    x.setZero();
    ++begin;
  }
}

void Pass(const Rows& rows, const Noise& noise, Sums& sums, float* gains) {
  switch (rows.model.states) {
    case 4:
      return Likelihood<4>(rows, noise, sums, gains);
    case 5:
      return Likelihood<5>(rows, noise, sums, gains);
    case 6:
      return Likelihood<6>(rows, noise, sums, gains);
    default:
      return Likelihood<7>(rows, noise, sums, gains);
  }
}

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
                         double inertia, double period_s, double reading_step, const NoiseFilter* before)
    : linear_(std::move(linear)) {
  const LinearModel& m = *linear_;
  const std::size_t n = m.rows;
  // In units in which a torque as large as the reading's noise moves the axis in one row by as much.
  const double unit = inertia / (period_s * period_s);
  const double reading = std::max(reading_step * reading_step / 12.0, 1e-24);
  const auto noise_at = [&](double x) { return Noise{reading * unit * unit * std::pow(10.0, x), reading}; };
  // Some segments all over the log are enough for one number.
  constexpr std::size_t kSegments = kNoise.segments;
  const std::size_t length =
      std::min(n / kSegments, std::max(n / kNoise.segments_of_log, kNoise.segment_rows));
  const auto badness = [&](double x) {
    Sums sums;
    for (std::size_t i = 0; i < kSegments; ++i) {
      const std::size_t from = (n - length) * i / (kSegments - 1);
      Pass({m, counted, period_s, from, from + length}, noise_at(x), sums, nullptr);
    }
    return sums.count > 0.0 ? sums.count * std::log(sums.squares / sums.count + 1e-300) + sums.logs : 0.0;
  };
  double best = before != nullptr ? before->ratio_ : 0.0, lowest = std::numeric_limits<double>::infinity();
  const auto look = [&](double x) {
    const double b = badness(x);
    if (!(b < lowest)) return;
    lowest = b;
    best = x;
  };
  if (before != nullptr)
    look(best);
  else
    for (double x = -4.5; x <= 4.6; x += 1.5) look(x);
  for (const double step : {0.75, 0.375, 0.19, 0.09})
    for (const double x : {best - step, best + step}) look(x);
  ratio_ = best;
  gain_.resize((n - 1) * static_cast<std::size_t>(m.states + 1));
  Sums sums;
  Pass({m, counted, period_s, 0, n}, noise_at(best), sums, gain_.data());
  torque_noise_ = std::sqrt(noise_at(best).torque * sums.squares / std::max(sums.count, 1.0));
  taps_.assign(kWhitenTaps, 0.0);
  taps_[0] = 1.0;
  std::vector<double> white(n), weight(n, 1.0);
  const double* in[] = {m.innovation.data()};
  double* out[] = {white.data()};
  Apply(in, out, counted, weight.data());
  const std::vector<double> taps = Whitener(white, counted).taps();
  std::copy(taps.begin(), taps.end(), taps_.begin());
}

double NoiseFilter::LogVariances(const std::vector<std::uint8_t>& counted) const {
  const auto columns = static_cast<std::size_t>(linear_->states + 1);
  double sum = 0.0;
  for (std::size_t k = 1; k < counted.size(); ++k)
    if (counted[k] != 0) sum -= 2.0 * std::log(static_cast<double>(gain_[k * columns - 1]) * taps_[0]);
  return sum;
}

double NoiseFilter::ObserverBandwidth_Hz(double period_s) const {
  // The ratio is of what a row's torque moves the axis by, over the reading's noise: the index of
  // SteadyObserverGain, squared.
  return std::pow(10.0, 0.25 * ratio_) / (2.0 * std::numbers::pi * period_s);
}

void NoiseFilter::Apply(std::span<const double* const> in, std::span<double* const> out,
                        const std::vector<std::uint8_t>& counted, const double* weight,
                        std::span<const Segment> segments) const {
  LaneWhiten m;
  m.rows = linear_->rows;
  m.stride = linear_->stride;
  m.states = linear_->states;
  m.step = linear_->step.data();
  m.gain = gain_.data();
  m.taps = taps_.data();
  m.counted = counted.data();
  m.weight = weight;
  ApplyAll(m, in, out, segments);
}

std::vector<double> NoiseFilter::Pulse(std::size_t row, bool reading, std::size_t length,
                                       const std::vector<std::uint8_t>& counted) const {
  const std::size_t n = linear_->rows;
  auto pulse = std::make_shared<Signal>(reading ? n : 2 * n, 0.0);
  (*pulse)[row] = 1.0;
  if (!reading) (*pulse)[n + row] = 1.0;
  LinearInput input;
  (reading ? input.reading_error : input.motor_force) = pulse;
  const auto run = LinearColumns(*linear_, std::span(&input, 1), false);
  std::vector<double> white(n);
  const std::vector<double> weight(n, 1.0);
  const double* in[] = {run[0].innovation.data()};
  double* out[] = {white.data()};
  Apply(in, out, counted, weight.data());
  const std::size_t first = reading ? row : row + 1;
  white.resize(std::max(n, first + length), 0.0);
  return {white.begin() + static_cast<std::ptrdiff_t>(first),
          white.begin() + static_cast<std::ptrdiff_t>(first + length)};
}

NoiseFilter::Gradient NoiseFilter::Back(const std::vector<double>& white,
                                        const std::vector<std::uint8_t>& counted,
                                        const double* weight) const {
  const LinearModel& m = *linear_;
  const std::size_t rows = m.rows;
  const auto n = static_cast<std::size_t>(m.states);
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
    const float* p = &m.step[k * m.stride];
    const float* c = p + n * n;
    const float* g = c + n;
    const float* in = g + n;
    const float* gain = &gain_[k * (n + 1)];
    double along = 0.0;  // eta . kappa
    for (std::size_t i = 0; i < n; ++i) along += eta[i] * static_cast<double>(gain[i]);
    const double through = along - b[k + 1];
    double reading = b[k + 1] - along;
    for (std::size_t i = 0; i < n; ++i) reading += eta[i] * static_cast<double>(g[i]);
    // A reading_error that is more takes from the innovation.
    out.reading[k + 1] = m.valid[k + 1] != 0 ? -reading : 0.0;
    const auto input = [&](std::size_t which) {
      double sum = 0.0;
      for (const std::size_t w : {which, which + 1}) {
        const float* u = in + w * (n + 1);
        sum += static_cast<double>(u[0]) * through;
        for (std::size_t i = 0; i < n; ++i) sum += static_cast<double>(u[i + 1]) * eta[i];
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
