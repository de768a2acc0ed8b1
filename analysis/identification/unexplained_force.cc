#include "analysis/identification/unexplained_force.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <random>
#include <unsupported/Eigen/FFT>

#include "analysis/identification/follow_gain.h"
#include "analysis/identification/linear_step.h"
#include "analysis/identification/simulation.h"

namespace contour::identify {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Poles and slots of servo motors make 6 to some 50 waves a turn.
constexpr int kOrders = 60;
/// Speeds from bin to bin, the slowest as a share of the Stribeck velocity.
constexpr double kNextSpeed = 2.0, kSlowest = 1.0 / 16.0;
constexpr std::size_t kSpeeds = 11;
/// Travels since the last reversal, from a share of what the bristle bends.
constexpr double kNextTravel = 2.0, kShortest = 1.0 / 8.0;
constexpr std::size_t kTravels = 8;
constexpr std::size_t kPlaces = 8;
/// Long against any wave that sliding sees, short against a stroke.
constexpr double kBlock_s = 1.0;
/// So slow is a reversal, and so long the difference that tells the speed.
constexpr double kSpeedOver_s = 0.008;
constexpr double kLeastError_m = 1e-12;
/// Of the mean curvature: what hardly anything shows, or shows together with others only, stays small.
constexpr double kRidge = 1e-4;
/// Of noise, to see what it makes of each motion: a block has a thousand rows, so a few are as good as many.
constexpr int kDraws = 4;
/// How large it is shows in the quieter quarter of blocks; friction answers a small noise by less, so what
/// was drawn too large is drawn again.
constexpr double kQuieter = 0.25;
constexpr int kRounds = 2;
/// Of the bandwidth with which the simulation follows a record.
constexpr double kLoosely = 0.1;

/// Columns of the forces: waves, then for each direction speeds, travels and places.
constexpr Index kColumns = 2 * kOrders + 2 * static_cast<Index>(kSpeeds + kTravels + kPlaces);

std::size_t Bin(double x, double first, double next, std::size_t bins) {
  if (!(x > first)) return 0;
  return std::min(bins - 1, static_cast<std::size_t>(std::log(x / first) / std::log(next)));
}

/// The forces of each row, one after the other.
class Forces {
 public:
  Forces(const TableAxis& axis, const Measured& d)
      : axis_(axis),
        d_(d),
        reach_(static_cast<std::size_t>(std::max(1.0, kSpeedOver_s / d.period_s))),
        bends_m_(0.5 * (axis.friction.Fc_plus + axis.friction.Fc_minus) / axis.friction.s0),
        still_m_(std::max(2.0 * d.position_step_m, kShortest * bends_m_)) {}

  /// What goes with angle, direction, place, speed and travel at row k; nothing where a sample lacks.
  void Fill(std::size_t k, Eigen::Ref<Eigen::RowVectorXd> force);

 private:
  /// A reversal is one when the axis has come back by more than it trembles.
  void Follow(double x);

  const TableAxis& axis_;
  const Measured& d_;
  std::size_t reach_;
  double bends_m_, still_m_;
  double direction_ = 0.0, turned_m_ = 0.0, extreme_m_ = 0.0;
};

void Forces::Follow(double x) {
  if (direction_ == 0.0) {
    extreme_m_ = turned_m_ = x;
    direction_ = 1.0;
  }
  if ((x - extreme_m_) * direction_ > 0.0) extreme_m_ = x;
  if ((extreme_m_ - x) * direction_ <= still_m_) return;
  direction_ = -direction_;
  turned_m_ = extreme_m_;
  extreme_m_ = x;
}

void Forces::Fill(std::size_t k, Eigen::Ref<Eigen::RowVectorXd> force) {
  force.setZero();
  if (k < reach_ || k + reach_ >= d_.size()) return;
  if (d_.present[k - reach_] == 0 || d_.present[k] == 0 || d_.present[k + reach_] == 0) return;
  const double x = d_.position_m[k];
  Follow(x);
  if (axis_.turn_m > 0.0) {
    const double angle = 2.0 * std::numbers::pi * x / axis_.turn_m;
    const double c = std::cos(angle), s = std::sin(angle);
    double cn = c, sn = s;
    for (Index n = 0; n < kOrders; ++n) {
      force(2 * n) = cn;
      force(2 * n + 1) = sn;
      const double next = cn * c - sn * s;
      sn = sn * c + cn * s;
      cn = next;
    }
  }
  const Index side = direction_ > 0.0 ? 0 : 1;
  const auto at = [&](std::size_t group, std::size_t bin) {
    force(2 * kOrders + 2 * static_cast<Index>(group + bin) + side) = 1.0;
  };
  const double span_s = 2.0 * static_cast<double>(reach_) * d_.period_s;
  const double speed = std::fabs(d_.position_m[k + reach_] - d_.position_m[k - reach_]) / span_s;
  at(0, Bin(speed, kSlowest * axis_.friction.vs, kNextSpeed, kSpeeds));
  at(kSpeeds, Bin(std::fabs(x - turned_m_), kShortest * bends_m_, kNextTravel, kTravels));
  const LevelVariation& v = axis_.variation;
  const double part = v.high_m > v.low_m ? (x - v.low_m) / (v.high_m - v.low_m) : 0.0;
  at(kSpeeds + kTravels,
     std::min(kPlaces - 1, static_cast<std::size_t>(std::clamp(part, 0.0, 1.0) * kPlaces)));
}

/// Sums of squares and products over half of the blocks.
struct Half {
  MatrixXd seen = MatrixXd::Zero(kColumns, kColumns);
  VectorXd right = VectorXd::Zero(kColumns);
  double errors = 0.0;

