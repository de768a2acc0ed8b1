#include "analysis/prediction_error/linear_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "analysis/prediction_error/problem.h"
#include "tests/analysis/support/distance.h"
#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

SharedSignal Wave(std::size_t rows, double amplitude) {
  Signal s(rows);
  for (std::size_t k = 0; k < rows; ++k) s[k] = amplitude * std::sin(0.02 * static_cast<double>(k));
  return std::make_shared<const Signal>(std::move(s));
}

struct Made {
  explicit Made(bool two) : axis(test::MakeHiddenAxis(Options(two))), problem(axis.log, axis.stated, 1) {}
  static test::HiddenOptions Options(bool two) {
    test::HiddenOptions o;
    o.duration_s = 8.0;
    o.two_inertia = two;
    return o;
  }
  test::HiddenAxis axis;
  Problem problem;
};

std::vector<double> Innovation(const Problem& problem, const AxisModel& m) {
  return RunFilter(problem.setup, std::span(&m, 1), 1)[0].innovation;
}

TEST(LinearModel, TheRunItselfIsThatOfTheFilter) {
  const Made made(false);
  const LinearModel linear = Linearise(made.problem.setup, made.problem.nominal);
  EXPECT_EQ(linear.states, 4);
  EXPECT_EQ(linear.rows, made.problem.rows());
  const std::vector<double> run = Innovation(made.problem, made.problem.nominal);
  EXPECT_LT(test::Distance(linear.innovation, run),
            1e-9 * test::Distance(run, std::vector<double>(run.size(), 0.0)));
}

// A small force, level or reading does what the difference of two runs says.
TEST(LinearModel, SmallSignalsDoWhatDifferencesOfRunsSay) {
  for (const bool two : {false, true}) {
    const Made made(two);
    const AxisModel& without = made.problem.nominal;
    const std::size_t rows = made.problem.rows();
    const LinearModel linear = Linearise(made.problem.setup, without);
    std::vector<std::pair<SharedSignal AxisModel::*, double>> signals = {
        {&AxisModel::motor_force, 1e-4 * without.friction.Fc_plus},
        {&AxisModel::level, 1e-4},
        {&AxisModel::reading_error, 1e-8}};
    if (two) signals.emplace_back(&AxisModel::load_force, 1e-4 * without.friction.Fc_plus);
    for (std::size_t i = 0; i < signals.size(); ++i) {
      AxisModel with = without;
      with.*signals[i].first = Wave(rows, signals[i].second);
      LinearInput input;
      SharedSignal scale;
      ASSERT_TRUE(SignalsOnly(linear, without, with, 1.0, input, scale));
      const std::vector<double> column = LinearColumns(linear, std::span(&input, 1), false)[0].innovation;
      std::vector<double> difference = Innovation(made.problem, with);
      const std::vector<double> run = Innovation(made.problem, without);
      for (std::size_t k = 0; k < rows; ++k) difference[k] -= run[k];
      EXPECT_LT(test::Distance(column, difference),
                0.1 * test::Distance(difference, std::vector<double>(rows, 0.0)))
          << "two " << two << ", signal " << i;
    }
  }
}

TEST(LinearModel, ColumnsAreProportionalToTheirSignals) {
  const Made made(false);
  const LinearModel linear = Linearise(made.problem.setup, made.problem.nominal);
  LinearInput one, three;
  one.motor_force = Wave(made.problem.rows(), 1.0);
  three.motor_force = Wave(made.problem.rows(), 3.0);
  const LinearInput inputs[] = {one, three};
  const auto columns = LinearColumns(linear, inputs, true);
  ASSERT_EQ(columns[0].table_position.size(), made.problem.rows());
  for (std::size_t k = 0; k < made.problem.rows(); k += 97)
    EXPECT_NEAR(3.0 * columns[0].innovation[k], columns[1].innovation[k],
                1e-9 * std::fabs(columns[1].innovation[k]) + 1e-15);
}

TEST(LinearModel, ADifferenceThatIsMoreThanSignalsIsToldApart) {
  const Made made(false);
  const AxisModel& without = made.problem.nominal;
  const LinearModel linear = Linearise(made.problem.setup, without);
  AxisModel with = without;
  with.friction.Fc_plus *= 1.01;
  LinearInput input;
  SharedSignal scale;
  EXPECT_FALSE(SignalsOnly(linear, without, with, 1.0, input, scale));
  AxisModel scaled = without;
  scaled.scale_error_m = Wave(made.problem.rows(), 2e-6);
  ASSERT_TRUE(SignalsOnly(linear, without, scaled, 0.5, input, scale));
  EXPECT_FALSE(input.motor_force || input.level || input.reading_error);
  EXPECT_DOUBLE_EQ((*scale)[70], 1e-6 * std::sin(1.4));
}

TEST(LinearModel, MoreViscousFrictionIsAForceAgainstTheMotion) {
  const Made made(false);
  const LinearModel linear = Linearise(made.problem.setup, made.problem.nominal);
  AxisModel with = made.problem.nominal;
  with.viscous = Wave(made.problem.rows(), 0.1);
  LinearInput input;
  SharedSignal scale;
  ASSERT_TRUE(SignalsOnly(linear, made.problem.nominal, with, 1.0, input, scale));
  ASSERT_TRUE(input.motor_force);
  EXPECT_NEAR((*input.motor_force)[500], -linear.viscous * linear.velocity[500] * 0.1 * std::sin(10.0),
              1e-15);
}

}  // namespace
}  // namespace contour::diagnosis
