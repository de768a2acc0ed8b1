#include "analysis/prediction_error/kalman_pass.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "analysis/diagnosis/tuning/prediction_tuning.h"
#include "analysis/prediction_error/likelihoods.h"

namespace contour::diagnosis {
namespace {

/// x' = A x + B u + G r, innovation e = r - c x - d u; u: white torque's mean over the row and its slope, and
/// what drives the slow torque.
template <int n>
struct Transition {
  using Vector = Eigen::Matrix<double, n, 1>;
  Eigen::Matrix<double, n, n> a;
  Vector c, g;
  Vector mean, slope, drive;
  double d_mean = 0.0, d_slope = 0.0, d_drive = 0.0;
};

/// `own` states are the model's, one more is the slow torque.
template <int own, int n>
Transition<n> TransitionAt(const LinearModel& m, std::size_t k, double keep) {
  using OwnMatrix = Eigen::Matrix<float, own, own, Eigen::RowMajor>;
  using OwnVector = Eigen::Matrix<float, own, 1>;
  const float* at = &m.step[k * m.stride];
  const float* in = at + own * own + 2 * own;
  const auto column = [](const float* from) {
    typename Transition<n>::Vector v = Transition<n>::Vector::Zero();
    v.template head<own>() = Eigen::Map<const OwnVector>(from).template cast<double>();
    return v;
  };
  Transition<n> t;
  t.a.setZero();
  t.a.template topLeftCorner<own, own>() = Eigen::Map<const OwnMatrix>(at).template cast<double>();
  t.c = column(at + own * own);
  t.g = column(at + own * own + own);
  const double d_from = in[0], d_to = in[own + 1];
  const typename Transition<n>::Vector from = column(in + 1), to = column(in + own + 2);
  // White inside the row.
  t.mean = from + to;
  t.slope = to - from;
  t.d_mean = d_from + d_to;
  t.d_slope = d_to - d_from;
  t.drive = to;
  t.d_drive = d_to;
  if constexpr (n > own) {
    t.a.col(own) = from + keep * to;
    t.a(own, own) = keep;
    t.c(own) = d_from + keep * d_to;
    t.drive(own) = 1.0;
  }
  return t;
}

template <int own, int n>
Eigen::Matrix<double, n, n> VarianceAtStart(const NoiseVariances& noise, double period_s) {
  Eigen::Matrix<double, n, n> p = Eigen::Matrix<double, n, n>::Zero();
  p(0, 0) = noise.reading;
  p(1, 1) = noise.reading / (period_s * period_s);
  if constexpr (own >= 6) {
    p(4, 4) = p(0, 0);
    p(5, 5) = p(1, 1);
  }
  if constexpr (n > own) p(own, own) = noise.slow;
  return p;
}

template <int own, int n>
void Pass(const PassRows& rows, const NoiseVariances& noise, LikelihoodSums& sums, float* gains) {
  const LinearModel& m = rows.model;
  using Matrix = Eigen::Matrix<double, n, n>;
  using Vector = Eigen::Matrix<double, n, 1>;
  // Of the torque's mean over a row, and of three times that variance its slope.
  const double q_mean = noise.torque, q_slope = 3.0 * noise.torque;
  const double q_drive = n > own ? noise.slow * (1.0 - noise.keep * noise.keep) : 0.0;
  const Matrix start = VarianceAtStart<own, n>(noise, rows.period_s);
  Matrix p = start;
  Vector x = Vector::Zero();
  auto begin = std::upper_bound(m.begins.begin(), m.begins.end(), rows.from);
  for (std::size_t k = rows.from; k + 1 < rows.to; ++k) {
    const Transition<n> t = TransitionAt<own, n>(m, k, noise.keep);
    const double r = m.valid[k + 1] != 0 ? noise.reading : 0.0;
    const Vector pc = p * t.c;
    double s = t.c.dot(pc) + q_mean * t.d_mean * t.d_mean + q_slope * t.d_slope * t.d_slope + noise.reading;
    if constexpr (n > own) s += q_drive * t.d_drive * t.d_drive;
    Vector kappa = Vector::Zero();
    if (r > 0.0) {
      kappa = -(t.a * pc) - t.mean * (q_mean * t.d_mean) - t.slope * (q_slope * t.d_slope) + t.g * r;
      if constexpr (n > own) kappa -= t.drive * (q_drive * t.d_drive);
      kappa /= s;
    }
    const double nu = r > 0.0 ? m.innovation[k + 1] + t.c.dot(x) : 0.0;
    if (gains != nullptr) {
      float* out = gains + k * (n + 1);
      for (int i = 0; i < n; ++i) out[i] = static_cast<float>(kappa(i));
      out[n] = static_cast<float>(1.0 / std::sqrt(s));
    }
    if (rows.counted[k + 1] != 0 && k >= rows.from + kNoise.settling_rows) {
      sums.squares += std::min(nu * nu / s, kMostSquare * (sums.squares + 1.0) / (sums.count + 1.0));
      sums.logs += std::log(s);
      sums.count += 1.0;
    }
    x = t.a * x + kappa * nu;
    const Matrix f = t.a + kappa * t.c.transpose();
    const Vector by_mean = t.mean + kappa * t.d_mean, by_slope = t.slope + kappa * t.d_slope;
    const Vector by_reading = t.g - kappa;
    p = (f * p * f.transpose()).eval();
    p.noalias() += q_mean * by_mean * by_mean.transpose();
    p.noalias() += q_slope * by_slope * by_slope.transpose();
    p.noalias() += r * by_reading * by_reading.transpose();
    if constexpr (n > own) {
      const Vector by_drive = t.drive + kappa * t.d_drive;
      p.noalias() += q_drive * by_drive * by_drive.transpose();
    }
    if (begin == m.begins.end() || *begin != k + 1) continue;
    p = start;
    x.setZero();
    ++begin;
  }
}

template <int own>
void PassOf(const PassRows& rows, const NoiseVariances& noise, LikelihoodSums& sums, float* gains) {
  noise.slow > 0.0 ? Pass<own, own + 1>(rows, noise, sums, gains) : Pass<own, own>(rows, noise, sums, gains);
}

}  // namespace

double LikelihoodSums::Unlikely() const {
  return count > 0.0 ? count * std::log(squares / count + 1e-300) + logs : 0.0;
}

int FilterStates(const LinearModel& model, const NoiseVariances& noise) {
  return model.states + (noise.slow > 0.0 ? 1 : 0);
}

void KalmanPass(const PassRows& rows, const NoiseVariances& noise, LikelihoodSums& sums, float* gains) {
  switch (rows.model.states) {
    case 4:
      return PassOf<4>(rows, noise, sums, gains);
    case 5:
      return PassOf<5>(rows, noise, sums, gains);
    case 6:
      return PassOf<6>(rows, noise, sums, gains);
    default:
      return PassOf<7>(rows, noise, sums, gains);
  }
}

std::vector<float> StatesAlone(const LinearModel& model) {
  const auto own = static_cast<std::size_t>(model.states), stride = own * (own + 1);
  std::vector<float> out;
  out.reserve((model.rows - 1) * stride);
  for (std::size_t k = 0; k + 1 < model.rows; ++k) {
    const float* at = &model.step[k * model.stride];
    out.insert(out.end(), at, at + stride);
  }
  return out;
}

std::vector<float> WithSlowTorque(const LinearModel& model, double keep) {
  const auto own = static_cast<std::size_t>(model.states), n = own + 1, stride = n * (n + 1);
  const auto kept = static_cast<float>(keep);
  std::vector<float> out((model.rows - 1) * stride, 0.0F);
  for (std::size_t k = 0; k + 1 < model.rows; ++k) {
    const float* at = &model.step[k * model.stride];
    const float* in = at + own * own + 2 * own;
    float* to = &out[k * stride];
    for (std::size_t i = 0; i < own; ++i) {
      std::copy_n(at + i * own, own, to + i * n);
      to[i * n + own] = in[1 + i] + kept * in[own + 2 + i];
    }
    to[own * n + own] = kept;
    std::copy_n(at + own * own, own, to + n * n);
    to[n * n + own] = in[0] + kept * in[own + 1];
  }
  return out;
}

}  // namespace contour::diagnosis