  /// Every block counts alike, however large its errors are.
  void Add(const MatrixXd& what, const VectorXd& e) {
    const double mean = e.squaredNorm() / static_cast<double>(e.size());
    const double weight = 1.0 / std::max(kLeastError_m * kLeastError_m, mean);
    seen.selfadjointView<Eigen::Lower>().rankUpdate(what.transpose(), weight);
    right += weight * (what.transpose() * e);
    errors += weight * e.squaredNorm();
  }
  [[nodiscard]] VectorXd Solve() const {
    MatrixXd all = seen.selfadjointView<Eigen::Lower>();
    all.diagonal().array() += kRidge * all.diagonal().mean() + 1e-300;
    return all.ldlt().solve(right);
  }
  /// What a force leaves of the errors.
  [[nodiscard]] double Left(const VectorXd& found) const {
    const VectorXd product = seen.selfadjointView<Eigen::Lower>() * found;
    return errors - 2.0 * found.dot(right) + found.dot(product);
  }
};

/// Share of the errors' variance, every block alike, that a force explains which was fitted to other blocks.
double RepeatingShare(const std::array<Half, 2>& half) {
  const double left = half[0].Left(half[1].Solve()) + half[1].Left(half[0].Solve());
  const double whole = half[0].errors + half[1].errors;
  return whole > 0.0 ? std::clamp(1.0 - left / whole, 0.0, 1.0) : 0.0;
}

/// The axis's linear motion against the simulation that is corrected by its gain.
Eigen::Matrix4d Corrected(const LinearStep& step, const FollowGain& gain) {
  Eigen::Matrix4d left = Eigen::Matrix4d::Identity();
  left.col(0) -= gain;
  return step.a * left;
}

/// Prediction error under a force of 1 N that lasts.
double ErrorPerForce_m_N(const LinearStep& step, const FollowGain& gain) {
  const Eigen::Matrix4d left = Eigen::Matrix4d::Identity() - Corrected(step, gain);
  return left.completeOrthogonalDecomposition().solve(step.table)(0);
}

/// What white noise makes of prediction errors, as shares of their mean square.
struct White {
  double force = 0.0, reading = 0.0;
  double per_force_m2_N2 = 0.0, per_reading = 0.0;  ///< mean square of the errors per that of the noise
  [[nodiscard]] double share() const { return std::min(1.0, force + reading); }
};

/// Standard deviations.
struct Noise {
  double force_N, reading_m;
};

/// Noise that makes errors of this mean square.
Noise NoiseOf(const White& white, double square_m2) {
  return {std::sqrt(white.force * square_m2 / std::max(1e-300, white.per_force_m2_N2)),
          std::sqrt(white.reading * square_m2 / std::max(1e-300, white.per_reading))};
}

/// Mean spectrum of the errors, every block alike, and what of it noise that is white explains, of the force
/// and of the readings: as much as their quick half has, where motion leaves the least.
class WhiteShare {
 public:
  void Add(const VectorXd& e) {
    const double mean = e.squaredNorm() / static_cast<double>(e.size());
    if (!(mean > kLeastError_m * kLeastError_m)) return;
    std::vector<double> part(kSpectrum);
    std::vector<std::complex<double>> spectrum;
    for (Index b = 0; b + static_cast<Index>(kSpectrum) <= e.size(); b += static_cast<Index>(kSpectrum) / 2) {
      for (std::size_t i = 0; i < kSpectrum; ++i)
        part[i] =
            (0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (static_cast<double>(i) + 0.5) / kSpectrum)) *
            e(b + static_cast<Index>(i));
      fft_.fwd(spectrum, part);
      for (std::size_t f = 0; f <= kSpectrum / 2; ++f)
        power_(static_cast<Index>(f)) += std::norm(spectrum[f]) / mean;
    }
  }
  [[nodiscard]] White Of(const LinearStep& step, const FollowGain& gain) const;

