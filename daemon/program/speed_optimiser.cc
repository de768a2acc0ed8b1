#include "daemon/program/speed_optimiser.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "daemon/program/speed_constraints.h"

namespace contour {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
// Time may be longer than the optimum by this share.
constexpr double kGap = 0.002;
constexpr int kMostSteps = 120;
constexpr double kWeightGrowth = 6.0;
// Steps per constraint that count as converged: on the way, and at the end.
constexpr double kRough = 0.02;
constexpr double kFine = 1e-4;
// Of the time that exceeding a lowered feed twice over costs.
constexpr double kPenalty = 1e3;
// A stop shall come to rest; and room that is left where a motion is beyond a limit. What is optimised again
// and again, as the feed changes, takes it every time.
constexpr double kStopGap = 1e-7;
constexpr double kAllowed = 1.0002;
constexpr double kAllowedInStop = 1.002;

/// Gradient and the three diagonals of a symmetric matrix.
struct System {
  std::vector<double> gradient, d0, d1, d2;

  explicit System(std::size_t n) : gradient(n), d0(n), d1(n), d2(n) {}
  void Clear() {
    for (auto* v : {&gradient, &d0, &d1, &d2}) std::fill(v->begin(), v->end(), 0.0);
  }
  void Add(std::size_t at, const SpeedWeights& g, double slope, double curvature) {
    for (std::size_t k = 0; k < 3; ++k) {
      gradient[at + k] += slope * g[k];
      d0[at + k] += curvature * g[k] * g[k];
    }
    d1[at] += curvature * g[0] * g[1];
    d1[at + 1] += curvature * g[1] * g[2];
    d2[at] += curvature * g[0] * g[2];
  }
};

/// Solves it for the free unknowns first..last (Cholesky, L D L^T) and returns -solution, 0 elsewhere; and
/// gradient times solution. The system is used up.
double Solve(System& s, std::size_t first, std::size_t last, std::vector<double>& step) {
  std::fill(step.begin(), step.end(), 0.0);
  double decrement = 0.0;
  for (std::size_t j = first; j <= last; ++j) {
    if (j >= first + 2) {
      const double l2 = s.d2[j - 2] / s.d0[j - 2];
      s.d0[j] -= l2 * s.d2[j - 2];
      s.gradient[j] -= l2 * s.gradient[j - 2];
    }
    if (j >= first + 1) {
      const double l1 = s.d1[j - 1] / s.d0[j - 1];
      s.d0[j] -= l1 * s.d1[j - 1];
      s.d1[j] -= l1 * s.d2[j - 1];
      s.gradient[j] -= l1 * s.gradient[j - 1];
    }
    decrement += s.gradient[j] * s.gradient[j] / s.d0[j];
  }
  for (std::size_t j = last + 1; j-- > first;) {
    double rest = -s.gradient[j];
    if (j + 1 <= last) rest -= s.d1[j] * step[j + 1];
    if (j + 2 <= last) rest -= s.d2[j] * step[j + 2];
    step[j] = rest / s.d0[j];
  }
  return decrement;
}

class Window {
 public:
  Window(const Stretch& stretch, const RestMap& map, const SpeedGoal& goal, std::size_t first,
         std::size_t last, const SpeedSpline& speed)
      : goal_(goal) {
    const std::size_t nodes = speed.u.size();
    const std::size_t first_node = first < 2 ? 0 : first - 2;
    const std::size_t last_node = std::min(nodes - 1, last + 1);
    constraints_ = ConstraintsOf(stretch, map, goal, speed, first_node, last_node);
    local_.u.assign(speed.u.begin() + static_cast<std::ptrdiff_t>(first_node),
                    speed.u.begin() + static_cast<std::ptrdiff_t>(last_node + 1));
    first_ = first - first_node;
    last_ = last - first_node;
    // Shares at the window's outer nodes are those of the whole.
    for (std::size_t i = first_node; i < last_node; ++i) weights_.push_back(WeightsOf(speed, i));
    local_.beta.assign(speed.beta.begin() + static_cast<std::ptrdiff_t>(first_node),
                       speed.beta.begin() + static_cast<std::ptrdiff_t>(last_node + 2));
    Soften();
    Allow();
  }

