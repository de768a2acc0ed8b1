#include "analysis/diagnosis/decision/gross_causes.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/analysis/support/fitted_axis.h"

namespace contour::diagnosis {
namespace {

/// What is proposed where an axis has an effect of some size.
struct Proposed {
  Proposed(const std::string& hidden, double size, const std::vector<std::string>& kinds)
      : axis({{hidden, size, 0.0, 0.0, 0.0}}) {
    std::vector<SharedEffect> effects;
    for (const std::string& kind : kinds) effects.push_back(axis.Of(kind));
    scored = ScoreEffects(axis.problem, axis.base, effects);
    guesses = FromLeastSquares(axis.problem, axis.base, scored);
  }

  test::FittedAxis axis;
  std::vector<Scored> scored;
  std::vector<InitialGuess> guesses;
};

// Before: the base that was fitted without the weight of an axis had three times its friction, and the weight
// came third, with a quarter of its size.
TEST(FromLeastSquares, BeginsWhereAWeightOfManyTimesTheFrictionLies) {
  const Proposed heavy("constant_torque", 3.0, {"constant_torque", "payload_step"});
  ASSERT_FALSE(heavy.guesses.empty());
  EXPECT_EQ(heavy.guesses[0].point.effects.back()->kind, "constant_torque");
  const double weight_Nm = 3.0 * heavy.axis.problem.nominal.friction.Fc_plus;
  const Fit fit = FitPoint(heavy.axis.problem, heavy.guesses[0].point);
  EXPECT_NEAR(fit.point.amplitudes.back()[0], weight_Nm, 0.05 * weight_Nm);
}

TEST(FromLeastSquares, LeavesWhatIsSmallToTheScoreTest) {
  const Proposed sound("constant_torque", 0.0, {"constant_torque", "asymmetric_coulomb", "payload_step"});
  EXPECT_TRUE(sound.guesses.empty());
}

}  // namespace
}  // namespace contour::diagnosis
