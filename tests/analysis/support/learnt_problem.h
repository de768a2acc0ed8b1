#pragma once

#include "analysis/prediction_error/problem.h"
#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis::test {

/// A made axis as diagnosis sees it, with the noise learnt at the stated numbers.
struct LearntProblem {
  explicit LearntProblem(const HiddenAxis& made) : axis(made), problem(axis.log, axis.stated, 1) {
    for (const BaseTerm& t : problem.terms) point.base.push_back(t.start);
    problem.LearnOutliers(point);
    problem.LearnNoise(point);
    problem.LearnSignals(point);
  }

  // The problem looks at this axis.
  LearntProblem(const LearntProblem&) = delete;
  LearntProblem& operator=(const LearntProblem&) = delete;

  HiddenAxis axis;
  Problem problem;
  Point point;
};

}  // namespace contour::diagnosis::test
