#include "analysis/diagnosis/quantification/model_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis {
namespace {

TEST(ModelErrors, AreOfTheHalfThatHasNotSeenThem) {
  test::HiddenOptions o;
  o.duration_s = 20.0;
  o.parameter_spread = 0.0;
  test::LearntProblem made(test::MakeHiddenAxis(o));
  Point bad = made.point;
  for (std::size_t i = 0; i < made.problem.terms.size(); ++i)
    if (made.problem.terms[i].name == "Fc") bad.base[i] += std::log(1.2);
  const Forecast forecasts[] = {{"stated", made.point, {}}, {"refitted", made.point, {{bad, bad}}}};
  const std::vector<ForecastError> both = ErrorsOf(made.problem, forecasts);
  ASSERT_EQ(both.size(), 2U);
  const ForecastError& errors = both[1];
  EXPECT_EQ(errors.model, "refitted");
  EXPECT_GT(errors.free_run_used, 0.0);
  EXPECT_GT(errors.free_run_unseen, 2.0 * errors.free_run_used);
  EXPECT_GT(errors.one_step_unseen, errors.one_step_used);
  // What was not fitted is the same model everywhere.
  EXPECT_EQ(both[0].model, "stated");
  EXPECT_EQ(both[0].one_step_unseen, both[0].one_step_used);
  EXPECT_EQ(both[0].free_run_unseen, both[0].free_run_used);
  EXPECT_EQ(both[0].one_step_used, errors.one_step_used);
}

TEST(ModelErrors, SayWhatTheFileHasNoPlaceFor) {
  const test::LearntProblem made(test::HiddenAxisFor(5.0));
  Diagnosis d;
  d.model_errors = {{.model = "stated"}, {.model = "extended"}};
  d.causes.resize(2);
  d.causes[0].kind = "cogging";
  d.causes[1].kind = "constant_torque";
  const auto told = [&] {
    d.notes.clear();
    TellModelErrors(made.problem, d);
    return d.notes;
  };
  EXPECT_EQ(told().size(), 1U);
  d.causes[1].kind = "torque_saturation";
  ASSERT_EQ(told().size(), 2U);
  EXPECT_NE(told().back().find("No model file has a place for torque_saturation:"), std::string::npos);
}

}  // namespace
}  // namespace contour::diagnosis