  void Optimise() {
    System system(local_.beta.size() + 1);
    std::vector<double> step(local_.beta.size() + 1), here = local_.beta, there = here;
    const double count =
        static_cast<double>((18 * constraints_.acceleration.size() + 5) * constraints_.intervals.size());
    double weight = count / Cost(here);
    double merit = Evaluate(here, weight, &system);
    for (int i = 0; i < kMostSteps; ++i) {
      const double decrement = Solve(system, first_, last_, step);
      if (!(decrement >= 0.0)) break;
      double length = 1.0;
      double next = kInfinite;
      for (int halvings = 0; halvings < 40; ++halvings, length *= 0.5) {
        for (std::size_t j = first_; j <= last_; ++j) there[j] = here[j] + length * step[j];
        next = Evaluate(there, weight, nullptr);
        if (next < merit - 1e-4 * length * decrement) break;
        next = kInfinite;
      }
      if (next < kInfinite) std::swap(here, there);
      const bool last = count / weight <= (stopping() ? kStopGap : kGap) * Cost(here);
      const bool stuck = !(next < kInfinite);
      if (last && (stuck || decrement < kFine * count)) break;
      if (!last && (stuck || (length == 1.0 && decrement < kRough * count))) weight *= kWeightGrowth;
      merit = Evaluate(here, weight, &system);
    }
    local_.beta = here;
  }

  void Give(std::size_t first, SpeedSpline& speed) const {
    for (std::size_t j = first_; j <= last_; ++j) speed.beta[first + j - first_] = local_.beta[j];
  }

 private:
  /// Where a lowered feed is kept already, it stays kept.
  void Soften() {
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      for (std::size_t m = 0; m < kSpeedPlaces; ++m) {
        SpeedConstraints::Place& p = constraints_.intervals[i][m];
        if (!(Dot(local_.beta, i, weights_[i].value[m]) < 0.999 * p.feed_cap)) continue;
        p.cap = std::min(p.cap, p.feed_cap);
        p.feed_cap = kInfinite;
      }
    }
  }

