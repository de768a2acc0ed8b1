#include "analysis/identification/joint_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "analysis/prediction_error/block_whitening.h"
#include "analysis/prediction_error/marquardt_fit.h"

namespace contour::identify {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kFollow_Hz = 60.0;
/// Of the longest length: as few say how far they scatter.
constexpr Eigen::Index kFewestBlocks = 5;

/// What two methods of stepping the same axis, this simulation and the emulated machine, were found to differ
/// by in these parameters (docs/commissioning.md): nothing is known better than that. Relative.
double Stepping(const std::string& key) {
  if (key == "screw_stiffness_N_um") return 2e-3;
  if (key == "screw_damping_Ns_m") return 8e-3;
  if (key == "sigma0_N_m") return 1e-3;
  if (key == "sigma1_decay_mm_s") return 5e-3;
  return 0.0;
}

using Parameters = std::vector<FreeParameter>;

FreeParameter Factor(const char* key, double* (*at)(TableAxis&), double prior, double step) {
  return {key, at, true, prior, step};
}
FreeParameter Number(const char* key, double* (*at)(TableAxis&), double prior, double step) {
  return {key, at, false, prior, step};
}

Parameters ScrewParameters() {
  return {
      Factor(
          "table_mass_kg", [](TableAxis& a) { return &a.load_inertia; }, 0.5, 1e-3),
      Factor(
          "screw_damping_Ns_m", [](TableAxis& a) { return &a.damping; }, 1.0, 5e-3),
      Number(
          "lag_s", [](TableAxis& a) { return &a.lag_s; }, 2e-4, 1e-6),
      Number(
          "delay_s", [](TableAxis& a) { return &a.delay_s; }, 5e-5, 1e-6),
  };
}

Parameters FrictionParameters(const TableAxis& axis) {
  const double level_N = 0.5 * (axis.friction.Fc_plus + axis.friction.Fc_minus);
  return {
      Factor(
          "Fs_plus_N", [](TableAxis& a) { return &a.friction.Fs_plus; }, 1.0, 2e-3),
      Factor(
          "Fs_minus_N", [](TableAxis& a) { return &a.friction.Fs_minus; }, 1.0, 2e-3),
      Factor(
          "Fc_plus_N", [](TableAxis& a) { return &a.friction.Fc_plus; }, 1.0, 1e-3),
      Factor(
          "Fc_minus_N", [](TableAxis& a) { return &a.friction.Fc_minus; }, 1.0, 1e-3),
      Factor(
          "vs_mm_s", [](TableAxis& a) { return &a.friction.vs; }, 1.0, 5e-3),
      Factor(
          "sigma0_N_m", [](TableAxis& a) { return &a.friction.s0; }, 1.0, 3e-3),
      Factor(
          "sigma1_Ns_m", [](TableAxis& a) { return &a.friction.s1; }, 1.0, 1e-2),
      Factor(
          "sigma1_decay_mm_s", [](TableAxis& a) { return &a.friction.vd; }, 0.7, 1e-2),
      Factor(
          "sigma2_Ns_m", [](TableAxis& a) { return &a.friction.s2; }, 1.0, 2e-3),
      Number(
          "offset_N", [](TableAxis& a) { return &a.offset; }, 0.25 * level_N, 5e-4 * level_N),
  };
}

Parameters VariationParameters() {
  return {
      Number(
          "place_1", [](TableAxis& a) { return &a.variation.place[0]; }, 0.2, 1e-3),
      Number(
          "place_2", [](TableAxis& a) { return &a.variation.place[1]; }, 0.2, 1e-3),
      Number(
          "place_3", [](TableAxis& a) { return &a.variation.place[2]; }, 0.2, 1e-3),
      Number(
          "turn_plus_cos1", [](TableAxis& a) { return &a.variation.turn_plus[0]; }, 0.2, 1e-3),
      Number(
          "turn_plus_sin1", [](TableAxis& a) { return &a.variation.turn_plus[1]; }, 0.2, 1e-3),
      Number(
          "turn_plus_cos2", [](TableAxis& a) { return &a.variation.turn_plus[2]; }, 0.1, 1e-3),
      Number(
          "turn_plus_sin2", [](TableAxis& a) { return &a.variation.turn_plus[3]; }, 0.1, 1e-3),
      Number(
          "turn_minus_cos1", [](TableAxis& a) { return &a.variation.turn_minus[0]; }, 0.2, 1e-3),
      Number(
          "turn_minus_sin1", [](TableAxis& a) { return &a.variation.turn_minus[1]; }, 0.2, 1e-3),
      Number(
          "turn_minus_cos2", [](TableAxis& a) { return &a.variation.turn_minus[2]; }, 0.1, 1e-3),
      Number(
          "turn_minus_sin2", [](TableAxis& a) { return &a.variation.turn_minus[3]; }, 0.1, 1e-3),
  };
}

template <std::size_t I>
void AddWave(const TableAxis& axis, double level_N, Parameters& p) {
  if (axis.cogging[I].order <= 0.0) return;
  const std::string number = std::to_string(I + 1);
  p.push_back({"cogging_cos" + number, [](TableAxis& a) { return &a.cogging[I].cosine_N; }, false,
               0.5 * level_N, 1e-3 * level_N});
  p.push_back({"cogging_sin" + number, [](TableAxis& a) { return &a.cogging[I].sine_N; }, false,
               0.5 * level_N, 1e-3 * level_N});
}

/// What the model of the machine file has no keys for.
Parameters Besides(const TableAxis& axis) {
  const double level_N = 0.5 * (axis.friction.Fc_plus + axis.friction.Fc_minus);
  Parameters p;
  if (axis.two_inertia && axis.friction_on_load)
    p.push_back(Number(
        "motor_friction_share", [](TableAxis& a) { return &a.motor_friction_share; }, 0.3, 5e-3));
  if (axis.side.share > 0.0) {
    p.push_back(Number(
        "side_share", [](TableAxis& a) { return &a.side.share; }, 0.2, 1e-3));
    p.push_back(Factor(
        "side_frequency_Hz", [](TableAxis& a) { return &a.side.frequency_Hz; }, 0.3, 1e-3));
    p.push_back(Factor(
        "side_damping", [](TableAxis& a) { return &a.side.damping_ratio; }, 1.0, 1e-2));
  }
  AddWave<0>(axis, level_N, p);
  AddWave<1>(axis, level_N, p);
  AddWave<2>(axis, level_N, p);
  return p;
}

/// What the fit moves, with its scale.
Parameters FreeParameters(const TableAxis& axis, const FitOptions& options) {
  Parameters p = {Factor(
      "motor_inertia_kgm2", [](TableAxis& a) { return &a.motor_inertia; }, 1.0, 5e-4)};
  const auto add = [&](const Parameters& more) { p.insert(p.end(), more.begin(), more.end()); };
  if (options.screw) add(ScrewParameters());
  if (options.stiffness)
    add({Factor(
        "screw_stiffness_N_um", [](TableAxis& a) { return &a.stiffness; }, options.stiffness_prior, 5e-4)});
  add(FrictionParameters(axis));
  add(VariationParameters());
  add(Besides(axis));
  const auto in = [](const std::vector<std::string>& keys, const std::string& key) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  };
  std::erase_if(p, [&](const FreeParameter& f) {
    return in(options.hold, f.key) || (!options.only.empty() && !in(options.only, f.key));
  });
  return p;
}

