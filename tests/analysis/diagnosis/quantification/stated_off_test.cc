#include "analysis/diagnosis/quantification/stated_off.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis {
namespace {

// Before: a torque constant of 2 for an inertia that was stated five times too large, to 5 %.
TEST(StatedOff, NamesWhatNoChanceMovesSoFar) {
  test::HiddenOptions o;
  o.duration_s = 20.0;
  o.parameter_spread = 0.0;
  const test::LearntProblem made(test::MakeHiddenAxis(o));
  Diagnosis out;
  TellStatedOff(made.problem, made.point, out);
  EXPECT_TRUE(out.notes.empty()) << out.notes.front();
  Point off = made.point;
  for (std::size_t i = 0; i < made.problem.terms.size(); ++i)
    if (made.problem.terms[i].name == "Fc") off.base[i] = 11.0 * made.problem.terms[i].sigma;
  TellStatedOff(made.problem, off, out);
  ASSERT_EQ(out.notes.size(), 1U);
  EXPECT_NE(out.notes[0].find("Fc "), std::string::npos) << out.notes[0];
  EXPECT_EQ(out.notes[0].find("inertia "), std::string::npos) << out.notes[0];
}

}  // namespace
}  // namespace contour::diagnosis
