#include "analysis/identification/joint_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <thread>

#include "analysis/identification/whitening.h"

namespace contour::identify {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kFollow_Hz = 60.0;

/// What two ways of stepping the same axis, this simulation and the emulated machine, were found to differ by
/// in these parameters (docs/commissioning.md): nothing is known better than that. Relative.
double Stepping(const std::string& key) {
  if (key == "screw_stiffness_N_um") return 2e-3;
  if (key == "screw_damping_Ns_m") return 8e-3;
  if (key == "sigma0_N_m") return 1e-3;
  if (key == "sigma1_decay_mm_s") return 5e-3;
  return 0.0;
}

/// What the fit moves, with its scale.
std::vector<FreeParameter> FreeParameters(const FitOptions& options) {
  std::vector<FreeParameter> p;
  const auto log = [&](std::string key, double* (*at)(AxisModel&), double prior, double step) {
    p.push_back({std::move(key), at, true, prior, step});
  };
  const auto linear = [&](std::string key, double* (*at)(AxisModel&), double prior, double step) {
    p.push_back({std::move(key), at, false, prior, step});
  };
  log(
      "motor_inertia_kgm2", [](AxisModel& a) { return &a.motor_mass_kg; }, 1.0, 5e-4);
  if (options.screw) {
    log(
        "table_mass_kg", [](AxisModel& a) { return &a.table_mass_kg; }, 0.5, 1e-3);
    log(
        "screw_damping_Ns_m", [](AxisModel& a) { return &a.damping_Ns_m; }, 1.0, 5e-3);
    linear(
        "lag_s", [](AxisModel& a) { return &a.lag_s; }, 2e-4, 1e-6);
    linear(
        "delay_s", [](AxisModel& a) { return &a.delay_s; }, 5e-5, 1e-6);
  }
  if (options.stiffness)
    log(
        "screw_stiffness_N_um", [](AxisModel& a) { return &a.stiffness_N_m; }, options.stiffness_prior, 5e-4);
  log(
      "Fs_plus_N", [](AxisModel& a) { return &a.friction.Fs_plus_N; }, 1.0, 2e-3);
  log(
      "Fs_minus_N", [](AxisModel& a) { return &a.friction.Fs_minus_N; }, 1.0, 2e-3);
  log(
      "Fc_plus_N", [](AxisModel& a) { return &a.friction.Fc_plus_N; }, 1.0, 1e-3);
  log(
      "Fc_minus_N", [](AxisModel& a) { return &a.friction.Fc_minus_N; }, 1.0, 1e-3);
  log(
      "vs_mm_s", [](AxisModel& a) { return &a.friction.vs_m_s; }, 1.0, 5e-3);
  log(
      "sigma0_N_m", [](AxisModel& a) { return &a.friction.sigma0_N_m; }, 1.0, 3e-3);
  log(
      "sigma1_Ns_m", [](AxisModel& a) { return &a.friction.sigma1_Ns_m; }, 1.0, 1e-2);
  log(
      "sigma1_decay_mm_s", [](AxisModel& a) { return &a.friction.sigma1_decay_m_s; }, 0.7, 1e-2);
  log(
      "sigma2_Ns_m", [](AxisModel& a) { return &a.friction.sigma2_Ns_m; }, 1.0, 2e-3);
  linear(
      "offset_N", [](AxisModel& a) { return &a.offset_N; }, 10.0, 0.02);
  linear(
      "place_1", [](AxisModel& a) { return &a.variation.place[0]; }, 0.2, 1e-3);
  linear(
      "place_2", [](AxisModel& a) { return &a.variation.place[1]; }, 0.2, 1e-3);
  linear(
      "place_3", [](AxisModel& a) { return &a.variation.place[2]; }, 0.2, 1e-3);
  linear(
      "turn_plus_cos1", [](AxisModel& a) { return &a.variation.turn_plus[0]; }, 0.2, 1e-3);
  linear(
      "turn_plus_sin1", [](AxisModel& a) { return &a.variation.turn_plus[1]; }, 0.2, 1e-3);
  linear(
      "turn_plus_cos2", [](AxisModel& a) { return &a.variation.turn_plus[2]; }, 0.1, 1e-3);
  linear(
      "turn_plus_sin2", [](AxisModel& a) { return &a.variation.turn_plus[3]; }, 0.1, 1e-3);
  linear(
      "turn_minus_cos1", [](AxisModel& a) { return &a.variation.turn_minus[0]; }, 0.2, 1e-3);
  linear(
      "turn_minus_sin1", [](AxisModel& a) { return &a.variation.turn_minus[1]; }, 0.2, 1e-3);
  linear(
      "turn_minus_cos2", [](AxisModel& a) { return &a.variation.turn_minus[2]; }, 0.1, 1e-3);
  linear(
      "turn_minus_sin2", [](AxisModel& a) { return &a.variation.turn_minus[3]; }, 0.1, 1e-3);
  const auto in = [](const std::vector<std::string>& keys, const std::string& key) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  };
  std::erase_if(p, [&](const FreeParameter& f) {
    return in(options.hold, f.key) || (!options.only.empty() && !in(options.only, f.key));
  });
  return p;
}