/// Median over blocks of time: nothing of it is what happens when the axis comes to rest.
double TypicalRms(const VectorXd& errors, std::size_t block) {
  const auto length = static_cast<Eigen::Index>(block);
  std::vector<double> rms;
  for (Eigen::Index b = 0; b + length <= errors.size(); b += length)
    rms.push_back(errors.segment(b, length).norm() / std::sqrt(static_cast<double>(length)));
  if (rms.empty())
    return errors.norm() / std::sqrt(static_cast<double>(std::max<Eigen::Index>(1, errors.size())));
  std::nth_element(rms.begin(), rms.begin() + static_cast<std::ptrdiff_t>(rms.size() / 2), rms.end());
  return rms[rms.size() / 2];
}

class Fit {
 public:
  Fit(const TableAxis& start, const std::vector<Measured>& records, const FitOptions& options)
      : start_(start), records_(records), options_(options), free_(FreeParameters(start, options)) {
    for (const Measured& r : records_) size_ += r.size();
    block_ = static_cast<std::size_t>(std::max(1.0, options.block_s / records_.front().period_s));
  }

  JointFit Run();

 private:
  [[nodiscard]] TableAxis At(const VectorXd& x) const {
    TableAxis axis = start_;
    for (std::size_t i = 0; i < free_.size(); ++i) {
      double& value = *free_[i].at(axis);
      const double step = x(static_cast<Eigen::Index>(i));
      value = free_[i].logarithmic ? value * std::exp(step) : value + step;
    }
    if (!options_.screw) axis.load_inertia *= axis.motor_inertia / start_.motor_inertia;
    axis.lag_s = std::max(0.0, axis.lag_s);
    // Shares have no sign.
    axis.motor_friction_share = std::min(0.9, std::fabs(axis.motor_friction_share));
    axis.side.share = std::min(0.9, std::fabs(axis.side.share));
    axis.friction.Fs_plus = std::max(axis.friction.Fs_plus, axis.friction.Fc_plus);
    axis.friction.Fs_minus = std::max(axis.friction.Fs_minus, axis.friction.Fc_minus);
    return axis;
  }
  [[nodiscard]] VectorXd Raw(const VectorXd& x) const {
    const TableAxis axis = At(x);
    VectorXd all(static_cast<Eigen::Index>(size_));
    Eigen::Index at = 0;
    for (const Measured& r : records_) {
      const std::vector<double> e = PredictionErrors_m(axis, r, gain_);
      for (const double value : e) all(at++) = std::isfinite(value) ? value : 1.0;
    }
    return all;
  }
  [[nodiscard]] diagnosis::LeastSquares WhiteErrors() const;
  VectorXd StepFrom(const VectorXd& x);
  [[nodiscard]] VectorXd Scatter(const MatrixXd& jacobian, const VectorXd& r, const MatrixXd& inverse,
                                 Eigen::Index block) const;
  [[nodiscard]] bool Polish(const VectorXd& step, const VectorXd& r, VectorXd& x) const;
  void FindSpread(VectorXd x, const VectorXd& raw, JointFit& result);

