#include "analysis/diagnosis/decision/instants.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/fitted_axis.h"

namespace contour::diagnosis {
namespace {

class InstantsTest : public testing::Test {
 protected:
  /// The kind at a place of its grid, with these amplitudes.
  Hypothesis At(const std::string& kind, std::size_t row, std::vector<double> amplitudes) const {
    Hypothesis r;
    r.fit.point = axis_.base.point;
    for (const SharedEffect& e : CatalogueEffects(axis_.problem))
      if (e->kind == kind && (row == 0 || e->from_row == row)) r.fit.point.effects = {e};
    r.fit.point.amplitudes = {std::move(amplitudes)};
    r.fit.cost = 0.0;
    return r;
  }

  [[nodiscard]] double Truth_s() const {
    return 0.48 * axis_.problem.log.period_s * static_cast<double>(axis_.problem.rows());
  }

  test::FittedAxis axis_{{{"payload_step", 0.2, 0.0, 0.0, 0.48}}};
};

// Before: 15.02 s (15 to 15.04) for 14.
TEST_F(InstantsTest, AMassIsTakenUpWhenTheLogSaysSo) {
  const std::vector<Hypothesis> late = {At("payload_step", axis_.problem.rows() / 2, {0.2, 0.0})};
  const std::vector<InitialGuess> guesses = OtherInstants(axis_.problem, axis_.base, late);
  ASSERT_EQ(guesses.size(), 1U);
  const Point& p = guesses[0].point;
  // The axis stands or glides in between: no nearer than that.
  const double began_s = p.effects.back()->order, found_s = began_s + p.amplitudes.back()[1];
  EXPECT_LT(std::fabs(found_s - Truth_s()), 0.5 * std::fabs(began_s - Truth_s()));
}

TEST_F(InstantsTest, OnlyWhatBeginsAtAnInstantIsLookedThrough) {
  const std::vector<Hypothesis> other = {At("constant_torque", 0, {0.01})};
  EXPECT_TRUE(OtherInstants(axis_.problem, axis_.base, other).empty());
}

}  // namespace
}  // namespace contour::diagnosis