class Fit {
 public:
  Fit(const AxisModel& start, const std::vector<Measured>& records, const FitOptions& options)
      : start_(start), records_(records), options_(options), free_(FreeParameters(options)) {
    for (const Measured& r : records_) size_ += r.size();
    block_ = static_cast<std::size_t>(std::max(1.0, options.block_s / records_.front().period_s));
  }

  JointFit Run();

 private:
  [[nodiscard]] AxisModel At(const VectorXd& x) const {
    AxisModel axis = start_;
    for (std::size_t i = 0; i < free_.size(); ++i) {
      double& value = *free_[i].at(axis);
      const double step = x(static_cast<Eigen::Index>(i));
      value = free_[i].logarithmic ? value * std::exp(step) : value + step;
    }
    if (!options_.screw) axis.table_mass_kg *= axis.motor_mass_kg / start_.motor_mass_kg;
    axis.lag_s = std::max(0.0, axis.lag_s);
    axis.friction.Fs_plus_N = std::max(axis.friction.Fs_plus_N, axis.friction.Fc_plus_N);
    axis.friction.Fs_minus_N = std::max(axis.friction.Fs_minus_N, axis.friction.Fc_minus_N);
    return axis;
  }
  [[nodiscard]] VectorXd Raw(const VectorXd& x) const {
    const AxisModel axis = At(x);
    VectorXd all(static_cast<Eigen::Index>(size_));
    Eigen::Index at = 0;
    for (const Measured& r : records_) {
      const std::vector<double> e = PredictionErrors_m(axis, r, gain_);
      for (const double value : e) all(at++) = std::isfinite(value) ? value : 1.0;
    }
    return all;
  }
  [[nodiscard]] double Prior(const VectorXd& x) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < free_.size(); ++i)
      sum += std::pow(x(static_cast<Eigen::Index>(i)) / free_[i].prior, 2);
    return sum;
  }
  /// Columns of derivatives of the whitened errors, on two threads.
  void Derivatives(const VectorXd& x, const VectorXd& at_x, MatrixXd& jacobian);
  /// Until a step gains less than this share.
  void Iterate(VectorXd& x, double enough);
  VectorXd StepFrom(const VectorXd& x);

  AxisModel start_;
  const std::vector<Measured>& records_;
  FitOptions options_;
  std::vector<FreeParameter> free_;
  FollowGain gain_ = FollowGain::Zero();
  Whitening whitening_;
  std::size_t size_ = 0;
  std::size_t block_ = 1000;
  int evaluations_ = 0;
};

void Fit::Derivatives(const VectorXd& x, const VectorXd& at_x, MatrixXd& jacobian) {
  jacobian.resize(at_x.size(), x.size());
  std::vector<std::thread> workers;
  const Eigen::Index n = x.size();
  const int count = 2;
  for (int w = 0; w < count; ++w) {
    workers.emplace_back([&, w] {
      for (Eigen::Index i = w; i < n; i += count) {
        VectorXd moved = x;
        const double step = free_[static_cast<std::size_t>(i)].step;
        moved(i) += step;
        jacobian.col(i) = (whitening_.Apply(Raw(moved)) - at_x) / step;
      }
    });
  }
  for (std::thread& w : workers) w.join();
  evaluations_ += static_cast<int>(n);
}

void Fit::Iterate(VectorXd& x, double enough) {
  VectorXd r = whitening_.Apply(Raw(x));
  double cost = r.squaredNorm() + Prior(x);
  double damping = 1e-3;
  MatrixXd jacobian;
  VectorXd prior_weight(x.size());
  for (std::size_t i = 0; i < free_.size(); ++i)
    prior_weight(static_cast<Eigen::Index>(i)) = 1.0 / (free_[i].prior * free_[i].prior);
  for (int it = 0; it < options_.iterations; ++it) {
    Derivatives(x, r, jacobian);
    MatrixXd h = jacobian.transpose() * jacobian;
    h.diagonal() += prior_weight;
    const VectorXd g = jacobian.transpose() * r + prior_weight.cwiseProduct(x);
    bool better = false;
    double gained = 0.0;
    for (int attempt = 0; attempt < 8 && !better; ++attempt) {
      MatrixXd damped = h;
      damped.diagonal() += damping * h.diagonal();
      VectorXd dx = -damped.ldlt().solve(g);
      // No factor moves by more than 2 at once.
      double most = 0.0;
      for (std::size_t i = 0; i < free_.size(); ++i) {
        const double d = std::fabs(dx(static_cast<Eigen::Index>(i)));
        most = std::max(most, free_[i].logarithmic ? d / 0.7 : d / (2.0 * free_[i].prior));
      }
      if (most > 1.0) dx /= most;
      const VectorXd tried = x + dx;
      const VectorXd r_tried = whitening_.Apply(Raw(tried));
      ++evaluations_;
      const double cost_tried = r_tried.squaredNorm() + Prior(tried);
      if (cost_tried < cost) {
        gained = cost - cost_tried;
        x = tried;
        r = r_tried;
        cost = cost_tried;
        damping = std::max(1e-7, damping * 0.2);
        better = true;
      } else {
        damping *= 8.0;
      }
    }
    if (!better || gained < enough * cost) return;
  }
}