  TableAxis start_;
  const std::vector<Measured>& records_;
  FitOptions options_;
  std::vector<FreeParameter> free_;
  FollowGain gain_ = FollowGain::Zero();
  diagnosis::BlockWhitening whitening_;
  std::size_t size_ = 0;
  std::size_t block_ = 1000;
  int evaluations_ = 0;
};

/// The whitened errors over the free parameters. No factor moves by more than 2 at once.
diagnosis::LeastSquares Fit::WhiteErrors() const {
  diagnosis::LeastSquares p;
  const auto n = static_cast<Eigen::Index>(free_.size());
  p.residual = [this](const VectorXd& x) { return whitening_.Apply(Raw(x)); };
  p.threads = options_.threads;
  p.sigma.resize(n);
  p.step.resize(n);
  p.longest.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const FreeParameter& f = free_[static_cast<std::size_t>(i)];
    p.sigma(i) = f.prior;
    p.step(i) = f.step;
    p.longest(i) = f.logarithmic ? 0.7 : 2.0 * f.prior;
  }
  return p;
}

/// The step that the errors of another follow gain ask for.
VectorXd Fit::StepFrom(const VectorXd& x) {
  const VectorXd raw = Raw(x);
  whitening_.Learn(raw, block_, 12, records_.front().position_step_m);
  const VectorXd r = whitening_.Apply(raw);
  const diagnosis::LeastSquares problem = WhiteErrors();
  const MatrixXd jacobian = problem.Jacobian(x, r);
  evaluations_ += static_cast<int>(x.size());
  return -problem.Normal(jacobian).ldlt().solve(jacobian.transpose() * r);
}

/// Variance of each parameter by the scatter of the gradient over blocks of so many samples, and one block's
/// worth of doubt about so few blocks.
VectorXd Fit::Scatter(const MatrixXd& jacobian, const VectorXd& r, const MatrixXd& inverse,
                      Eigen::Index block) const {
  VectorXd variance = VectorXd::Zero(inverse.rows());
  int blocks = 0;
  for (Eigen::Index b = 0; b < r.size(); b += block) {
    const Eigen::Index n = std::min<Eigen::Index>(block, r.size() - b);
    variance += (inverse * (jacobian.middleRows(b, n).transpose() * r.segment(b, n))).cwiseAbs2();
    ++blocks;
  }
  // Student's 95 % interval over that of a normal distribution, to first order.
  return variance * std::pow(1.0 + 1.2 / std::max(1.0, blocks - 1.5), 2);
}

/// Takes a step where it lowers the cost; `r` is the residual at x.
bool Fit::Polish(const VectorXd& step, const VectorXd& r, VectorXd& x) const {
  const diagnosis::LeastSquares problem = WhiteErrors();
  const VectorXd there = x + step;
  const double cost = whitening_.Apply(Raw(there)).squaredNorm() + problem.PriorAt(there);
  if (!(cost < r.squaredNorm() + problem.PriorAt(x))) return false;
  x = there;
  return true;
}

