#include "control/working_set.h"

#include <algorithm>

namespace contour {
namespace {

template <std::size_t Axes>
double ValueBound(const QpProblem<Axes>& problem, std::size_t j, std::size_t i, int side) noexcept {
  return side < 0 ? problem.stage[j].lowest[i] : problem.stage[j].highest[i];
}

template <std::size_t Axes>
double StepBound(const QpProblem<Axes>& problem, std::size_t j, std::size_t i, int side) noexcept {
  return side < 0 ? problem.stage[j].lowest_step[i] : problem.stage[j].highest_step[i];
}

// A run of inputs chained by active steps: stages first .. last, with its anchor if it has one.
struct Run {
  std::size_t first = 0;
  std::size_t last = 0;
  std::size_t anchor = 0;
  bool anchored = false;
};

template <std::size_t Axes>
Run RunFrom(const QpProblem<Axes>& problem, const ActiveSet<Axes>& active, std::size_t first,
            std::size_t i) noexcept {
  Run run{first, first, 0, false};
  for (std::size_t j = first;; ++j) {
    if (active[j][i].value != 0) {
      run.anchor = j;
      run.anchored = true;
    }
    run.last = j;
    if (j + 1 == problem.horizon || active[j + 1][i].step == 0) return run;
  }
}

}  // namespace

template <std::size_t Axes>
void FoldFirstStep(QpProblem<Axes>& problem) noexcept {
  QpStage<Axes>& stage = problem.stage[0];
  for (std::size_t i = 0; i < Axes; ++i) {
    if (!problem.has_rate_limit[i]) continue;
    const double lowest = stage.lowest[i], highest = stage.highest[i];
    stage.lowest[i] = std::clamp(problem.previous[i] + stage.lowest_step[i], lowest, highest);
    stage.highest[i] = std::clamp(problem.previous[i] + stage.highest_step[i], lowest, highest);
  }
}

template <std::size_t Axes>
void HoldActive(const QpProblem<Axes>& problem, const ActiveSet<Axes>& active,
                typename Riccati<Axes>::Holding& holding) noexcept {
  for (std::size_t i = 0; i < Axes; ++i) {
    for (std::size_t first = 0; first < problem.horizon;) {
      const Run run = RunFrom(problem, active, first, i);
      if (run.anchored) {
        const double at = ValueBound(problem, run.anchor, i, active[run.anchor][i].value);
        holding[run.anchor].how[i] = Hold::kFixed;
        holding[run.anchor].value[i] = at;
        for (std::size_t j = run.anchor; j-- > run.first;) {
          holding[j].how[i] = Hold::kFixed;
          holding[j].value[i] = holding[j + 1].value[i] - StepBound(problem, j + 1, i, active[j + 1][i].step);
        }
        for (std::size_t j = run.anchor + 1; j <= run.last; ++j) {
          holding[j].how[i] = Hold::kFixed;
          holding[j].value[i] = holding[j - 1].value[i] + StepBound(problem, j, i, active[j][i].step);
        }
      } else {
        holding[run.first].how[i] = Hold::kFree;
        for (std::size_t j = run.first + 1; j <= run.last; ++j) {
          holding[j].how[i] = Hold::kTied;
          holding[j].value[i] = StepBound(problem, j, i, active[j][i].step);
        }
      }
      first = run.last + 1;
    }
  }
}

// Stationarity of stage j: gradient_j + value_j + step_j - step_{j+1} = 0, step zero outside the run.
template <std::size_t Axes>
void FindMultipliers(const QpProblem<Axes>& problem, const ActiveSet<Axes>& active,
                     const typename Riccati<Axes>::Inputs& gradient,
                     Multipliers<Axes>& multipliers) noexcept {
  for (std::size_t i = 0; i < Axes; ++i) {
    for (std::size_t first = 0; first < problem.horizon;) {
      const Run run = RunFrom(problem, active, first, i);
      for (std::size_t j = run.first; j <= run.last; ++j)
        multipliers.value[j][i] = multipliers.step[j][i] = 0.0;
      const std::size_t meet = run.anchored ? run.anchor : run.first;
      double before = 0.0;  // multiplier of the step into the meeting stage
      for (std::size_t j = run.first; j < meet; ++j) {
        before += gradient[j][i];
        multipliers.step[j + 1][i] = before;
      }
      double after = 0.0;
      for (std::size_t j = run.last; j > meet; --j) {
        after -= gradient[j][i];
        multipliers.step[j][i] = after;
      }
      if (run.anchored) multipliers.value[meet][i] = after - before - gradient[meet][i];
      first = run.last + 1;
    }
  }
}

template <std::size_t Axes>
void ClipForward(const QpProblem<Axes>& problem, typename Riccati<Axes>::Inputs& input,
                 ActiveSet<Axes>& active) noexcept {
  for (std::size_t i = 0; i < Axes; ++i) {
    for (std::size_t j = 0; j < problem.horizon; ++j) {
      const QpStage<Axes>& stage = problem.stage[j];
      double& u = input[j][i];
      ActiveBounds& at = active[j][i];
      at = ActiveBounds{};
      if (problem.has_rate_limit[i] && j > 0) {
        const double lowest = input[j - 1][i] + stage.lowest_step[i];
        const double highest = input[j - 1][i] + stage.highest_step[i];
        if (u <= lowest) {
          u = lowest;
          at.step = -1;
        } else if (u >= highest) {
          u = highest;
          at.step = 1;
        }
      }
      if (u <= stage.lowest[i]) {
        u = stage.lowest[i];
        at = {-1, 0};
      } else if (u >= stage.highest[i]) {
        u = stage.highest[i];
        at = {1, 0};
      }
    }
  }
}

template <std::size_t Axes>
void MakeIndependent(const QpProblem<Axes>& problem, ActiveSet<Axes>& active) noexcept {
  for (std::size_t i = 0; i < Axes; ++i) {
    active[0][i].step = 0;
    bool anchored = active[0][i].value != 0;
    for (std::size_t j = 1; j < problem.horizon; ++j) {
      ActiveBounds& at = active[j][i];
      if (at.step == 0) {
        anchored = at.value != 0;
      } else if (at.value != 0) {
        if (anchored) at.step = 0;  // begins a run of its own
        anchored = true;
      }
    }
  }
}

#define CONTOUR_INSTANTIATE(Axes)                                                                 \
  template void FoldFirstStep<Axes>(QpProblem<Axes>&) noexcept;                                   \
  template void HoldActive<Axes>(const QpProblem<Axes>&, const ActiveSet<Axes>&,                  \
                                 Riccati<Axes>::Holding&) noexcept;                               \
  template void FindMultipliers<Axes>(const QpProblem<Axes>&, const ActiveSet<Axes>&,             \
                                      const Riccati<Axes>::Inputs&, Multipliers<Axes>&) noexcept; \
  template void ClipForward<Axes>(const QpProblem<Axes>&, Riccati<Axes>::Inputs&,                 \
                                  ActiveSet<Axes>&) noexcept;                                     \
  template void MakeIndependent<Axes>(const QpProblem<Axes>&, ActiveSet<Axes>&) noexcept;
CONTOUR_INSTANTIATE(1)
CONTOUR_INSTANTIATE(2)
CONTOUR_INSTANTIATE(3)
#undef CONTOUR_INSTANTIATE

}  // namespace contour
