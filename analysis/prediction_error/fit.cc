#include "analysis/prediction_error/fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/diagnosis/tuning/prediction_tuning.h"
#include "analysis/prediction_error/common_factor.h"
#include "analysis/prediction_error/products.h"
#include "analysis/prediction_error/simd/lanes.h"

namespace contour::diagnosis {
namespace {

using Column = Eigen::Map<const Eigen::VectorXd>;

Column ColumnOf(const std::vector<double>& v) { return {v.data(), static_cast<Eigen::Index>(v.size())}; }

double StepOf(const Problem& problem, const Point& p, std::size_t i) {
  if (i < p.base.size()) return problem.terms[i].step;
  i -= p.base.size();
  for (std::size_t e = 0; e < p.effects.size(); ++e) {
    if (i < p.amplitudes[e].size()) return p.effects[e]->steps[i];
    i -= p.amplitudes[e].size();
  }
  return 0.0;
}

/// One fit, which says what runs it needs next and goes on when it has them.
class Descent {
 public:
  Descent(const Problem& problem, InitialGuess guess, Extent extent)
      : problem_(problem),
        effort_(guess.effort),
        size_(static_cast<Eigen::Index>(problem.data_size(extent))) {
    fit_.point = std::move(guess.point);
    count_ = ParameterCount(fit_.point);
    const auto columns = static_cast<Eigen::Index>(count_);
    weight_ = Eigen::VectorXd::Zero(columns);
    for (std::size_t i = 0; i < fit_.point.base.size(); ++i)
      weight_(static_cast<Eigen::Index>(i)) = std::pow(problem.terms[i].sigma, -2);
    if (guess.continued != nullptr) {
      known_ = columns;
      fit_ = std::move(*guess.continued);
      fit_.converged = false;
      stale_ = false;
      return;
    }
    if (guess.known == nullptr) return;
    const Fit& known = *guess.known;
    known_ = known.jacobian.cols();
    if (known_ == columns) {
      fit_ = known;
      fit_.converged = false;
    } else if (known_ > columns) {
      known_ = columns;
      fit_.jacobian = known.jacobian.leftCols(columns);
      fit_.raw_jacobian = known.raw_jacobian.leftCols(columns);
      fit_.normal = known.normal.topLeftCorner(columns, columns);
    } else {
      fit_.jacobian.resize(size_, columns);
      fit_.raw_jacobian.resize(size_, columns);
      fit_.jacobian.leftCols(known_) = known.jacobian;
      fit_.raw_jacobian.leftCols(known_) = known.raw_jacobian;
      fit_.normal = Eigen::MatrixXd::Zero(columns, columns);
      fit_.normal.topLeftCorner(known_, known_) = known.normal;
    }
    stale_ = false;
  }

  /// None: at the end. `room`: as many points cost no more than one.
  std::vector<Point> Ask(std::size_t room) {
    if (fit_.raw.empty()) return AskBegin();
    if (stage_ == Stage::kBegin) {
      stage_ = Stage::kStep;
      if (!stale_ && known_ < static_cast<Eigen::Index>(count_)) return AskColumns(known_);
      Plan();
    }
    if (stage_ == Stage::kColumns) return AskColumns(0);
    if (stage_ == Stage::kEnd) return {};
    Try(room);
    chosen_ = tried_.size();
    before_ = fit_.cost;
    return tried_;
  }

