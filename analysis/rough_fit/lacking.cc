#include "analysis/rough_fit/lacking.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>

#include "analysis/rough_fit/rough_fit.h"
#include "analysis/rough_fit/smoothed_motion.h"
#include "analysis/rough_fit/two_starts.h"
#include "config/number_text.h"

namespace contour::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Acceleration, Coulomb friction up and down, viscous friction.
constexpr Index kBase = 4;
/// So often the largest force that is looked at is halved: a drive that is asked for ten times what it gives
/// shows below a tenth.
constexpr int kHalvings = 4;
/// Of a column that others do not say already, in units in which every column has length 1.
constexpr double kLeastOwn = 1e-9;

/// What stands behind the base columns of a row.
using Further = std::function<void(std::size_t k, double* columns)>;
using Wanted = std::function<bool(std::size_t k)>;

struct Regression {
  VectorXd x;
  MatrixXd covariance;  ///< by the scatter of the rows, or of the parts of the log where that is more
  double left = 0.0;    ///< sum of squares
  double squares = 0.0;
  Eigen::Vector2d of_direction = Eigen::Vector2d::Zero();  ///< rows up and down
};

class Rows {
 public:
  Rows(const SmoothedMotion& m, const Signal& without_friction) : m_(m), y_(without_friction) {}
  [[nodiscard]] VectorXd Row(std::size_t k, Index further, const Further& fill) const {
    VectorXd row(kBase + further);
    const double v = m_.velocity[k];
    row.head<kBase>() << m_.acceleration[k], v > 0.0 ? 1.0 : 0.0, v < 0.0 ? -1.0 : 0.0, v;
    if (further > 0) fill(k, row.data() + kBase);
    return row;
  }
  /// Nothing where a column says nothing of its own, or too few parts of the log have rows.
  [[nodiscard]] std::optional<Regression> Fit(const Wanted& wanted, Index further, const Further& fill) const;
  /// Sum of squares that other numbers leave of the same rows.
  [[nodiscard]] double LeftBy(const VectorXd& x, const Wanted& wanted) const;
  /// By the fit, its friction included.
  [[nodiscard]] double Force(const VectorXd& x, std::size_t k) const {
    return Row(k, 0, {}).dot(x.head<kBase>()) + m_.command[k] - y_[k];
  }

 private:
  [[nodiscard]] std::size_t Begin(std::size_t part) const { return m_.size() * part / kPartsOfLog; }
  const SmoothedMotion& m_;
  const Signal& y_;
};

std::optional<Regression> Rows::Fit(const Wanted& wanted, Index further, const Further& fill) const {
  const Index n = kBase + further;
  MatrixXd normal = MatrixXd::Zero(n, n);
  VectorXd right = VectorXd::Zero(n);
  Regression out;
  double rows = 0.0;
  for (std::size_t k = 0; k < m_.size(); ++k) {
    if (!m_.Slides(k) || !wanted(k)) continue;
    const VectorXd row = Row(k, further, fill);
    normal.selfadjointView<Eigen::Lower>().rankUpdate(row);
    right += row * y_[k];
    out.squares += m_.command[k] * m_.command[k];
    out.of_direction += Eigen::Vector2d(row(1), -row(2));
    rows += 1.0;
  }
  normal = MatrixXd(normal.selfadjointView<Eigen::Lower>());
  // A direction that the rows have not gets no friction.
  for (Index i = 1; i < 3; ++i)
    if (normal(i, i) == 0.0) normal(i, i) = 1.0;
  const VectorXd unit = normal.diagonal().cwiseSqrt().cwiseInverse();
  if (!unit.allFinite() || rows < static_cast<double>(kPartsOfLog) * m_.independent_rows) return {};
  const MatrixXd scaled = unit.asDiagonal() * normal * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> own(scaled);
  if (!(own.eigenvalues()(0) > kLeastOwn)) return {};
  const MatrixXd inverse = unit.asDiagonal() * scaled.inverse() * unit.asDiagonal();
  out.x = inverse * right;
  MatrixXd sums = MatrixXd::Zero(n, n);
  Index parts = 0;
  for (std::size_t part = 0; part < kPartsOfLog; ++part) {
    VectorXd sum = VectorXd::Zero(n);
    for (std::size_t k = Begin(part); k < Begin(part + 1); ++k) {
      if (!m_.Slides(k) || !wanted(k)) continue;
      const VectorXd row = Row(k, further, fill);
      const double left = y_[k] - row.dot(out.x);
      sum += row * left;
      out.left += left * left;
    }
    parts += sum.isZero(0.0) ? 0 : 1;
    sums += sum * sum.transpose();
  }
  if (parts <= n) return {};
  out.covariance = static_cast<double>(parts) / static_cast<double>(parts - n) * inverse * sums * inverse;
  // Few parts may agree by chance.
  const MatrixXd by_rows = out.left / rows * m_.independent_rows * inverse;
  const VectorXd more =
      by_rows.diagonal().cwiseQuotient(out.covariance.diagonal().cwiseMax(1e-300)).cwiseMax(1.0).cwiseSqrt();
  out.covariance = more.asDiagonal() * out.covariance * more.asDiagonal();
  return out;
}

