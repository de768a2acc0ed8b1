#include "analysis/diagnosis/screening/nominal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "analysis/prediction_error/refit.h"
#include "tests/analysis/support/fitted_axis.h"

namespace contour::diagnosis {
namespace {

TEST(Nominal, NumbersThatAreOffComeBack) {
  test::HiddenAxis axis = test::MakeHiddenAxis(test::FittedAxis::Short({}));
  axis.stated.motor_inertia *= 1.1;  // of which 5 % are one standard deviation
  Problem problem(axis.log, axis.stated, 1);
  const Nominal nominal = FitNominal(problem);
  const auto inertia = std::find_if(problem.terms.begin(), problem.terms.end(),
                                    [](const BaseTerm& t) { return t.name == "inertia"; });
  ASSERT_NE(inertia, problem.terms.end());
  const double x = nominal.fit.point.base[static_cast<std::size_t>(inertia - problem.terms.begin())];
  EXPECT_NEAR(std::exp(x), 1.0 / 1.1, 0.01);
  // White: as much as there are rows that count.
  double counted = 0.0;
  for (std::size_t k = 0; k < problem.rows(); ++k) counted += problem.counted[k];
  EXPECT_NEAR((nominal.fit.cost - nominal.fit.prior) / counted, 1.0, 0.15);
  EXPECT_TRUE(nominal.fit.point.effects.empty());
  EXPECT_GT(nominal.catalogue.size(), 20u);
  EXPECT_EQ(nominal.by_extras, 0.0) << "the model has no extension";
}

TEST(Nominal, TellsWhatTheModelsExtensionsExplain) {
  test::HiddenAxis axis = test::MakeHiddenAxis(test::FittedAxis::Short({{"cogging", 0.3, 12.0, 0.4, 0.0}}));
  axis.stated.extras.cogging = {{0.3 * axis.stated.friction.Fc_plus, 12.0, 0.4}};
  Problem with(axis.log, axis.stated, 1);
  EXPECT_GT(FitNominal(with).by_extras, 500.0);
}

// A delay of that size goes into the exchange of lag for delay first, which then stands for a coupling that
// no axis can have.
TEST(Nominal, ADelayIsNotHeldForACoupling) {
  test::HiddenOptions options = test::FittedAxis::Short({{"input_delay", 0.35}});
  options.duration_s = 20.0;
  const test::HiddenAxis axis = test::MakeHiddenAxis(options);
  Problem problem(axis.log, axis.stated, 1);
  const auto exchange = [&]() -> const BaseTerm& {
    return *std::find_if(problem.terms.begin(), problem.terms.end(),
                         [](const BaseTerm& t) { return t.name == "lag_for_delay"; });
  };
  const double sigma = exchange().sigma;
  const Nominal nominal = FitNominal(problem);
  EXPECT_LT(exchange().sigma, 0.01 * sigma);
  EXPECT_NEAR(nominal.fit.point.base[static_cast<std::size_t>(&exchange() - problem.terms.data())], 0.0,
              0.1 * sigma);
}

}  // namespace
}  // namespace contour::diagnosis
