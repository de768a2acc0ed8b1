#include "analysis/identification/joint_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "analysis/identification/free_parameters.h"
#include "analysis/identification/linear_step.h"
#include "analysis/identification/spread_groups.h"
#include "analysis/parallel/parallel_for.h"
#include "analysis/prediction_error/block_whitening.h"
#include "analysis/prediction_error/marquardt_fit.h"

namespace contour::identify {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Of the longest length: as few say how far they scatter.
constexpr Eigen::Index kFewestBlocks = 5;

/// What two methods of stepping the same axis, this simulation and the emulated machine, were found to differ
/// by in these parameters (docs/commissioning.md): nothing is known better than that. Relative. A screw shows
/// as the antiresonance of its stiffness and the table: the mass is known no better than the stiffness.
double Stepping(const std::string& key) {
  if (key == "screw_stiffness_N_um" || key == "table_mass_kg") return 2e-3;
  if (key == "screw_damping_Ns_m") return 8e-3;
  if (key == "sigma0_N_m") return 1e-3;
  if (key == "sigma1_decay_mm_s") return 5e-3;
  return 0.0;
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
      : start_(start),
        records_(records),
        options_(options),
        free_(FreeParameters(start, records.front().led_by_drive(), options)) {
    for (const Measured& r : records_) size_ += r.compared();
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
    // Below the shortest lag nothing changes, and nothing would lead back: a step beyond it is reflected.
    axis.lag_s = kShortestLag_s + std::fabs(axis.lag_s - kShortestLag_s);
    // Shares have no sign.
    axis.motor_friction_share = std::min(0.9, std::fabs(axis.motor_friction_share));
    axis.side.share = std::min(0.9, std::fabs(axis.side.share));
    axis.friction.Fs_plus = std::max(axis.friction.Fs_plus, axis.friction.Fc_plus);
    axis.friction.Fs_minus = std::max(axis.friction.Fs_minus, axis.friction.Fc_minus);
    return axis;
  }
  /// The errors at each column of x. One that is no number is as good as a metre.
  [[nodiscard]] MatrixXd Raws(const MatrixXd& x) const {
    std::vector<Followed> axes;
    for (Eigen::Index i = 0; i < x.cols(); ++i) axes.push_back({At(x.col(i)), gain_, substeps_});
    MatrixXd errors = PredictionErrors_m(axes, records_, options_.threads);
    if (!errors.allFinite()) errors = errors.unaryExpr([](double e) { return std::isfinite(e) ? e : 1.0; });
    return errors;
  }
  [[nodiscard]] VectorXd Raw(const VectorXd& x) const { return Raws(x); }
  [[nodiscard]] diagnosis::LeastSquares WhiteErrors() const;
  VectorXd StepFrom(const VectorXd& x);
  [[nodiscard]] VectorXd Scatter(const MatrixXd& jacobian, const VectorXd& r, const MatrixXd& inverse) const;
  [[nodiscard]] double Rounding(const std::string& key, const VectorXd& x) const;
  [[nodiscard]] bool Polish(const VectorXd& step, const VectorXd& r, VectorXd& x) const;
  [[nodiscard]] VectorXd ByFinerSteps(const VectorXd& x, const MatrixXd& jacobian, const VectorXd& r,
                                      const MatrixXd& inverse);
  void FindSpread(VectorXd x, const VectorXd& raw, JointFit& result);

  TableAxis start_;
  const std::vector<Measured>& records_;
  FitOptions options_;
  std::vector<FreeParameter> free_;
  FollowGain gain_ = FollowGain::Zero();
  int substeps_ = kSubSteps;
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
  p.residuals = [this](const MatrixXd& x) {
    MatrixXd errors = Raws(x);
    ParallelFor(static_cast<std::size_t>(x.cols()), options_.threads, [&](std::size_t column) {
      const auto i = static_cast<Eigen::Index>(column);
      errors.col(i) = whitening_.Apply(errors.col(i));
    });
    return errors;
  };
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

/// Variance of each parameter by the scatter of the gradient. What a model leaves unexplained hangs together
/// for as long as an experiment lasts, so blocks of time of many lengths are tried, up to those of whole
/// motions (other places, speeds and directions); and it comes again wherever force or speed are alike. The
/// widest counts.
VectorXd Fit::Scatter(const MatrixXd& jacobian, const VectorXd& r, const MatrixXd& inverse) const {
  VectorXd variance = VectorXd::Zero(inverse.rows());
  const auto shortest = static_cast<Eigen::Index>(2 * block_);
  for (Eigen::Index block = shortest; block <= std::max(shortest, r.size() / kFewestBlocks); block *= 2) {
    VectorXd sum = VectorXd::Zero(inverse.rows());
    int blocks = 0;
    for (Eigen::Index b = 0; b < r.size(); b += block, ++blocks) {
      const Eigen::Index n = std::min<Eigen::Index>(block, r.size() - b);
      sum += (inverse * (jacobian.middleRows(b, n).transpose() * r.segment(b, n))).cwiseAbs2();
    }
    variance = variance.cwiseMax(sum * FewGroupsFactor(blocks));
  }
  const SpreadWindows windows = WindowsOf(records_);
  MatrixXd each(static_cast<Eigen::Index>(windows.quickness.size()), inverse.rows());
  for (Eigen::Index w = 0; w < each.rows(); ++w) {
    const Eigen::Index begin = w * windows.length;
    const Eigen::Index n = std::min(windows.length, r.size() - begin);
    each.row(w) = inverse * (jacobian.middleRows(begin, n).transpose() * r.segment(begin, n));
  }
  for (const auto& key : {windows.quickness, windows.velocity_m_s})
    variance = variance.cwiseMax(ScatterOverGroups(each, key));
  return variance;
}

/// Variance that a drive's reports leave to what bends within a rounding of the force: the step of the
/// reports, of the friction. No scatter shows it, being the same error at every place.
double Fit::Rounding(const std::string& key, const VectorXd& x) const {
  if (key != "sigma0_N_m" && key != "vs_mm_s") return 0.0;
  const TableAxis axis = At(x);
  const double level_N = 0.5 * (axis.friction.Fc_plus + axis.friction.Fc_minus);
  return std::pow(ReportStep_N(records_.front()) / level_N, 2);
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

/// How far the answer would move if a period were stepped ever finer: what it costs to take bristle and screw
/// one after the other goes with the square of the step, so half of it shows three quarters.
VectorXd Fit::ByFinerSteps(const VectorXd& x, const MatrixXd& jacobian, const VectorXd& r,
                           const MatrixXd& inverse) {
  substeps_ *= 2;
  const VectorXd finer = whitening_.Apply(Raw(x));
  substeps_ /= 2;
  return -4.0 / 3.0 * (inverse * (jacobian.transpose() * (finer - r)));
}

/// Standard deviations: the sandwich of curvature and the scatter of the gradient.
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
  VectorXd variance = result.covariance.diagonal().cwiseMax(Scatter(jacobian, r, inverse));
  // How far the fit is from its least, in its own standard deviations.
  const VectorXd gradient = jacobian.transpose() * r + x.cwiseQuotient(problem.sigma.cwiseAbs2());
  VectorXd left = inverse * gradient;
  if (Polish(-left, r, x)) {
    left.setZero();
    result.axis = At(x);
  }
  result.unsettled = left.cwiseAbs().cwiseQuotient(variance.cwiseSqrt()).maxCoeff();
  const VectorXd stepping = ByFinerSteps(x, jacobian, r, inverse);
  // How far the answer would move if the simulation followed the measurement more loosely or more closely:
  // not at all if the model were the axis. One step of Gauss and Newton says it.
  VectorXd method = left.cwiseAbs();
  for (const double factor : {0.5, 2.0}) {
    gain_ = FollowGainFor(At(x), records_.front(), factor);
    method = method.cwiseMax(StepFrom(x).cwiseAbs());
  }
  const SpreadWindows windows = WindowsOf(records_);
  const HalvesApart apart = Disagreement(jacobian, r, problem.sigma, noise, windows, windows.quickness);
  for (std::size_t i = 0; i < free_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double all = variance(k) + method(k) * method(k) + stepping(k) * stepping(k) +
                       std::pow(Stepping(free_[i].key), 2) + Rounding(free_[i].key, x);
    result.parameters.push_back({free_[i].key, *free_[i].at(result.axis), std::sqrt(all),
                                 free_[i].logarithmic, apart.deviations(k), apart.distance(k)});
  }
}

JointFit Fit::Run() {
  VectorXd x = VectorXd::Zero(static_cast<Eigen::Index>(free_.size()));
  JointFit result;
  for (int round = 0; round < options_.rounds; ++round) {
    gain_ = FollowGainFor(At(x), records_.front());
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
      result.parameters.push_back({f.key, *f.at(result.axis), 0.0, f.logarithmic, 0.0, 0.0});
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