/// Standard deviations: the sandwich of curvature and the blocks' gradients. What a model leaves unexplained
/// hangs together for as long as an experiment lasts, so blocks of many lengths are tried, up to those of
/// whole motions (other places, speeds and directions), and the widest counts.
void Fit::FindSpread(VectorXd x, const VectorXd& raw, JointFit& result) {
  whitening_.Learn(raw, block_, 12, records_.front().position_step_m);
  const VectorXd r = whitening_.Apply(raw);
  const diagnosis::LeastSquares problem = WhiteErrors();
  const MatrixXd jacobian = problem.Jacobian(x, r);
  evaluations_ += static_cast<int>(x.size());
  const MatrixXd h = problem.Normal(jacobian);
  const MatrixXd inverse = h.ldlt().solve(MatrixXd::Identity(x.size(), x.size()));
  const double noise = r.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, r.size() - x.size()));
  result.covariance = noise * inverse;
  VectorXd variance = result.covariance.diagonal();
  const auto shortest = static_cast<Eigen::Index>(2 * block_);
  for (Eigen::Index block = shortest; block <= std::max(shortest, r.size() / kFewestBlocks); block *= 2)
    variance = variance.cwiseMax(Scatter(jacobian, r, inverse, block));
  // How far the fit is from its least, in its own standard deviations.
  const VectorXd gradient = jacobian.transpose() * r + x.cwiseQuotient(problem.sigma.cwiseAbs2());
  VectorXd left = inverse * gradient;
  if (Polish(-left, r, x)) {
    left.setZero();
    result.axis = At(x);
  }
  result.unsettled = left.cwiseAbs().cwiseQuotient(variance.cwiseSqrt()).maxCoeff();
  // How far the answer would move if the simulation followed the measurement more loosely or more closely:
  // not at all if the model were the axis. One step of Gauss and Newton says it.
  VectorXd method = left.cwiseAbs();
  for (const double follow_Hz : {0.5 * kFollow_Hz, 2.0 * kFollow_Hz}) {
    gain_ = MakeFollowGain(At(x), records_.front().period_s, follow_Hz);
    method = method.cwiseMax(StepFrom(x).cwiseAbs());
  }
  for (std::size_t i = 0; i < free_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double all = variance(k) + method(k) * method(k) + std::pow(Stepping(free_[i].key), 2);
    result.parameters.push_back(
        {free_[i].key, *free_[i].at(result.axis), std::sqrt(all), free_[i].logarithmic});
  }
}

JointFit Fit::Run() {
  VectorXd x = VectorXd::Zero(static_cast<Eigen::Index>(free_.size()));
  JointFit result;
  for (int round = 0; round < options_.rounds; ++round) {
    gain_ = MakeFollowGain(At(x), records_.front().period_s, kFollow_Hz);
    const VectorXd raw = Raw(x);
    if (round == 0) result.error_rms_before_m = std::sqrt(raw.squaredNorm() / static_cast<double>(size_));
    whitening_.Learn(raw, block_, round == 0 && !options_.refine ? 0 : 12, records_.front().position_step_m);
    evaluations_ += diagnosis::FitByMarquardt(
        WhiteErrors(), {options_.iterations, round + 1 < options_.rounds ? 2e-3 : 5e-5}, x);
    if (options_.progress) options_.progress((round + 1.0) / options_.rounds);
  }
  const VectorXd raw = Raw(x);
  result.error_typical_m = TypicalRms(raw, block_);
  result.error_rms_m = std::sqrt(raw.squaredNorm() / static_cast<double>(size_));
  result.axis = At(x);
  result.evaluations = evaluations_;
  if (!options_.spread) {
    for (FreeParameter& f : free_)
      result.parameters.push_back({f.key, *f.at(result.axis), 0.0, f.logarithmic});
    return result;
  }
  FindSpread(x, raw, result);
  result.evaluations = evaluations_;
  return result;
}

}  // namespace

double Sigma(const std::vector<FittedParameter>& parameters, const std::string& key) {
  for (const FittedParameter& p : parameters)
    if (p.key == key) return p.sigma;
  return 0.0;
}

JointFit FitJointly(const TableAxis& start, const std::vector<Measured>& records, const FitOptions& options) {
  return Fit(start, records, options).Run();
}

}  // namespace contour::identify