  /// What it does not keep stays with the caller.
  void Take(std::size_t i, std::vector<double>& raw, std::vector<double>& white) {
    if (begins_ && i == 0) {
      fit_.prior = PriorOf(problem_, fit_.point);
      fit_.cost = ColumnOf(white).squaredNorm() + fit_.prior;
      fit_.raw = std::move(raw);
      fit_.residual = std::move(white);
      return;
    }
    switch (stage_) {
      case Stage::kColumns: {
        const std::size_t at = static_cast<std::size_t>(from_) + i - (begins_ ? 1 : 0);
        const double step = StepOf(problem_, fit_.point, at);
        const auto column = static_cast<Eigen::Index>(at);
        fit_.raw_jacobian.col(column) = (ColumnOf(raw) - ColumnOf(fit_.raw)) / step;
        fit_.jacobian.col(column) = (ColumnOf(white) - ColumnOf(fit_.residual)) / step;
        break;
      }
      case Stage::kStep: {
        const double prior = PriorOf(problem_, tried_[i]);
        const double cost = ColumnOf(white).squaredNorm() + prior;
        if (!std::isfinite(cost) || cost >= fit_.cost) break;
        chosen_ = i;
        fit_.cost = cost;
        fit_.prior = prior;
        std::swap(chosen_raw_, raw);
        std::swap(chosen_white_, white);
        break;
      }
      case Stage::kBegin:
      case Stage::kEnd:
        break;
    }
  }

  /// All that was asked for has come.
  void Proceed() {
    begins_ = false;
    switch (stage_) {
      case Stage::kColumns:
        MakeConsistent(problem_, fit_.point, fit_.jacobian);
        MakeConsistent(problem_, fit_.point, fit_.raw_jacobian);
        AddProducts(fit_.jacobian, 0, fit_.normal);
        stale_ = false;
        ++refreshes_;
        if (closing_)
          stage_ = Stage::kEnd;
        else
          PlanStep(from_ == 0);
        break;
      case Stage::kStep:
        Choose();
        break;
      case Stage::kBegin:
      case Stage::kEnd:
        break;
    }
  }

  Fit Result() {
    const auto columns = static_cast<Eigen::Index>(count_);
    fit_.covariance = Normal().ldlt().solve(Eigen::MatrixXd::Identity(columns, columns));
    return std::move(fit_);
  }

 private:
  enum class Stage { kBegin, kColumns, kStep, kEnd };

  Eigen::MatrixXd Normal() const {
    Eigen::MatrixXd normal = fit_.normal;
    normal.diagonal() += weight_;
    normal.diagonal().array() += 1e-18 * normal.diagonal().maxCoeff();
    return normal;
  }

  /// The point; the sensitivities that are asked for next whatever its cost ride along.
  std::vector<Point> AskBegin() {
    begins_ = true;
    stage_ = Stage::kBegin;
    std::vector<Point> asked = {fit_.point}, around;
    if (!stale_ && known_ < static_cast<Eigen::Index>(count_))
      around = AskColumns(known_);
    else if (stale_ && effort_.most_refreshes > 0 && effort_.most_steps > 0)
      around = AskColumns(0);
    std::move(around.begin(), around.end(), std::back_inserter(asked));
    return asked;
  }

  std::vector<Point> AskColumns(Eigen::Index from) {
    stage_ = Stage::kColumns;
    from_ = from;
    const auto columns = static_cast<Eigen::Index>(count_);
    if (from == 0) {
      fit_.jacobian.resize(size_, columns);
      fit_.raw_jacobian.resize(size_, columns);
      fit_.normal.resize(columns, columns);
    }
    std::vector<Point> around;
    for (Eigen::Index i = from; i < columns; ++i) {
      Eigen::VectorXd by = Eigen::VectorXd::Zero(columns);
      by(i) = StepOf(problem_, fit_.point, static_cast<std::size_t>(i));
      around.push_back(Moved(fit_.point, by));
    }
    return around;
  }

  /// Shorter, longer and damped steps (Marquardt, SIAM Journal 11(2), 1963) ride along in lanes that would be
  /// empty otherwise. A curved basin lets only small or damped ones pass.
  void Try(std::size_t room) {
    tried_.clear();
    const std::size_t most = std::max<std::size_t>(small_ ? 4 : 2, room);
    const auto along = [&](double part) {
      if (tried_.size() < most) tried_.push_back(Moved(fit_.point, part * by_));
    };
    const auto damped = [&](double by) {
      if (tried_.size() < most) tried_.push_back(Moved(fit_.point, DampedStep(by)));
    };
    if (small_) {
      along(0.1);
      for (const double by : {0.03, 0.003, 0.3}) damped(by);
      along(0.02);
      return;
    }
    along(1.0);
    along(0.4);
    damped(0.03);
    along(1.4);
    damped(0.003);
    along(0.15);
    damped(0.3);
  }