double Rows::LeftBy(const VectorXd& x, const Wanted& wanted) const {
  double left = 0.0;
  for (std::size_t k = 0; k < m_.size(); ++k)
    if (m_.Slides(k) && wanted(k)) left += std::pow(m_.command[k] - Force(x, k), 2);
  return left;
}

double Deviation(const Regression& r, Index i) { return std::sqrt(std::max(0.0, r.covariance(i, i))); }

/// The level is that of the directions that there are.
RoughNumber LevelOf(const Regression& r) {
  const Eigen::Vector2d there = (r.of_direction.array() > 0.0).cast<double>();
  const Eigen::Vector2d mean = there / there.sum();
  return {mean.dot(r.x.segment<2>(1)),
          std::sqrt(std::max(0.0, mean.dot(r.covariance.block<2, 2>(1, 1) * mean)))};
}

Lacking LackingOf(Lacking::What what, const StatedAxis& fitted, const Regression& r, double left_without) {
  Lacking out;
  out.what = what;
  out.inertia = {r.x(0), Deviation(r, 0)};
  out.coulomb = LevelOf(r);
  out.coulomb.value += 0.5 * (fitted.friction.Fc_plus + fitted.friction.Fc_minus);
  out.viscous = {fitted.friction.s2 + r.x(3), Deviation(r, 3)};
  out.explains = left_without > 0.0 ? 1.0 - r.left / left_without : 0.0;
  out.unexplained = r.squares > 0.0 ? r.left / r.squares : 1.0;
  for (Index i = kBase; i < r.x.size(); ++i)
    out.sure = std::max(out.sure, std::fabs(r.x(i)) / std::max(Deviation(r, i), 1e-300));
  return out;
}

/// Root mean square of what a number goes up and down by, less what chance makes of it.
double Varies(const Regression& r, std::initializer_list<std::pair<Index, double>> by) {
  double square = 0.0;
  for (const auto& [column, rms] : by)
    square += rms * rms * (r.x(column) * r.x(column) - r.covariance(column, column));
  return std::sqrt(std::max(0.0, square));
}

/// Centred, from -1/2 to 1/2: such a number has this root mean square, and its square about its mean that.
const double kLinearRms = std::sqrt(1.0 / 12.0), kSquareRms = std::sqrt(1.0 / 180.0);
double SquareAboutMean(double x) { return x * x - 1.0 / 12.0; }

class Trial {
 public:
  Trial(const SmoothedMotion& m, const Signal& without_friction, const FittedRun& run)
      : m_(m), rows_(m, without_friction), axis_(run.axis), falls_less_(without_friction) {
    for (std::size_t k = 0; k < m.size(); ++k)
      falls_less_[k] += BeyondCoulomb(run.axis.friction, run.axis.friction.vs, m.velocity[k]) -
                        BeyondCoulomb(run.axis.friction, run.stated.vs, m.velocity[k]);
    const auto [low, high] = std::minmax_element(m.position.begin(), m.position.end());
    middle_ = 0.5 * (*low + *high);
    travel_ = *high - *low;
  }
  std::vector<Lacking> All() {
    const auto base = rows_.Fit(kAll, 0, {});
    if (!base) return {};
    base_ = *base;
    Forces();
    Friction();
    if (!axis_.endless) Places();
    return std::move(out_);
  }