  /// What the motion to begin with needs, it may have: nodes may have been added where it was not looked at.
  void Allow() {
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      for (std::size_t m = 0; m < kSpeedPlaces; ++m) {
        SpeedConstraints::Place& p = constraints_.intervals[i][m];
        const double w = Dot(local_.beta, i, weights_[i].value[m]);
        const double s = Dot(local_.beta, i, weights_[i].slope[m]);
        const double b = Dot(local_.beta, i, weights_[i].bend);
        const double used = UseOf(constraints_, p, w, s, b);
        const double allowed = stopping() ? kAllowedInStop : kAllowed;
        p.allowance = std::max(1.0, allowed * used);
        p.cap = std::max(p.cap, allowed * w);
      }
    }
  }

  static double Dot(const std::vector<double>& beta, std::size_t at, const SpeedWeights& w) {
    return w[0] * beta[at] + w[1] * beta[at + 1] + w[2] * beta[at + 2];
  }

  [[nodiscard]] bool stopping() const { return goal_.feed_scale == 0.0; }

  /// Time, or for a stop what shall vanish.
  double Cost(const std::vector<double>& beta) const {
    double cost = 0.0;
    for (std::size_t i = 0; i < weights_.size(); ++i) cost += CostOf(beta, i, 0.0, nullptr);
    return cost;
  }

  double CostOf(const std::vector<double>& beta, std::size_t i, double weight, System* system) const {
    const IntervalWeights& v = weights_[i];
    const double h = local_.width(i);
    double cost = 0.0;
    for (const double at : {0.21132486540518713, 0.78867513459481287}) {
      const SpeedWeights g = v.ValueAt(at * h);
      const double w = Dot(beta, i, g);
      if (!(w > 0.0)) return kInfinite;
      if (stopping()) {
        const double unit = 0.5 * h / std::pow(goal_.floor, 1.5);
        cost += unit * w;
        if (system != nullptr) system->Add(i, g, weight * unit, 0.0);
        continue;
      }
      const double time = 0.5 * h / std::sqrt(w);
      cost += time;
      if (system != nullptr) system->Add(i, g, -0.5 * weight * time / w, 0.75 * weight * time / (w * w));
    }
    return cost;
  }

  /// -log of what is left; infinite: nothing.
  static double Barrier(double left, std::size_t at, const SpeedWeights& slope, System* system) {
    if (!(left > 0.0)) return kInfinite;
    if (system != nullptr) system->Add(at, slope, -1.0 / left, 1.0 / (left * left));
    return -std::log(left);
  }

  static SpeedWeights Sum(const SpeedWeights& a, double x, const SpeedWeights& b, double y) {
    return {x * a[0] + y * b[0], x * a[1] + y * b[1], x * a[2] + y * b[2]};
  }

  /// Velocity, acceleration and feed.
  double SpeedTerms(const std::vector<double>& beta, std::size_t i, std::size_t m, double weight,
                    System* system) const {
    const SpeedConstraints::Place& p = constraints_.intervals[i][m];
    const SpeedWeights& value = weights_[i].value[m];
    const SpeedWeights& slope = weights_[i].slope[m];
    const double w = Dot(beta, i, value), s = Dot(beta, i, slope);
    double sum = 0.0;
    if (p.cap < kInfinite) sum += Barrier(1.0 - w / p.cap, i, Sum(value, -1.0 / p.cap, slope, 0.0), system);
    for (std::size_t a = 0; a < p.first.size(); ++a) {
      const double limit = p.allowance * constraints_.acceleration[a];
      const double x1 = 0.5 * p.first[a] / limit;
      const double x2 = p.second[a] / limit;
      if (x1 == 0.0 && x2 == 0.0) continue;
      const double used = x2 * w + x1 * s;
      const SpeedWeights g = Sum(value, x2, slope, x1);
      sum += Barrier(1.0 - used, i, {-g[0], -g[1], -g[2]}, system) + Barrier(1.0 + used, i, g, system);
    }
    if (w > 0.99 * p.feed_cap && !stopping()) {
      const double over = w / p.feed_cap - 0.99;
      const double time = kPenalty * weight * p.width_u / std::sqrt(p.feed_cap);
      sum += time * over * over;
      if (system != nullptr)
        system->Add(i, value, 2.0 * time * over / p.feed_cap, 2.0 * time / (p.feed_cap * p.feed_cap));
    }
    return sum;
  }

  double JerkTerms(const std::vector<double>& beta, std::size_t i, std::size_t m, System* system) const {
    const SpeedConstraints::Place& p = constraints_.intervals[i][m];
    const SpeedWeights& value = weights_[i].value[m];
    const SpeedWeights& slope = weights_[i].slope[m];
    const SpeedWeights& bend = weights_[i].bend;
    const double w = Dot(beta, i, value), s = Dot(beta, i, slope), b = Dot(beta, i, bend);
    if (!(w > 0.0)) return kInfinite;
    const double room = 1.0 / std::sqrt(w);
    double sum = 0.0;
    for (std::size_t a = 0; a < p.first.size(); ++a) {
      const double j = p.allowance * constraints_.jerk[a];
      const double x1 = 0.5 * p.first[a] / j, x2 = 1.5 * p.second[a] / j, x3 = p.third[a] / j;
      if (x1 == 0.0 && x2 == 0.0 && x3 == 0.0) continue;
      const double used = x3 * w + x2 * s + x1 * b;
      SpeedWeights g;
      for (std::size_t k = 0; k < 3; ++k) g[k] = x3 * value[k] + x2 * slope[k] + x1 * bend[k];
      const double tangent = -0.5 * room / w;
      sum += Barrier(room - used, i, Sum(value, tangent, g, -1.0), system);
      sum += Barrier(room + used, i, Sum(value, tangent, g, 1.0), system);
      // The same scaled by the root, so that 1 is what may be used.
      sum += 2.0 * std::log(room);
      if (system != nullptr) system->Add(i, value, -1.0 / w, 0.0);
    }
    return sum;
  }

  double Evaluate(const std::vector<double>& beta, double weight, System* system) const {
    if (system != nullptr) system->Clear();
    double sum = 0.0;
    for (std::size_t j = first_; j <= last_; ++j) {
      if (!(beta[j] > 0.0)) return kInfinite;
      sum -= std::log(beta[j]);
      if (system != nullptr) {
        system->gradient[j] -= 1.0 / beta[j];
        system->d0[j] += 1.0 / (beta[j] * beta[j]);
      }
    }
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      sum += weight * CostOf(beta, i, weight, system);
      for (std::size_t m = 0; m < kSpeedPlaces; ++m) {
        // The end of one interval is the begin of the next.
        if (m + 1 < kSpeedPlaces || i + 1 == weights_.size()) sum += SpeedTerms(beta, i, m, weight, system);
        sum += JerkTerms(beta, i, m, system);
      }
      if (!(sum < kInfinite)) return kInfinite;
    }
    return sum;
  }

  SpeedGoal goal_;
  SpeedConstraints constraints_;
  SpeedSpline local_;  ///< the window's nodes and coefficients
  std::vector<IntervalWeights> weights_;
  std::size_t first_ = 0;
  std::size_t last_ = 0;
};

}  // namespace

void OptimiseSpeed(const Stretch& stretch, const RestMap& map, const SpeedGoal& goal, std::size_t first,
                   std::size_t last, SpeedSpline& speed) {
  Window window(stretch, map, goal, first, last, speed);
  window.Optimise();
  window.Give(first, speed);
}

}  // namespace contour