 private:
  static constexpr std::size_t kSpectrum = 128;
  Eigen::FFT<double> fft_;
  VectorXd power_ = VectorXd::Zero(kSpectrum / 2 + 1);
};

White WhiteShare::Of(const LinearStep& step, const FollowGain& gain) const {
  const Eigen::Matrix4cd corrected = Corrected(step, gain).cast<std::complex<double>>();
  const Eigen::Vector4cd by_force = step.motor.cast<std::complex<double>>();
  const Eigen::Vector4cd by_reading = (step.a * gain).cast<std::complex<double>>();
  MatrixXd noise(power_.size(), 2);
  for (Index f = 0; f < noise.rows(); ++f) {
    const std::complex<double> z =
        std::polar(1.0, std::numbers::pi * static_cast<double>(f) / static_cast<double>(noise.rows() - 1));
    const Eigen::FullPivLU<Eigen::Matrix4cd> solver(z * Eigen::Matrix4cd::Identity() - corrected);
    noise(f, 0) = std::norm(solver.solve(by_force)(0));
    noise(f, 1) = std::norm(1.0 - solver.solve(by_reading)(0));
  }
  White white;
  // Of both halves of the circle: lines but the first and the last count twice.
  const auto mean = [](const auto& line) {
    const Index n = line.size();
    return (2.0 * line.sum() - line(0) - line(n - 1)) / static_cast<double>(2 * (n - 1));
  };
  white.per_force_m2_N2 = mean(noise.col(0));
  white.per_reading = mean(noise.col(1));
  const double largest = noise.col(0).maxCoeff();
  noise.col(0) /= largest;
  // In shares of the spectrum, which spans decades; both or, where one would be negative, the better one
  // alone.
  const Index quick = noise.rows() / 2;
  const MatrixXd x = noise.bottomRows(quick).array().colwise() / power_.tail(quick).array().max(1e-300);
  const VectorXd ones = VectorXd::Ones(quick);
  VectorXd found = x.colPivHouseholderQr().solve(ones);
  if (found.minCoeff() < 0.0) {
    const Eigen::Vector2d alone(x.col(0).sum() / x.col(0).squaredNorm(),
                                x.col(1).sum() / x.col(1).squaredNorm());
    const bool force = (ones - alone(0) * x.col(0)).norm() < (ones - alone(1) * x.col(1)).norm();
    found = force ? Eigen::Vector2d(alone(0), 0.0) : Eigen::Vector2d(0.0, alone(1));
  }
  const double all = power_.sum();
  if (!(all > 0.0)) return {0.0, 1.0, white.per_force_m2_N2, white.per_reading};
  white.force = std::clamp(found(0) * noise.col(0).sum() / all, 0.0, 1.0);
  white.reading = std::clamp(found(1) * noise.col(1).sum() / all, 0.0, 1.0 - white.force);
  return white;
}

/// The records as they would be if the axis were the model, led by the same force and white noise; held to
/// where it was, but loosely, or it would wander off.
std::vector<Measured> AsTheModelWouldBe(const TableAxis& axis, const std::vector<Measured>& records,
                                        double force_N, double reading_m, std::mt19937& random, int threads) {
  std::normal_distribution<double> normal;
  std::vector<Measured> noisy = records;
  for (Measured& d : noisy)
    for (double& f : d.led_by_drive() ? d.reported_N : d.force_N) f += force_N * normal(random);
  const VectorXd away =
      PredictionErrors_m({{axis, FollowGainFor(axis, records.front(), kLoosely)}}, noisy, threads).col(0);
  std::vector<Measured> lived = records;
  Index row = 0;
  for (Measured& d : lived)
    for (double& x : d.position_m) x += reading_m * normal(random) - away(row++);
  return lived;
}

/// A block of time: how many rows, and of what its errors are a share.
struct Block {
  Index first, rows;
  double of_friction;
};

double Quantile(std::vector<double> x, double share) {
  const auto at = x.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(x.size()));
  std::nth_element(x.begin(), at, x.end());
  return *at;
}
double Mean(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double v : x) sum += v / static_cast<double>(x.size());
  return sum;
}

std::vector<double> Squares(const std::vector<Block>& blocks, const VectorXd& errors) {
  std::vector<double> squares;
  for (const Block& b : blocks)
    squares.push_back(b.of_friction * errors.segment(b.first, b.rows).squaredNorm() /
                      static_cast<double>(b.rows));
  return squares;
}