  Eigen::VectorXd DampedStep(double by) const {
    Eigen::MatrixXd normal = Normal();
    normal.diagonal() += by * fit_.normal.diagonal();
    return -normal.ldlt().solve(gradient_);
  }

  void Plan() {
    if (steps_ >= effort_.most_steps) return Close(false);
    if (stale_ && refreshes_ < effort_.most_refreshes)
      stage_ = Stage::kColumns;
    else
      PlanStep(false);
  }

  void PlanStep(bool fresh) {
    fresh_ = fresh;
    last_chance_ = fresh || refreshes_ >= effort_.most_refreshes;
    Eigen::VectorXd gradient = GradientOf(fit_.jacobian, fit_.residual);
    for (std::size_t i = 0; i < fit_.point.base.size(); ++i)
      gradient(static_cast<Eigen::Index>(i)) += weight_(static_cast<Eigen::Index>(i)) * fit_.point.base[i];
    gradient_ = gradient;
    by_ = -Normal().ldlt().solve(gradient);
    promised_ = -gradient.dot(by_);
    fit_.promised = kept_ * promised_;
    const double enough = std::max(effort_.close_enough, effort_.share_enough * (effort_.from - fit_.cost));
    if (promised_ < enough) {
      fit_.converged = true;
      if (last_chance_ || promised_ < 0.5 * enough) return Close(fresh);
    }
    if (steps_ >= effort_.most_steps) return Close(fresh);
    if (fit_.cost - promised_ > effort_.hopeless_above) {
      effort_.covariance = false;
      return Close(fresh);
    }
    stage_ = Stage::kStep;
  }

  void Choose() {
    ++steps_;
    const double gained = before_ - fit_.cost;
    kept_ = std::clamp(gained / promised_, 0.0, 1.0);
    fit_.promised = kept_ * promised_;
    if (chosen_ < tried_.size()) {
      if (gained < kFits.stale_share * promised_ || chosen_ > 0) stale_ = true;
      fit_.point = std::move(tried_[chosen_]);
      std::swap(fit_.raw, chosen_raw_);
      std::swap(fit_.residual, chosen_white_);
      // A cost that is rough, or sensitivities that serve no more: small steps lead nowhere either, nor do
      // sensitivities renewed once more where a step by new ones has kept next to nothing.
      const bool little = gained < kFits.kept_share * promised_;
      if (little && ((small_ && last_chance_) || (fresh_ && gained < kFits.worth_while))) {
        fit_.converged = true;
        return Close(false);
      }
      small_ = false;
    } else {
      if (last_chance_ && !small_ && promised_ > kFits.worth_while) {
        small_ = true;
        return;
      }
      if (last_chance_) {
        fit_.converged = true;
        return Close(fresh_);
      }
      stale_ = true;
    }
    Plan();
  }

  void Close(bool fresh) {
    closing_ = effort_.covariance && !fresh && stale_ && refreshes_ <= effort_.most_refreshes;
    stage_ = closing_ ? Stage::kColumns : Stage::kEnd;
  }