 private:
  static constexpr auto kAll = [](std::size_t) { return true; };
  const Regression* Put(Lacking::What what, Index further, const Further& fill) {
    fitted_ = rows_.Fit(kAll, further, fill);
    if (!fitted_) return nullptr;
    Add(LackingOf(what, axis_, *fitted_, base_.left));
    return &*fitted_;
  }
  void Add(Lacking lacking) {
    const Lacking without = LackingOf(lacking.what, axis_, base_, base_.left);
    lacking.inertia_without = without.inertia.value;
    lacking.coulomb_without = without.coulomb.value;
    lacking.viscous_without = without.viscous.value;
    out_.push_back(lacking);
  }
  void Forces();
  void Friction();
  void Places();

  const SmoothedMotion& m_;
  Rows rows_;
  const StatedAxis& axis_;
  Signal falls_less_;  ///< the force with friction taken out that falls as far as is stated
  double middle_ = 0.0, travel_ = 1.0;
  Regression base_;
  std::optional<Regression> fitted_;
  std::vector<Lacking> out_;
};

/// The force by which rows are chosen is that of the fit: chosen by the command itself, noise would choose.
void Trial::Forces() {
  std::vector<double> force(m_.size(), 0.0);
  double most = 0.0;
  for (std::size_t k = 0; k < m_.size(); ++k) {
    if (!m_.Slides(k)) continue;
    force[k] = rows_.Force(base_.x, k);
    most = std::max(most, std::fabs(force[k]));
  }
  Put(Lacking::What::kLessForce, 1,
      [&](std::size_t k, double* c) { c[0] = force[k] * std::fabs(force[k]) / most; });
  double below = most;
  for (int i = 0; i < kHalvings; ++i) {
    below *= 0.5;
    const Wanted small = [&](std::size_t k) { return std::fabs(force[k]) < below; };
    const auto r = rows_.Fit(small, 0, {});
    if (!r) return;
    Lacking lacking = LackingOf(Lacking::What::kLessForce, axis_, *r, rows_.LeftBy(base_.x, small));
    lacking.sure = std::fabs(lacking.inertia.value - base_.x(0)) / std::max(lacking.inertia.sigma, 1e-300);
    lacking.below = below;
    // Few rows are moved by much that is no matter of the force; the column made of it is there anyway.
    if (lacking.sure > kDisagree) Add(lacking);
  }
}

void Trial::Friction() {
  const Further curve = [&](std::size_t k, double* c) {
    c[0] = m_.velocity[k] * std::fabs(m_.velocity[k]) / m_.max_speed;
  };
  Put(Lacking::What::kCurve, 1, curve);
  // Nothing is put in here, so that it may be the worse of the two.
  if (const auto r = Rows(m_, falls_less_).Fit(kAll, 1, curve); r && r->left < base_.left)
    Add(LackingOf(Lacking::What::kFalls, axis_, *r, base_.left));
  if (base_.of_direction.minCoeff() > 0.0)
    if (const Regression* r = Put(Lacking::What::kDirection, 1,
                                  [&](std::size_t k, double* c) { c[0] = std::fabs(m_.velocity[k]); }))
      out_.back().viscous_varies = Varies(*r, {{kBase, 1.0}});
  const Further in_time = [&](std::size_t k, double* c) {
    const double at = static_cast<double>(k) / static_cast<double>(m_.size()) - 0.5;
    const double sign = std::copysign(1.0, m_.velocity[k]);
    c[0] = sign * at;
    c[1] = sign * SquareAboutMean(at);
    c[2] = m_.velocity[k] * at;
  };
  if (const Regression* r = Put(Lacking::What::kTime, 3, in_time)) {
    out_.back().level_varies = Varies(*r, {{kBase, kLinearRms}, {kBase + 1, kSquareRms}});
    out_.back().viscous_varies = Varies(*r, {{kBase + 2, kLinearRms}});
  }
}