/// The step that the errors of another follow gain ask for.
VectorXd Fit::StepFrom(const VectorXd& x) {
  const VectorXd raw = Raw(x);
  whitening_.Learn(raw, block_, 12, records_.front().position_step_m);
  const VectorXd r = whitening_.Apply(raw);
  MatrixXd jacobian;
  Derivatives(x, r, jacobian);
  MatrixXd h = jacobian.transpose() * jacobian;
  for (std::size_t i = 0; i < free_.size(); ++i)
    h(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) += 1.0 / (free_[i].prior * free_[i].prior);
  return -h.ldlt().solve(jacobian.transpose() * r);
}

JointFit Fit::Run() {
  VectorXd x = VectorXd::Zero(static_cast<Eigen::Index>(free_.size()));
  JointFit result;
  for (int round = 0; round < options_.rounds; ++round) {
    gain_ = MakeFollowGain(At(x), records_.front().period_s, kFollow_Hz);
    const VectorXd raw = Raw(x);
    if (round == 0) result.error_rms_before_m = std::sqrt(raw.squaredNorm() / static_cast<double>(size_));
    whitening_.Learn(raw, block_, round == 0 && !options_.refine ? 0 : 12, records_.front().position_step_m);
    Iterate(x, round + 1 < options_.rounds ? 2e-3 : 5e-5);
    if (options_.progress) options_.progress((round + 1.0) / options_.rounds);
  }
  const VectorXd raw = Raw(x);
  result.error_rms_m = std::sqrt(raw.squaredNorm() / static_cast<double>(size_));
  result.axis = At(x);
  result.evaluations = evaluations_;
  if (!options_.spread) {
    for (FreeParameter& f : free_)
      result.parameters.push_back({f.key, *f.at(result.axis), 0.0, f.logarithmic});
    return result;
  }
  // Spread: the sandwich of curvature and the blocks' gradients.
  whitening_.Learn(raw, block_, 12, records_.front().position_step_m);
  const VectorXd r = whitening_.Apply(raw);
  MatrixXd jacobian;
  Derivatives(x, r, jacobian);
  MatrixXd h = jacobian.transpose() * jacobian;
  for (std::size_t i = 0; i < free_.size(); ++i)
    h(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) += 1.0 / (free_[i].prior * free_[i].prior);
  MatrixXd scatter = MatrixXd::Zero(x.size(), x.size());
  int blocks = 0;
  for (Eigen::Index b = 0; b < r.size(); b += static_cast<Eigen::Index>(2 * block_)) {
    const Eigen::Index n = std::min<Eigen::Index>(static_cast<Eigen::Index>(2 * block_), r.size() - b);
    const VectorXd g = jacobian.middleRows(b, n).transpose() * r.segment(b, n);
    scatter += g * g.transpose();
    ++blocks;
  }
  const double few =
      blocks > x.size() + 1 ? static_cast<double>(blocks) / static_cast<double>(blocks - x.size()) : 4.0;
  const MatrixXd inverse = h.ldlt().solve(MatrixXd::Identity(x.size(), x.size()));
  const double noise = r.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, r.size() - x.size()));
  result.covariance = few * inverse * scatter * inverse;
  // How far the answer would move if the simulation followed the measurement more loosely or more closely:
  // not at all if the model were the axis. One step of Gauss and Newton says it.
  VectorXd method = VectorXd::Zero(x.size());
  for (const double follow_Hz : {0.5 * kFollow_Hz, 2.0 * kFollow_Hz}) {
    gain_ = MakeFollowGain(At(x), records_.front().period_s, follow_Hz);
    method = method.cwiseMax(StepFrom(x).cwiseAbs());
  }
  for (std::size_t i = 0; i < free_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double variance = std::max(result.covariance(k, k), noise * inverse(k, k)) + method(k) * method(k) +
                            std::pow(Stepping(free_[i].key), 2);
    result.parameters.push_back(
        {free_[i].key, *free_[i].at(result.axis), std::sqrt(variance), free_[i].logarithmic});
  }
  result.evaluations = evaluations_;
  return result;
}

}  // namespace

double Sigma(const std::vector<FittedParameter>& parameters, const std::string& key) {
  for (const FittedParameter& p : parameters)
    if (p.key == key) return p.sigma;
  return 0.0;
}

JointFit FitJointly(const AxisModel& start, const std::vector<Measured>& records, const FitOptions& options) {
  return Fit(start, records, options).Run();
}

}  // namespace contour::identify
