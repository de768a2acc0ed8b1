#include "analysis/prediction_error/free_run_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis {
namespace {

test::HiddenOptions Short() {
  test::HiddenOptions o;
  o.duration_s = 20.0;
  o.parameter_spread = 0.0;
  return o;
}

class FreeRunFitTest : public testing::Test {
 protected:
  FreeRunFitTest() {
    freedom_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(made_.problem.terms.size()));
    for (const char* name : {"inertia", "Fc", "s2"}) freedom_(Place(name)) = 0.1;
  }

  Eigen::Index Place(const std::string& name) const {
    for (std::size_t i = 0; i < made_.problem.terms.size(); ++i)
      if (made_.problem.terms[i].name == name) return static_cast<Eigen::Index>(i);
    return -1;
  }

  test::LearntProblem made_{test::MakeHiddenAxis(Short())};
  Eigen::VectorXd freedom_;
};

TEST_F(FreeRunFitTest, LeadsBackToNumbersThatForeseeFreeRuns) {
  Point off = made_.point;
  off.base[static_cast<std::size_t>(Place("Fc"))] = 0.1;
  const auto error = [&](const Point& p) {
    return FreeRunError(made_.problem, made_.problem.Build(p), 1.0, 0, made_.problem.rows());
  };
  const Point fitted = FitFreeRuns(made_.problem, off, freedom_, Parts::kAll);
  EXPECT_LT(std::fabs(fitted.base[static_cast<std::size_t>(Place("Fc"))]), 0.05);
  EXPECT_LT(error(fitted), 0.5 * error(off));
}

TEST_F(FreeRunFitTest, WhatHasNoFreedomStays) {
  Point off = made_.point;
  off.base[static_cast<std::size_t>(Place("Fc"))] = 0.1;
  freedom_(Place("Fc")) = 0.0;
  EXPECT_EQ(
      FitFreeRuns(made_.problem, off, freedom_, Parts::kEven).base[static_cast<std::size_t>(Place("Fc"))],
      0.1);
}

}  // namespace
}  // namespace contour::diagnosis