  const Problem& problem_;
  FitEffort effort_;
  Eigen::Index size_;
  Fit fit_;
  std::size_t count_ = 0;
  Eigen::Index known_ = 0, from_ = 0;
  Eigen::VectorXd weight_, by_, gradient_;
  Stage stage_ = Stage::kBegin;
  bool begins_ = false;  // the point itself is asked for first
  bool stale_ = true, fresh_ = false, last_chance_ = false, closing_ = false;
  int steps_ = 0, refreshes_ = 0;
  double promised_ = 0.0, before_ = 0.0;
  double kept_ = 1.0;   // of what the last step promised
  bool small_ = false;  // steps, since larger ones lead nowhere
  std::vector<Point> tried_;
  std::size_t chosen_ = 0;
  std::vector<double> chosen_raw_, chosen_white_;
};

}  // namespace

bool Plausible(const Problem& problem, const Point& point) {
  return PriorOf(problem, point) <= kFits.hardly_ever * static_cast<double>(problem.terms.size());
}

double PriorOf(const Problem& problem, const Point& p) {
  double sum = 0.0;
  for (std::size_t i = 0; i < p.base.size(); ++i) sum += std::pow(p.base[i] / problem.terms[i].sigma, 2);
  return sum;
}

Point Moved(Point p, const Eigen::VectorXd& by) {
  Eigen::Index j = 0;
  for (double& x : p.base) x += by(j++);
  for (std::size_t e = 0; e < p.effects.size(); ++e)
    for (std::size_t i = 0; i < p.amplitudes[e].size(); ++i) {
      double& a = p.amplitudes[e][i];
      a += by(j++);
      if (!p.effects[e]->low.empty()) a = std::clamp(a, p.effects[e]->low[i], p.effects[e]->high[i]);
    }
  return p;
}

std::size_t ParameterCount(const Point& p) {
  std::size_t n = p.base.size();
  for (const auto& a : p.amplitudes) n += a.size();
  return n;
}

std::vector<Fit> FitPoints(const Problem& problem, std::vector<InitialGuess> guesses, Extent extent) {
  std::vector<Descent> descents;
  std::vector<const Problem*> seen;
  for (InitialGuess& b : guesses) {
    seen.push_back(b.seen != nullptr ? b.seen : &problem);
    descents.emplace_back(*seen.back(), std::move(b), extent);
  }
  std::vector<bool> going(descents.size(), true);
  for (;;) {
    const auto left = static_cast<std::size_t>(std::count(going.begin(), going.end(), true));
    std::vector<Point> points;
    std::vector<std::pair<std::size_t, std::size_t>> owners;
    for (std::size_t d = 0; d < descents.size(); ++d) {
      if (!going[d]) continue;
      std::vector<Point> asked = descents[d].Ask(kLanes / std::max<std::size_t>(1, left));
      going[d] = !asked.empty();
      for (std::size_t i = 0; i < asked.size(); ++i) owners.emplace_back(d, i);
      std::move(asked.begin(), asked.end(), std::back_inserter(points));
    }
    if (points.empty()) break;
    constexpr std::size_t kAtOnce = 4 * kLanes;  // bounds the memory
    for (std::size_t first = 0; first < points.size(); first += kAtOnce) {
      const std::size_t count = std::min(kAtOnce, points.size() - first);
      std::vector<AxisModel> models;
      for (std::size_t i = first; i < first + count; ++i) models.push_back(problem.Build(points[i]));
      std::vector<std::vector<double>> raw = problem.Raw(models, extent);
      const auto seen_by = [&](std::size_t i) { return seen[owners[first + i].first]; };
      for (std::size_t from = 0, to = 0; from < count; from = to) {
        while (to < count && seen_by(to) == seen_by(from)) ++to;
        std::vector<std::vector<double>> white =
            seen_by(from)->White(std::span(raw).subspan(from, to - from), extent);
        for (std::size_t i = from; i < to; ++i) {
          const auto [owner, place] = owners[first + i];
          descents[owner].Take(place, raw[i], white[i - from]);
          for (std::vector<double>* unused : {&raw[i], &white[i - from]})
            problem.setup.spare->Give(std::move(*unused));
        }
      }
    }
    for (std::size_t d = 0; d < descents.size(); ++d)
      if (going[d]) descents[d].Proceed();
  }
  std::vector<Fit> fits;
  for (Descent& d : descents) fits.push_back(d.Result());
  return fits;
}

Fit FitPoint(const Problem& problem, Point start, const FitEffort& effort, Extent extent) {
  return std::move(FitPoints(problem, {{std::move(start), effort}}, extent)[0]);
}

Fit FitOn(const Problem& problem, Fit fit, const FitEffort& effort) {
  return std::move(FitPoints(problem, {{fit.point, effort, nullptr, &fit}})[0]);
}

}  // namespace contour::diagnosis