void Trial::Places() {
  const auto at = [&](std::size_t k) { return (m_.position[k] - middle_) / travel_; };
  Put(Lacking::What::kSpring, 1, [&](std::size_t k, double* c) { c[0] = at(k); });
  const Further by_place = [&](std::size_t k, double* c) {
    const double sign = std::copysign(1.0, m_.velocity[k]);
    c[0] = sign * at(k);
    c[1] = sign * SquareAboutMean(at(k));
  };
  if (const Regression* r = Put(Lacking::What::kPlace, 2, by_place))
    out_.back().level_varies = Varies(*r, {{kBase, kLinearRms}, {kBase + 1, kSquareRms}});
}

const char* Words(Lacking::What what) {
  switch (what) {
    case Lacking::What::kLessForce:
      return "large forces do less than the log says of them, as where a drive is at its limit or its "
             "constant falls with the current (record with less acceleration, or what the drive measures "
             "of its force in place of what it is asked for)";
    case Lacking::What::kCurve:
      return "friction is no straight line over the speed";
    case Lacking::What::kFalls:
      return "friction falls with the speed for longer than is stated, as where it is no straight line over "
             "the speed";
    case Lacking::What::kDirection:
      return "viscous friction differs between the directions";
    case Lacking::What::kTime:
      return "friction changes in the course of the log (record when the axis is warm)";
    case Lacking::What::kPlace:
      return "friction goes with the place";
    case Lacking::What::kSpring:
      return "a force goes with the place (a spring, a cable, a weight that turns)";
  }
  return "";
}

}  // namespace

std::vector<Lacking> TryLacking(const AxisLog& log, const FittedRun& run) {
  SmoothedMotion m = SmoothMotion(log, run.axis, nullptr);
  if (!(m.max_speed > 0.0)) return {};
  const double inertia = run.axis.motor_inertia + run.axis.load_inertia;
  Signal given(m.size()), rest(m.size());
  for (std::size_t k = 0; k < m.size(); ++k) {
    // Forces are means over the row that begins, the motion is that of its beginning.
    const auto friction = [&](std::size_t i) {
      return run.traced.model_torque[i] - inertia * run.traced.acceleration[i];
    };
    const auto gave = [&](std::size_t i) { return run.traced.net_force[i] + friction(i); };
    given[k] = 0.5 * (gave(k) + gave(k > 0 ? k - 1 : 0));
    rest[k] = given[k] - friction(k);
  }
  m.command = SmoothAsMotion(given, log.period_s);
  return Trial(m, SmoothAsMotion(rest, log.period_s), run).All();
}

AxisLog WithCentreOfMass(AxisLog log, const StatedAxis& axis, const Signal& load_position) {
  const double share = axis.load_inertia / (axis.motor_inertia + axis.load_inertia);
  for (std::size_t k = 0; k < log.size(); ++k)
    log.position[k] += share * (load_position[k] - log.position[k]);
  return log;
}

std::string TextOf(const Lacking& lacking, bool linear) {
  std::string text = Words(lacking.what);
  if (lacking.below > 0.0)
    text += "; in rows of less than " + RoundedText(lacking.below) + (linear ? " N" : " Nm");
  return text;
}

double ShareAtLimit(const AxisLog& log) {
  double most = 0.0, rows = 0.0, there = 0.0;
  for (std::size_t k = 0; k < log.size(); ++k)
    if (log.present[k] != 0) most = std::max(most, std::fabs(log.command[k]));
  for (std::size_t k = 0; k < log.size(); ++k) {
    if (log.present[k] == 0) continue;
    rows += 1.0;
    there += std::fabs(log.command[k]) == most ? 1.0 : 0.0;
  }
  return rows > 0.0 ? there / rows : 0.0;
}

}  // namespace contour::diagnosis