/// Mean square of the errors in each block that noise makes, of a size that the quieter blocks allow: it is
/// in all of them. About to break away, an axis answers a force by much more than while it slides, and noise
/// is as uneven then as what goes with the motion; how much, the model says, living through the record with
/// it.
std::vector<double> SquaresByNoise(const Followed& followed, const std::vector<Measured>& records,
                                   const std::vector<Block>& blocks, const std::vector<double>& seen,
                                   Noise noise, int threads) {
  std::mt19937 random(1);
  const auto errors = [&](double force, double reading) -> VectorXd {
    const auto lived = AsTheModelWouldBe(followed.axis, records, force, reading, random, threads);
    return PredictionErrors_m({followed}, lived, threads).col(0);
  };
  const VectorXd without = errors(0.0, 0.0);
  std::vector<double> squares;
  for (int round = 0; round < kRounds; ++round) {
    squares.assign(blocks.size(), 0.0);
    for (int draw = 0; draw < kDraws; ++draw) {
      const std::vector<double> one = Squares(blocks, errors(noise.force_N, noise.reading_m) - without);
      for (std::size_t i = 0; i < one.size(); ++i) squares[i] += one[i] / kDraws;
    }
    std::vector<double> of_seen;
    for (std::size_t i = 0; i < squares.size(); ++i)
      if (squares[i] > 0.0) of_seen.push_back(seen[i] / squares[i]);
    if (of_seen.empty()) return squares;
    const double quiet = Quantile(std::move(of_seen), kQuieter);
    for (double& square : squares) square *= quiet;
    noise.force_N *= std::sqrt(quiet);
    noise.reading_m *= std::sqrt(quiet);
  }
  return squares;
}

/// Mean square of the quick force that is sent in rows: a wave of a chirp has half of its amplitude's square.
double Quick_N2(const Measured& d, Index begin, Index rows) {
  const std::vector<double>& sent_N = d.led_by_drive() ? d.offset_N : d.force_N;
  double sum = 0.0;
  for (Index k = std::max<Index>(1, begin); k < begin + rows; ++k)
    sum += 0.5 * std::pow(sent_N[static_cast<std::size_t>(k)] - sent_N[static_cast<std::size_t>(k - 1)], 2);
  return sum / static_cast<double>(rows);
}

}  // namespace

UnexplainedForce FindUnexplainedForce(const TableAxis& axis, const std::vector<Measured>& records,
                                      int threads) {
  const FollowGain gain = FollowGainFor(axis, records.front());
  const VectorXd errors = PredictionErrors_m({{axis, gain}}, records, threads).col(0);
  UnexplainedForce u;
  u.friction_N = 0.5 * (axis.friction.Fc_plus + axis.friction.Fc_minus);
  if (!errors.allFinite()) {
    u.structure_N = std::numeric_limits<double>::infinity();
    return u;
  }
  // Friction, once broken away, hardly changes with a force.
  const LinearStep step = Over(axis, axis.friction.s2, records.front().period_s);
  const auto block = static_cast<Index>(std::max(1.0, kBlock_s / records.front().period_s));
  std::array<Half, 2> half;
  WhiteShare spectrum;
  std::vector<Block> blocks;
  Index first = 0;
  for (const Measured& d : records) {
    Forces forces(axis, d);
    Eigen::Matrix4Xd apart = Eigen::Matrix4Xd::Zero(4, kColumns);
    Eigen::RowVectorXd force(kColumns);
    for (Index b = 0; b < static_cast<Index>(d.size()); b += block) {
      const Index rows = std::min(block, static_cast<Index>(d.size()) - b);
      MatrixXd seen(rows, kColumns);
      for (Index i = 0; i < rows; ++i) {
        // Corrected as the simulation is.
        seen.row(i) = apart.row(0);
        apart -= gain * apart.row(0).eval();
        forces.Fill(static_cast<std::size_t>(b + i), force);
        apart = (step.a * apart).eval();
        apart += step.table * force;
      }
      const VectorXd e = errors.segment(first + b, rows);
      half[blocks.size() % 2].Add(seen, e);
      spectrum.Add(e);
      // What shakes the axis is, with friction, what the errors are a share of.
      const double friction_N2 = u.friction_N * u.friction_N;
      blocks.push_back({first + b, rows, friction_N2 / (friction_N2 + Quick_N2(d, b, rows))});
    }
    first += static_cast<Index>(d.size());
  }
  const std::vector<double> squares = Squares(blocks, errors);
  const double all = Mean(squares), typical = std::min(all, Quantile(squares, 0.5));
  const White white = spectrum.Of(step, gain);
  const double share = std::max(RepeatingShare(half), 1.0 - white.share());
  const double by_noise =
      Mean(SquaresByNoise({axis, gain}, records, blocks, squares, NoiseOf(white, typical), threads));
  const double noise = std::isfinite(by_noise) ? std::min(all, (1.0 - share) * by_noise) : 0.0;
  const double per_N = ErrorPerForce_m_N(step, gain);
  u.structure_N = std::sqrt(std::max(share * typical, all - noise)) / per_N;
  u.noise_N = std::sqrt(noise) / per_N;
  return u;
}

}  // namespace contour::identify
