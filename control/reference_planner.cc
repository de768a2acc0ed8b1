#include "control/reference_planner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "control/control_law.h"
#include "control/path_weights.h"
#include "control/qp_solver.h"
#include "core/wide_numbers.h"

namespace contour {
namespace {

// Deviations below these are rounding: the plan has joined its reference.
constexpr double kJoined_m = 1e-11;
constexpr double kJoined_m_s = 1e-9;
// A reference this far from the last one's continuation has been set anew.
constexpr double kContinues_m = 1e-9;

template <std::size_t Axes>
class PlannerGroup final : public PlannerGroupBase {
 public:
  PlannerGroup(const PlannerConfig& config, const PerAxis<ControlledAxis>& axes, std::size_t first,
               double period_s)
      : first_(first),
        period_s_(period_s),
        iteration_cap_(config.iteration_cap),
        weights_(config.contour_bandwidth_Hz, config.lag_bandwidth_Hz, 1e-5, Dynamics(period_s)) {
    problem_.horizon = static_cast<std::size_t>(config.horizon);
    problem_.dynamics = Dynamics(period_s);
    for (std::size_t i = 0; i < Axes; ++i) {
      problem_.effort[i] = 1.0;
      bound_m_s2_[i] =
          config.torque_share * axes[first + i].limits.force_N / axes[first + i].mechanics.mass_kg;
    }
  }

  void Reset() noexcept override { state_ = State::kUnknown; }

  bool Decide(const PerAxis<AxisHorizon>& wanted) noexcept override {
    if (state_ != State::kUnknown && !Continues(wanted)) state_ = State::kUnknown;
    const bool possible = Possible(wanted);
    if (state_ == State::kPlanning && possible && Joined(wanted)) state_ = State::kFollowing;
    if (state_ == State::kUnknown || (state_ == State::kFollowing && possible)) {
      state_ = State::kFollowing;
      active_ = {};
      return false;
    }
    if (state_ == State::kFollowing) StartHere(wanted);
    state_ = State::kPlanning;
    Solve(wanted);
    return true;
  }

  void Write(const PerAxis<AxisHorizon>& wanted, PerAxis<AxisHorizon>* planned) noexcept override {
    if (planned != nullptr) {
      if (state_ == State::kPlanning) {
        RollOut(wanted, *planned);
      } else {
        for (std::size_t i = 0; i < Axes; ++i) (*planned)[first_ + i] = wanted[first_ + i];
      }
    }
    const PerAxis<AxisHorizon>& followed = planned != nullptr ? *planned : wanted;
    for (std::size_t i = 0; i < Axes; ++i) {
      present_[i] = PointAt(followed[first_ + i], 1);
      next_[i] = PointAt(followed[first_ + i], 2);
      expected_m_[i] = PointAt(wanted[first_ + i], 1).position_m;
    }
  }

  void Keep(StateKeeper& keep) noexcept override {
    keep(state_, present_, next_, expected_m_, active_, solution_);
  }

 private:
  enum class State { kUnknown, kFollowing, kPlanning };

  // Acceleration itself is the input: no lag, no friction.
  static std::array<AxisDynamics, Axes> Dynamics(double period_s) {
    std::array<AxisDynamics, Axes> dynamics;
    dynamics.fill(DiscretizeAxis(period_s, 0.0, 0.0));
    return dynamics;
  }

  [[nodiscard]] bool Continues(const PerAxis<AxisHorizon>& wanted) const noexcept {
    for (std::size_t i = 0; i < Axes; ++i) {
      const double jump = PointAt(wanted[first_ + i], 0).position_m - expected_m_[i];
      if (!(std::abs(jump) < kContinues_m)) return false;
    }
    return true;
  }

  [[nodiscard]] double Acceleration(const AxisHorizon& wanted, std::size_t node) const noexcept {
    return (PointAt(wanted, node + 1).velocity_m_s - PointAt(wanted, node).velocity_m_s) / period_s_;
  }

  [[nodiscard]] bool Possible(const PerAxis<AxisHorizon>& wanted) const noexcept {
    for (std::size_t i = 0; i < Axes; ++i) {
      const AxisHorizon& axis = wanted[first_ + i];
      const std::size_t end = std::min(axis.size(), problem_.horizon + 3);
      // Every cycle looks at every point: two steps at a time, and the loop's own counting would be half of
      // it.
      wide::Pair most{}, least{};
      std::size_t n = 2;
#pragma GCC unroll 8
      for (; n + 1 < end; n += 2) {
        const double middle_m_s = axis[n].velocity_m_s;
        const wide::Pair step = wide::Pair{middle_m_s, axis[n + 1].velocity_m_s} -
                                wide::Pair{axis[n - 1].velocity_m_s, middle_m_s};
        most = most < step ? step : most;
        least = step < least ? step : least;
      }
      double most_m_s = std::max(std::max(most[0], most[1]), -std::min(least[0], least[1]));
      if (n < end) most_m_s = std::max(most_m_s, std::abs(axis[n].velocity_m_s - axis[n - 1].velocity_m_s));
      if (most_m_s / period_s_ > bound_m_s2_[i]) return false;
    }
    return true;
  }

  [[nodiscard]] bool Joined(const PerAxis<AxisHorizon>& wanted) const noexcept {
    for (std::size_t i = 0; i < Axes; ++i) {
      const ReferencePoint& there = PointAt(wanted[first_ + i], 1);
      if (std::abs(next_[i].position_m - there.position_m) > kJoined_m) return false;
      if (std::abs(next_[i].velocity_m_s - there.velocity_m_s) > kJoined_m_s) return false;
    }
    return true;
  }

