#include "analysis/rough_fit/likelier.h"

#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "analysis/rough_fit/two_starts.h"
#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

test::HiddenAxis Pulled(double duration_s) {
  test::HiddenOptions o;
  o.duration_s = duration_s;
  o.scale = false;
  o.parameter_spread = 0.0;
  test::HiddenAxis axis = MakeHiddenAxis(o);
  const double weight = 0.2 * axis.stated.friction.Fc_plus;
  for (double& u : axis.log.command) u += weight;
  return axis;
}

/// A fit at the stated numbers, with a noise of its own.
struct Settled {
  Settled(const AxisLog& log, const StatedAxis& axis) : stated(axis), problem(log, stated, 1) {
    Point here;
    for (const BaseTerm& t : problem.terms) here.base.push_back(t.start);
    problem.LearnNoise(here);
    raw = problem.Raw(std::span(&here, 1)).front();
  }
  StatedAxis stated;
  Problem problem;
  std::vector<double> raw;
};

TEST(FirstIsBetterBy, TellsTheModelOfTheLogFromOneThatLacksItsForce) {
  const test::HiddenAxis axis = Pulled(10.0);
  StatedAxis with = axis.stated;
  with.offset = -0.2 * with.friction.Fc_plus;
  Settled right(axis.log, with), wrong(axis.log, axis.stated);
  const std::vector<double> before = right.problem.root_weight;
  const double by = FirstIsBetterBy({right.problem, right.raw}, {wrong.problem, wrong.raw});
  EXPECT_GT(by, kDisagree);
  EXPECT_EQ(FirstIsBetterBy({wrong.problem, wrong.raw}, {right.problem, right.raw}), -by);
  EXPECT_EQ(right.problem.root_weight, before) << "each keeps its noise";
}

TEST(FirstIsBetterBy, IsNothingForTheSameModelTwice) {
  const test::HiddenAxis axis = Pulled(5.0);
  Settled one(axis.log, axis.stated), same(axis.log, axis.stated);
  EXPECT_EQ(FirstIsBetterBy({one.problem, one.raw}, {same.problem, same.raw}), 0.0);
}

}  // namespace
}  // namespace contour::diagnosis
