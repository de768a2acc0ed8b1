#include "tools/validation/hidden/residual.h"
#include "tools/validation/hidden/specimens.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace contour::hidden {
namespace {

using Series = std::vector<double>;

constexpr double kPeriod_s = 1e-3;
constexpr double kBand_Hz = 100.0;
constexpr int kTaps = 20;          ///< to either side of the low-pass
constexpr std::size_t kEvery = 4;  ///< row that is kept after the low-pass
constexpr int kPieces = 8;         ///< of a period, for the torque's weight
/// Rows at both ends that the filters spoil.
constexpr std::size_t kEdge = 64;

/// Base parameters, seen at the motor.
struct Base {
  double inertia, Fc, Fs, vs, s0, s1, vd, s2, lag_s, wind_rad_Nm, load_share;
  int exponent;
};

Base BaseOf(const TrueAxis& t) {
  const double r = t.radius_m_rad();
  const double inertia = t.motor_inertia_kgm2 + r * r * t.table_mass_kg;
  return {inertia,
          t.Fc_N * r,
          t.Fs_N * r,
          t.vs_mm_s * 1e-3 / r,
          t.sigma0_N_m * r * r,
          t.sigma1_Ns_m * r * r,
          t.sigma1_decay_mm_s * 1e-3 / r,
          t.sigma2_Ns_m * r * r,
          t.lag_ms * 1e-3,
          1.0 / (t.stiffness_N_um * 1e6 * r * r),
          r * r * t.table_mass_kg / inertia,
          t.stribeck_exponent};
}

/// Mean torque of each period weighted by a hat over two of them, which is how a second difference of the
/// angle weighs it.
Series HatTorque(const Series& command, double lag_s) {
  Series piece_sums(command.size() + 1, 0.0);
  Series rising(command.size() + 1, 0.0);
  double x = 0.0;
  const double h = kPeriod_s / kPieces;
  const double decay = lag_s > 0.0 ? std::exp(-h / lag_s) : 0.0;
  for (std::size_t k = 1; k < command.size(); ++k) {
    const double u = command[k - 1];  // one period from the row to its effect
    for (int i = 0; i < kPieces; ++i) {
      const double mean = u + (x - u) * (lag_s > 0.0 ? lag_s / h * (1.0 - decay) : 0.0);
      x = u + (x - u) * decay;
      const double up = (i + 0.5) / kPieces;
      rising[k] += mean * up / kPieces;
      piece_sums[k] += mean * (1.0 - up) / kPieces;
    }
  }
  Series hat(command.size(), 0.0);
  for (std::size_t k = 1; k < command.size(); ++k) hat[k] = rising[k - 1] + piece_sums[k];
  return hat;
}

/// Friction along the measured angle, with the same weight.
Series HatFriction(const Series& angle, const Base& b) {
  Series mean(angle.size(), 0.0);
  double z = 0.0;
  for (std::size_t k = 0; k + 1 < angle.size(); ++k) {
    const double w = (angle[k + 1] - angle[k]) / kPeriod_s;
    const double y = std::abs(w) / b.vs;
    const double g = b.Fc + (b.Fs - b.Fc) * std::exp(b.exponent == 2 ? -y * y : -y);
    const double x = b.s0 * std::abs(w) * kPeriod_s / g;
    const double left = std::exp(-x);
    const double average = x > 1e-9 ? (1.0 - left) / x : 1.0;
    const double next = z * left + w * kPeriod_s * average;
    const double end = x > 1e-12 ? g / b.s0 * (w > 0.0 ? 1.0 : -1.0) : z;
    // Mean of z over the period, exactly; mean of its rate is the difference.
    const double mean_z = end + (z - end) * average;
    const double s1 = b.s1 * std::exp(-(w / b.vd) * (w / b.vd));
    mean[k] = b.s0 * mean_z + s1 * (next - z) / kPeriod_s + b.s2 * w;
    z = next;
  }
  Series hat(angle.size(), 0.0);
  for (std::size_t k = 1; k < angle.size(); ++k) hat[k] = 0.5 * (mean[k - 1] + mean[k]);
  return hat;
}

Series LowPassed(const Series& x) {
  std::array<double, 2 * kTaps + 1> taps{};
  double sum = 0.0;
  for (int i = -kTaps; i <= kTaps; ++i) {
    const double t = 2.0 * kBand_Hz * kPeriod_s * i;
    const double sinc = i == 0 ? 1.0 : std::sin(std::numbers::pi * t) / (std::numbers::pi * t);
    taps[static_cast<std::size_t>(i + kTaps)] =
        sinc * (0.5 + 0.5 * std::cos(std::numbers::pi * i / (kTaps + 1)));
    sum += taps[static_cast<std::size_t>(i + kTaps)];
  }
  Series out;
  for (std::size_t k = kEdge; k + kEdge < x.size(); k += kEvery) {
    double y = 0.0;
    for (std::size_t i = 0; i < taps.size(); ++i) y += taps[i] * x[k + i - kTaps];
    out.push_back(y / sum);
  }
  return out;
}

struct Signals {
  Series torque;  ///< residual
  Series scale;   ///< residual, m; empty without a scale
};

Signals SignalsOf(const diagnosis::AxisLog& log, const Base& b, double radius) {
  const Series& angle = log.position;
  const Series applied = HatTorque(log.command, b.lag_s);
  const Series friction = HatFriction(angle, b);
  Series torque(angle.size(), 0.0);
  Series wind(angle.size(), 0.0);
  for (std::size_t k = 1; k + 1 < angle.size(); ++k) {
    const double a = (angle[k + 1] - 2.0 * angle[k] + angle[k - 1]) / (kPeriod_s * kPeriod_s);
    torque[k] = applied[k] - b.inertia * a - friction[k];
    // The screw carries the table's share of the accelerating torque and the friction.
    wind[k] = b.wind_rad_Nm * (b.load_share * (applied[k] - friction[k]) + friction[k]);
  }
  Signals s;
  s.torque = LowPassed(torque);
  if (log.table_position_m.size() == angle.size() && !angle.empty()) {
    Series scale(angle.size(), 0.0);
    for (std::size_t k = 0; k < angle.size(); ++k)
      scale[k] = log.table_position_m[k] - radius * (angle[k] - wind[k]);
    s.scale = LowPassed(scale);
  }
  return s;
}

double MeanSquare(const Eigen::VectorXd& x) { return x.squaredNorm() / static_cast<double>(x.size()); }

/// What the columns can take away while each stays within twice its uncertainty of what is stated.
struct Refit {
  Eigen::MatrixXd columns;
  Eigen::VectorXd sigma;   ///< relative, one standard deviation
  Eigen::VectorXd stated;  ///< of each parameter, relative to the truth
};

double Left(const Eigen::VectorXd& r, const Refit& refit) {
  constexpr double kWithin = 2.0;
  const Eigen::Index n = refit.columns.cols();
  const Eigen::MatrixXd gram = refit.columns.transpose() * refit.columns;
  const Eigen::VectorXd gradient = refit.columns.transpose() * r;
  const Eigen::VectorXd low = refit.stated - kWithin * refit.sigma;
  const Eigen::VectorXd high = refit.stated + kWithin * refit.sigma;
  // Coordinate descent: a small convex problem with bounds.
  Eigen::VectorXd step = Eigen::VectorXd::Zero(n);
  for (int sweep = 0; sweep < 2000; ++sweep) {
    for (Eigen::Index i = 0; i < n; ++i) {
      if (!(gram(i, i) > 0.0)) continue;
      const double slope = gradient[i] + gram.row(i).dot(step);
      step[i] = std::clamp(step[i] - slope / gram(i, i), low[i], high[i]);
    }
  }
  return MeanSquare(r + refit.columns * step);
}

Eigen::VectorXd AsVector(const Series& s) {
  return Eigen::Map<const Eigen::VectorXd>(s.data(), static_cast<Eigen::Index>(s.size()));
}

}  // namespace

