#include "analysis/diagnosis/decision/held_out.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/decision/residual_trace.h"
#include "analysis/diagnosis/screening/score.h"
#include "analysis/diagnosis/tuning/decision_tuning.h"
#include "analysis/diagnosis/tuning/screening_tuning.h"
#include "analysis/diagnosis/tuning/statistics.h"
#include "analysis/prediction_error/products.h"

namespace contour::diagnosis {
namespace {

constexpr std::size_t kHeldOutBlocks = kBlocks;
// Factors on a diagonal: one holds a parameter, one keeps a solver away from zero.
constexpr double kHeld = 1e12, kRidge = 1.0 + 1e-12;
constexpr unsigned kSeed = 77;

// A shape's own number, such as an instant, may be in one block only: it stays; so does what the fit has
// taken to a bound, where no step leads to a minimum.
bool Stays(const Effect& effect, const std::vector<double>& amplitudes, std::size_t i) {
  const double a = amplitudes[i];
  return i >= effect.tested || (i < effect.low.size() && a <= effect.low[i]) ||
         (i < effect.high.size() && a >= effect.high[i]);
}

void HoldShapes(const Fit& fit, Eigen::MatrixXd& normal) {
  auto j = static_cast<Eigen::Index>(fit.point.base.size());
  for (std::size_t e = 0; e < fit.point.effects.size(); ++e)
    for (std::size_t i = 0; i < fit.point.amplitudes[e].size(); ++i, ++j)
      if (Stays(*fit.point.effects[e], fit.point.amplitudes[e], i)) normal(j, j) *= kHeld;
}

// Where a gain is seen: as a torque, on the scale, or in the white residual, as multiples of the noise. A
// coupling moves a resonance about, which a torque below 100 Hz does not have; what is about timing turns
// phases by a frequency times a time, and hardly does below it.
enum class Seen { kTorque, kScale, kWhite };

Seen SeenIn(const Problem& problem, const Fit& with, bool scale) {
  if (scale) return Seen::kScale;
  if (with.point.effects.empty()) return Seen::kTorque;
  const Effect& last = *with.point.effects.back();
  const CauseDefinition& cause = CauseNamed(last.kind);
  const bool in_rows = cause.coupling || cause.about_timing || FasterThanTheTorque(problem, last);
  return in_rows ? Seen::kWhite : Seen::kTorque;
}

// Of those at reversals a coupling is seen in the rows anyway, and a bristle of its own takes up a mismatch.
bool IsPlay(const Fit& with) {
  if (with.point.effects.empty()) return false;
  const CauseDefinition& last = CauseNamed(with.point.effects.back()->kind);
  return last.acts_at_reversals && !last.takes_up_mismatch;
}

// Blocks that stay together. A scale wanders for longer than a block: what its neighbours were fitted to has
// seen it.
std::size_t Together(Seen seen) {
  return seen == Seen::kScale ? static_cast<std::size_t>(std::sqrt(static_cast<double>(kHeldOutBlocks))) : 1;
}

std::size_t FoldOf(std::size_t block, Seen seen) { return block / Together(seen) % 2; }

// The priors of the base, added to what rows say; terms that are `believed` are held to where they are
// stated.
void AddPriors(const Problem& problem, const Fit& fit, const std::vector<std::size_t>& believed,
               Eigen::MatrixXd& normal, Eigen::VectorXd& gradient) {
  for (std::size_t i = 0; i < fit.point.base.size(); ++i) {
    const bool stated = std::find(believed.begin(), believed.end(), i) != believed.end();
    const auto j = static_cast<Eigen::Index>(i);
    const double prior = std::pow(problem.terms[i].sigma, -2);
    const double w = stated ? kHeld * std::max(fit.normal(j, j), prior) : prior;
    normal(j, j) += w;
    gradient(j) += w * fit.point.base[i];
  }
}

// Where the parameters go to first order when the blocks of one fold are left out, for either fold; terms of
// the base that are `believed` go to where they are stated.
std::vector<Eigen::VectorXd> StepsWithout(const Problem& problem, const Fit& fit, Seen seen,
                                          const std::vector<std::size_t>& believed) {
  const std::size_t n = problem.rows(), parts = problem.data_size() / n;
  const Eigen::Index p = fit.jacobian.cols();
  std::vector<Eigen::VectorXd> steps;
  for (std::size_t fold = 0; fold < 2; ++fold) {
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(p, p);
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(p);
    AddPriors(problem, fit, believed, normal, gradient);
    for (std::size_t b = 0; b < kHeldOutBlocks; ++b) {
      if (FoldOf(b, seen) == fold) continue;
      for (std::size_t part = 0; part < parts; ++part) {
        const auto from = static_cast<Eigen::Index>(part * n + n * b / kHeldOutBlocks);
        const auto rows = static_cast<Eigen::Index>(n * (b + 1) / kHeldOutBlocks - n * b / kHeldOutBlocks);
        const auto j = fit.jacobian.middleRows(from, rows);
        const Eigen::Map<const Eigen::VectorXd> r(fit.residual.data() + from, rows);
        normal.noalias() += j.transpose() * j;
        gradient.noalias() += j.transpose() * r;
      }
    }
    normal.diagonal() *= kRidge;
    HoldShapes(fit, normal);
    steps.push_back(-normal.ldlt().solve(gradient));
  }
  return steps;
}

double InertiaAt(const Problem& problem, const Point& point) {
  const AxisModel m = problem.Build(point);
  return m.motor_inertia + (m.two_inertia ? m.load_inertia : 0.0);
}

// Where a fit goes when the blocks of either fold are left out.
std::vector<Point> PointsWithout(const Problem& problem, const Fit& fit, Seen seen,
                                 const std::vector<std::size_t>& believed) {
  std::vector<Point> points;
  for (const Eigen::VectorXd& step : StepsWithout(problem, fit, seen, believed))
    points.push_back(Moved(fit.point, step));
  return points;
}

// What the parameters of a fold were asked for by: the squares of the blocks that it has seen, and the
// priors.
double CostOfSeen(const Problem& problem, const std::vector<double>& white, const Point& point,
                  std::size_t fold, Seen seen) {
  const std::size_t n = problem.rows(), parts = problem.data_size() / n;
  double cost = PriorOf(problem, point);
  for (std::size_t b = 0; b < kHeldOutBlocks; ++b) {
    if (FoldOf(b, seen) == fold) continue;
    for (std::size_t part = 0; part < parts; ++part)
      for (std::size_t k = n * b / kHeldOutBlocks; k < n * (b + 1) / kHeldOutBlocks; ++k)
        cost += std::pow(white[part * n + k], 2);
  }
  return cost;
}

Point Halfway(const Point& from, Point to) {
  for (std::size_t i = 0; i < to.base.size(); ++i) to.base[i] += (from.base[i] - to.base[i]) / 2.0;
  for (std::size_t e = 0; e < to.amplitudes.size(); ++e)
    for (std::size_t i = 0; i < to.amplitudes[e].size(); ++i)
      to.amplitudes[e][i] += (from.amplitudes[e][i] - to.amplitudes[e][i]) / 2.0;
  return to;
}

// Where numbers do nearly the same (a power of the speed near 1, and viscous friction), a linear step may end
// worse on the very rows that it was made of: it goes back by half until it does not.
void GoBackWhereWorse(const Problem& problem, const Fit& fit, Seen seen, std::span<Point> points,
                      std::span<std::vector<double>> raw) {
  for (std::size_t fold = 0; fold < points.size(); ++fold) {
    const double least = CostOfSeen(problem, fit.residual, fit.point, fold, seen);
    for (double share = 1.0; share > kScreening.negligible_share; share /= 2.0) {
      const std::vector<double> white = problem.White(raw.subspan(fold, 1))[0];
      if (CostOfSeen(problem, white, points[fold], fold, seen) <= least) break;
      points[fold] = Halfway(fit.point, std::move(points[fold]));
      raw[fold] = std::move(problem.Raw(std::span<const Point>(points.subspan(fold, 1)))[0]);
    }
  }
}

// Sum of squares of the residual in every block, each with the parameters of the fold that did not see it. As
// a torque it is what was not foreseen of the motion times an inertia: of all models the same one, or noise
// of the reading alone would make the heavier of two models the worse one.
std::vector<double> HeldOutSquares(const Problem& problem, std::span<const Point> points,
                                   std::span<const std::vector<double>> raw, Seen seen, double inertia) {
  const std::size_t n = problem.rows();
  std::vector<double> squares(kHeldOutBlocks, 0.0);
  for (std::size_t fold = 0; fold < 2; ++fold) {
    const Signal r = seen == Seen::kScale
                         ? Signal(raw[fold].begin() + static_cast<std::ptrdiff_t>(n), raw[fold].end())
                         : TorqueResidualFrom(problem, points[fold], raw[fold]);
    const double unit = seen == Seen::kScale ? 1.0 : inertia / InertiaAt(problem, points[fold]);
    for (std::size_t b = 0; b < kHeldOutBlocks; ++b)
      for (std::size_t k = n * b / kHeldOutBlocks; k < n * (b + 1) / kHeldOutBlocks; ++k)
        if (FoldOf(b, seen) == fold && problem.counted[k] != 0) squares[b] += std::pow(unit * r[k], 2);
  }
  return squares;
}

// What a block says about some of the parameters: the product of their columns, and the gradient.
struct BlockProducts {
  Eigen::MatrixXd normal;
  Eigen::VectorXd gradient;
};

std::vector<BlockProducts> ProductsOfBlocks(const Problem& problem, const Fit& fit) {
  const std::size_t n = problem.rows(), parts = problem.data_size() / n;
  const Eigen::Index p = fit.jacobian.cols();
  std::vector<BlockProducts> blocks(kHeldOutBlocks, {Eigen::MatrixXd::Zero(p, p), Eigen::VectorXd::Zero(p)});
  for (std::size_t b = 0; b < kHeldOutBlocks; ++b) {
    for (std::size_t part = 0; part < parts; ++part) {
      const auto from = static_cast<Eigen::Index>(part * n + n * b / kHeldOutBlocks);
      const auto rows = static_cast<Eigen::Index>(n * (b + 1) / kHeldOutBlocks - n * b / kHeldOutBlocks);
      const auto j = fit.jacobian.middleRows(from, rows);
      const Eigen::Map<const Eigen::VectorXd> r(fit.residual.data() + from, rows);
      blocks[b].normal.selfadjointView<Eigen::Lower>().rankUpdate(j.transpose());
      blocks[b].gradient.noalias() += j.transpose() * r;
    }
    blocks[b].normal.triangularView<Eigen::StrictlyUpper>() = blocks[b].normal.transpose();
  }
  return blocks;
}

// Sum of squares of a white residual in every block.
std::vector<double> WhiteSquares(const Problem& problem, const std::vector<double>& residual) {
  const std::size_t n = problem.rows(), parts = problem.data_size() / n;
  std::vector<double> squares(kHeldOutBlocks, 0.0);
  for (std::size_t b = 0; b < kHeldOutBlocks; ++b)
    for (std::size_t part = 0; part < parts; ++part)
      for (std::size_t k = n * b / kHeldOutBlocks; k < n * (b + 1) / kHeldOutBlocks; ++k)
        squares[b] += std::pow(residual[part * n + k], 2);
  return squares;
}

// The same, to first order, with the last effect as all other blocks ask for it. The rest follows it as in
// the whole log and is not asked for anew: what one block alone says about the base takes either model as far
// when that block is left out, and says nothing about the effect. `together`: blocks that are left out at
// once.
std::vector<double> UnseenSquares(const Problem& problem, const Fit& fit, std::size_t together) {
  std::vector<double> squares = WhiteSquares(problem, fit.residual);
  const Eigen::Index p = fit.jacobian.cols();
  const auto own = static_cast<Eigen::Index>(fit.point.amplitudes.back().size());
  const Eigen::Index others = p - own;
  const std::vector<BlockProducts> blocks = ProductsOfBlocks(problem, fit);
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(p, p);
  for (std::size_t i = 0; i < fit.point.base.size(); ++i)
    normal(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) = std::pow(problem.terms[i].sigma, -2);
  for (const BlockProducts& block : blocks) normal += block.normal;
  normal.diagonal() *= kRidge;
  HoldShapes(fit, normal);
  Eigen::MatrixXd along(p, own);
  along.topRows(others) =
      -normal.topLeftCorner(others, others).ldlt().solve(normal.topRightCorner(others, own));
  along.bottomRows(own).setIdentity();
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(own, own);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(own);
  std::vector<BlockProducts> projected;
  for (const BlockProducts& block : blocks) {
    projected.push_back({along.transpose() * block.normal * along, along.transpose() * block.gradient});
    information += projected.back().normal;
    gradient += projected.back().gradient;
  }
  for (std::size_t b = 0; b < kHeldOutBlocks; ++b) {
    Eigen::MatrixXd left = information;
    Eigen::VectorXd rest = gradient;
    const std::size_t from = b / together * together;
    for (std::size_t o = from; o < std::min(kHeldOutBlocks, from + together); ++o) {
      left -= projected[o].normal;
      rest -= projected[o].gradient;
    }
    left.diagonal() *= kRidge;
    for (std::size_t i = 0; i < static_cast<std::size_t>(own); ++i)
      if (Stays(*fit.point.effects.back(), fit.point.amplitudes.back(), i))
        left(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) *= kHeld;
    const Eigen::VectorXd step = -left.ldlt().solve(rest);
    squares[b] += 2.0 * step.dot(projected[b].gradient) + step.dot(projected[b].normal * step);
  }
  return squares;
}

// The white residual with numbers of the base where they are stated, and the rest as the log has it then.
std::vector<double> ResidualWithStated(const Problem& problem, const Fit& fit,
                                       const std::vector<std::size_t>& believed) {
  if (believed.empty()) return fit.residual;
  Eigen::MatrixXd normal = fit.normal;
  Eigen::VectorXd gradient = GradientOf(fit.jacobian, fit.residual);
  AddPriors(problem, fit, believed, normal, gradient);
  normal.diagonal() *= kRidge;
  HoldShapes(fit, normal);
  const Point point = Moved(fit.point, -normal.ldlt().solve(gradient));
  return problem.Residuals(std::span(&point, 1))[0];
}

}  // namespace

double Consistency(const Problem& problem, const Fit& without, const Fit& with, LeftOut left_out) {
  const std::vector<double> before = WhiteSquares(problem, without.residual);
  const std::vector<double> after =
      left_out == LeftOut::kNothing
          ? WhiteSquares(problem, with.residual)
          : UnseenSquares(problem, with, left_out == LeftOut::kBlock ? 1 : Together(Seen::kScale));
  double sum = 0.0, squares = 0.0;
  for (std::size_t b = 0; b < kHeldOutBlocks; ++b) {
    sum += before[b] - after[b];
    squares += std::pow(before[b] - after[b], 2);
  }
  return sum / std::sqrt(squares + 1e-300);
}

namespace {

struct Squares {
  std::vector<double> before, after;  ///< of every block
};

Squares SquaresOf(const Problem& problem, const Fit& without, const Fit& with, Seen seen,
                  const std::vector<std::size_t>& stated) {
  if (seen == Seen::kWhite)
    return {WhiteSquares(problem, ResidualWithStated(problem, without, stated)),
            UnseenSquares(problem, with, 1)};
  const double inertia = InertiaAt(problem, without.point);
  std::vector<Point> points = PointsWithout(problem, without, seen, stated);
  for (Point& p : PointsWithout(problem, with, seen, {})) points.push_back(std::move(p));
  auto raw = problem.Raw(points);
  if (stated.empty())
    GoBackWhereWorse(problem, without, seen, std::span(points).first(2), std::span(raw).first(2));
  GoBackWhereWorse(problem, with, seen, std::span(points).last(2), std::span(raw).last(2));
  const std::span<const Point> both(points);
  const std::span<const std::vector<double>> runs(raw);
  return {HeldOutSquares(problem, both.first(2), runs.first(2), seen, inertia),
          HeldOutSquares(problem, both.last(2), runs.last(2), seen, inertia)};
}

void TellGain(const Problem& problem, const Squares& squares, Seen seen, Cause& cause,
              std::vector<BlockGain>& blocks) {
  const std::vector<double>&before = squares.before, &after = squares.after;
  const double n = static_cast<double>(problem.rows()) / kHeldOutBlocks;
  double sum_before = 0.0, sum_after = 0.0;
  blocks.clear();
  for (std::size_t b = 0; b < kHeldOutBlocks; ++b) {
    sum_before += before[b];
    sum_after += after[b];
    const double gain = before[b] > 0.0 ? 1.0 - std::sqrt(after[b] / before[b]) : 0.0;
    blocks.push_back({static_cast<double>(b) * n * problem.log.period_s,
                      static_cast<double>(b + 1) * n * problem.log.period_s, gain});
  }
  const double unit = seen == Seen::kScale ? 1e6 : 1.0;
  cause.unit = seen == Seen::kScale   ? "um"
               : seen == Seen::kWhite ? "times the noise"
                                      : (problem.log.linear ? "N" : "Nm");
  cause.heldout_rms_before = unit * std::sqrt(sum_before / (n * kHeldOutBlocks));
  cause.heldout_rms_after = unit * std::sqrt(sum_after / (n * kHeldOutBlocks));
  cause.heldout_gain = 1.0 - std::sqrt(sum_after / sum_before);
  std::mt19937_64 random(kSeed);
  std::vector<double> gains;
  const std::size_t together = Together(seen), groups = (kHeldOutBlocks + together - 1) / together;
  for (int draw = 0; draw < kThreshold.flip_draws; ++draw) {
    double x = 0.0, y = 0.0;
    for (std::size_t b = 0; b < kHeldOutBlocks; b += together) {
      const std::size_t from = random() % groups * together;
      for (std::size_t i = from; i < std::min(kHeldOutBlocks, from + together); ++i) {
        x += before[i];
        y += after[i];
      }
    }
    gains.push_back(1.0 - std::sqrt(y / std::max(x, 1e-300)));
  }
  std::sort(gains.begin(), gains.end());
  cause.heldout_gain_low = gains[HeldOutDraw(kTail95)];
  cause.heldout_gain_high = gains[HeldOutDraw(1.0 - kTail95)];
}

}  // namespace

bool HeldOutGain(const Problem& problem, const Fit& without, const Fit& with, bool scale, Cause& cause,
                 std::vector<BlockGain>& blocks) {
  const Seen seen = SeenIn(problem, with, scale);
  // The base has taken a number of its own to where the log wants it: what it gains is over what is stated.
  const std::vector<std::size_t> stated = with.point.effects.empty()
                                              ? std::vector<std::size_t>{}
                                              : FreedTerms(problem, with.point.effects.back()->kind);
  TellGain(problem, SquaresOf(problem, without, with, seen, stated), seen, cause, blocks);
  if (seen != Seen::kTorque || cause.heldout_gain_high >= 0.0) return true;
  // A few blocks in which the axis sticks may have more torque that nobody foresees than all others have in
  // all: which model slips at the better instant there is chance. Where most blocks gain all the same, the
  // rows are asked: as multiples of the noise that each has, those blocks count no more than the others.
  // A play is in few blocks at any rate, and its impacts are chaotic.
  if (!IsPlay(with) && !MostGain(blocks)) return true;
  Cause white;
  std::vector<BlockGain> of_white;
  const Squares rows = SquaresOf(problem, without, with, Seen::kWhite, stated);
  TellGain(problem, rows, Seen::kWhite, white, of_white);
  if (!(white.heldout_gain_low > 0.0)) return true;
  TellGain(problem, rows, Seen::kWhite, cause, blocks);
  return false;
}

bool FoldsShareTheStroke(const Problem& problem) {
  const Signal& position = problem.signals->position;
  const auto [low, high] = std::minmax_element(position.begin(), position.end());
  if (!(*high > *low)) return false;
  std::array<unsigned, kHeldOutBlocks> folds{};
  const std::size_t n = problem.rows();
  for (std::size_t b = 0; b < kHeldOutBlocks; ++b)
    for (std::size_t k = n * b / kHeldOutBlocks; k < n * (b + 1) / kHeldOutBlocks; ++k) {
      const auto place = static_cast<std::size_t>(kHeldOutBlocks * (position[k] - *low) / (*high - *low));
      folds[std::min(place, kHeldOutBlocks - 1)] |= 1U << FoldOf(b, Seen::kScale);
    }
  const auto both = std::count(folds.begin(), folds.end(), 1U | 2U);
  return 2 * both > std::count_if(folds.begin(), folds.end(), [](unsigned in) { return in != 0; });
}

}  // namespace contour::diagnosis
