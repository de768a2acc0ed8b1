#include "analysis/diagnosis/decision/own_noise.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "analysis/prediction_error/refit.h"
#include "tests/analysis/diagnosis/decision/unknown_torque.h"

namespace contour::diagnosis {
namespace {

class OwnNoiseTest : public test::UnknownTorque {};

TEST_F(OwnNoiseTest, TheLikelierOneComesToTheFrontWhateverTheNoiseOfTheBaseSays) {
  Hypothesis boasting = Of("friction_drift");
  const Hypothesis there = Of("constant_torque");
  boasting.score = 1.02 * there.score;
  std::vector<Hypothesis> hypotheses = {boasting, there};
  LearnNoiseOfLikeliest(axis_.made.problem, hypotheses);
  EXPECT_EQ(hypotheses[0].effect().kind, "constant_torque");
  EXPECT_EQ(hypotheses.size(), 2U);
  // A wrong one does not even move the noise.
  const double right = CostAt(axis_.problem, hypotheses[0].fit.point);
  EXPECT_LT(right, CostAt(axis_.problem, boasting.fit.point));
}

TEST_F(OwnNoiseTest, OneFarAheadOfTheOthersStaysInFront) {
  Hypothesis ahead = Of("friction_drift");
  const Hypothesis likelier = Of("constant_torque");
  ahead.score = 10.0 * likelier.score;
  std::vector<Hypothesis> hypotheses = {ahead, likelier};
  LearnNoiseOfLikeliest(axis_.made.problem, hypotheses);
  EXPECT_EQ(hypotheses[0].effect().kind, "friction_drift");
}

TEST_F(OwnNoiseTest, LikelihoodsCompareWithTheNoiseThatEachLeaves) {
  const Hypothesis there = Of("constant_torque");
  const auto unlikely = [&](const Point& point) {
    axis_.made.problem.LearnNoise(point);
    return CostAt(axis_.problem, point) + axis_.problem.LogNoise();
  };
  EXPECT_LT(unlikely(there.fit.point), unlikely(axis_.base.point) - 100.0);
}

}  // namespace
}  // namespace contour::diagnosis