Residuals ResidualsOf(const diagnosis::AxisLog& log, const Setting& setting) {
  const Base base = BaseOf(setting.truth);
  const double radius = setting.truth.radius_m_rad();
  const Signals zero = SignalsOf(log, base, radius);
  constexpr double kStep = 2e-3;
  std::vector<std::pair<double Base::*, double>> free = {{&Base::inertia, 0.05}, {&Base::Fc, 0.1},
                                                         {&Base::s0, 0.2},       {&Base::s1, 0.3},
                                                         {&Base::s2, 0.15},      {&Base::lag_s, 0.1}};
  if (setting.stated.Fs_N > 1.05 * setting.stated.Fc_N) {
    free.push_back({&Base::Fs, 0.1});
    free.push_back({&Base::vs, 0.2});
  }
  if (!setting.rigid) free.push_back({&Base::wind_rad_Nm, 0.1});
  const Eigen::VectorXd r = AsVector(zero.torque);
  const Eigen::VectorXd e = AsVector(zero.scale);
  const Base stated = BaseOf(setting.stated);
  const auto count = static_cast<Eigen::Index>(free.size());
  Refit torque{Eigen::MatrixXd::Zero(r.size(), count), Eigen::VectorXd(count), Eigen::VectorXd(count)};
  Refit scale{Eigen::MatrixXd::Zero(e.size(), count + 1), Eigen::VectorXd(count + 1),
              Eigen::VectorXd::Zero(count + 1)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& [member, spread] = free[static_cast<std::size_t>(i)];
    Base moved = base;
    moved.*member *= 1.0 + kStep;
    const Signals s = SignalsOf(log, moved, radius);
    torque.columns.col(i) = (AsVector(s.torque) - r) / kStep;
    torque.sigma[i] = spread;
    torque.stated[i] = stated.*member / base.*member - 1.0;
    if (e.size() > 0) scale.columns.col(i) = (AsVector(s.scale) - e) / kStep;
  }
  Residuals out;
  out.torque_Nm2 = Left(r, torque);
  if (e.size() > 0) {
    scale.sigma.head(count) = torque.sigma;
    scale.stated.head(count) = torque.stated;
    // Where a scale has its zero means nothing.
    scale.columns.col(count).setOnes();
    scale.sigma[count] = 1.0;
    out.scale_m2 = Left(e, scale);
  }
  double sum = 0.0;
  for (std::size_t k = 1; k + 1 < log.position.size(); ++k)
    sum += std::pow(log.position[k + 1] - 2.0 * log.position[k] + log.position[k - 1], 2);
  out.second_difference = sum / static_cast<double>(log.position.size());
  return out;
}

using diagnosis::StrengthIn;

double Relevant(const Residuals& r, const std::string& kind) {
  const diagnosis::Specimen* specimen = SpecimenOf(kind);
  const StrengthIn in = specimen == nullptr ? StrengthIn::kTorque : *specimen->strength_in;
  if (in == StrengthIn::kSecondDifference) return r.second_difference;
  const bool scale = in == StrengthIn::kScale || (in == StrengthIn::kScaleWhereFitted && r.scale_m2 > 0.0);
  return scale ? r.scale_m2 : r.torque_Nm2;
}

}  // namespace contour::hidden