  void StartHere(const PerAxis<AxisHorizon>& wanted) noexcept {
    for (std::size_t i = 0; i < Axes; ++i) {
      present_[i] = PointAt(wanted[first_ + i], 0);
      next_[i] = PointAt(wanted[first_ + i], 1);
    }
  }

  // Deviations from the reference, accelerations clipped to what is possible; interval j is [node j+1, node
  // j+2).
  void Solve(const PerAxis<AxisHorizon>& wanted) noexcept {
    weights_.Fill(wanted, first_, problem_);
    const double half = 0.5 * period_s_ * period_s_;
    for (std::size_t i = 0; i < Axes; ++i) {
      const AxisHorizon& axis = wanted[first_ + i];
      for (std::size_t j = 0; j < problem_.horizon; ++j) {
        QpStage<Axes>& stage = problem_.stage[j];
        const ReferencePoint &from = PointAt(axis, j + 1), &to = PointAt(axis, j + 2);
        const double a = std::clamp(Acceleration(axis, j + 1), -bound_m_s2_[i], bound_m_s2_[i]);
        base_m_s2_[j][i] = a;
        stage.position_defect[i] = from.position_m + period_s_ * from.velocity_m_s + half * a - to.position_m;
        stage.velocity_defect[i] = from.velocity_m_s + period_s_ * a - to.velocity_m_s;
        stage.lowest[i] = -bound_m_s2_[i] - a;
        stage.highest[i] = bound_m_s2_[i] - a;
      }
      const ReferencePoint& start = PointAt(axis, 1);
      const double position = next_[i].position_m - start.position_m;
      const double velocity = next_[i].velocity_m_s - start.velocity_m_s;
      problem_.start.position[i] = position + period_s_ * velocity + problem_.stage[0].position_defect[i];
      problem_.start.velocity[i] = velocity + problem_.stage[0].velocity_defect[i];
    }
    for (std::size_t j = 0; j + 1 < problem_.horizon; ++j) active_[j] = active_[j + 1];
    solver_.Solve(problem_, iteration_cap_, active_, solution_);
  }

  void RollOut(const PerAxis<AxisHorizon>& wanted, PerAxis<AxisHorizon>& planned) noexcept {
    for (std::size_t i = 0; i < Axes; ++i) {
      const AxisHorizon& axis = wanted[first_ + i];
      AxisHorizon& out = planned[first_ + i];
      out.resize(axis.size());
      if (axis.empty()) continue;
      ReferencePoint point = next_[i];
      out[0] = present_[i];
      double before = (next_[i].velocity_m_s - present_[i].velocity_m_s) / period_s_;
      std::size_t node = 1;
      for (; node < axis.size() && node <= problem_.horizon; ++node) {
        const double a = base_m_s2_[node - 1][i] + solution_[node - 1][i];
        point.acceleration_m_s2 = 0.5 * (before + a);
        out[node] = point;
        point.position_m += period_s_ * (point.velocity_m_s + 0.5 * period_s_ * a);
        point.velocity_m_s += period_s_ * a;
        before = a;
      }
      // Beyond the plan: the reference, moved to where the plan ends.
      if (node < axis.size()) {
        const double offset = point.position_m - axis[node].position_m;
        for (; node < axis.size(); ++node) {
          out[node] = axis[node];
          out[node].position_m += offset;
        }
      }
    }
  }

  std::size_t first_;
  double period_s_;
  int iteration_cap_;
  PathWeights<Axes> weights_;
  AxisVector<Axes> bound_m_s2_{};
  State state_ = State::kUnknown;
  std::array<ReferencePoint, Axes> present_{};  // elements 0 and 1 of the next plan
  std::array<ReferencePoint, Axes> next_{};
  AxisVector<Axes> expected_m_{};  // element 0 of the next reference
  std::array<AxisVector<Axes>, kMaxHorizon> base_m_s2_{};
  QpProblem<Axes> problem_;
  QpSolver<Axes> solver_;
  typename QpSolver<Axes>::Active active_{};
  typename QpSolver<Axes>::Inputs solution_{};
};

}  // namespace

ReferencePlanner::ReferencePlanner(const PlannerConfig& config, const PerAxis<ControlledAxis>& axes,
                                   double period_s)
    : horizon_points_(config.horizon + 3) {
  if (config.horizon < 1 || config.horizon > static_cast<int>(kMaxHorizon)) {
    throw std::invalid_argument("planner: the horizon must be 1 to 40 cycles");
  }
  const std::size_t count = axes.size();
  if (count == 3) {
    groups_.push_back(std::make_unique<PlannerGroup<3>>(config, axes, 0, period_s));
    return;
  }
  std::size_t first = 0;
  for (; first + 2 <= count; first += 2) {
    groups_.push_back(std::make_unique<PlannerGroup<2>>(config, axes, first, period_s));
  }
  if (first < count) groups_.push_back(std::make_unique<PlannerGroup<1>>(config, axes, first, period_s));
}

void ReferencePlanner::Reset() noexcept {
  for (auto& group : groups_) group->Reset();
}

void ReferencePlanner::Plan(const PerAxis<AxisHorizon>& wanted, PerAxis<AxisHorizon>& planned) noexcept {
  bool any = false;
  for (auto& group : groups_) any = group->Decide(wanted) || any;
  planned.resize(any ? wanted.size() : 0);
  for (auto& group : groups_) group->Write(wanted, any ? &planned : nullptr);
}

}  // namespace contour
