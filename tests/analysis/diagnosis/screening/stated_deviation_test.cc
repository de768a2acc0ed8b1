#include "analysis/diagnosis/screening/stated_deviation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>

#include "analysis/diagnosis/screening/score.h"
#include "tests/analysis/support/fitted_axis.h"

namespace contour::diagnosis {
namespace {

class StatedDeviationTest : public testing::Test {
 protected:
  /// The fit with the kind's numbers freed, and these amplitudes with the base's own terms at what is stated.
  Fit At(const std::string& kind, std::vector<double> amplitudes) const {
    Fit fit = axis_.With(axis_.Of(kind));
    for (const std::size_t term : FreedTerms(axis_.problem, kind)) fit.point.base[term] = 0.0;
    fit.point.amplitudes.back() = std::move(amplitudes);
    return fit;
  }
  double SigmaOf(const std::string& kind, std::size_t i) const {
    return axis_.problem.terms[FreedTerms(axis_.problem, kind)[i]].sigma;
  }

  test::FittedAxis axis_;
};

TEST_F(StatedDeviationTest, OfAnAxisThatIsAsStatedIsChance) {
  for (const char* kind : {"current_lag", "input_delay", "stribeck"})
    EXPECT_LT(StatedDeviation(axis_.problem, axis_.With(axis_.Of(kind))), 12.4) << kind;
}

TEST_F(StatedDeviationTest, GrowsWithTheSquareAndIsBelowThatOfAKnownNumber) {
  const double sigma = SigmaOf("current_lag", 0);
  const double once = StatedDeviation(axis_.problem, At("current_lag", {5.0 * sigma}));
  EXPECT_GT(once, 0.0);
  EXPECT_LT(once, 25.0) << "25, did the log say all of it";
  EXPECT_NEAR(StatedDeviation(axis_.problem, At("current_lag", {10.0 * sigma})), 4.0 * once, 1e-6 * once);
}

TEST_F(StatedDeviationTest, HalfOfWhatIsStatedIsAsFarAsHalfMoreInTheLogarithm) {
  const double half = StatedDeviation(axis_.problem, At("stribeck", {0.0, std::log(0.5)}));
  EXPECT_GT(half, 0.0);
  EXPECT_NEAR(StatedDeviation(axis_.problem, At("stribeck", {0.0, 0.5})), half, 1e-6 * half);
}

TEST_F(StatedDeviationTest, IsOfBaseAndAmplitudeTogether) {
  const double sigma = SigmaOf("input_delay", 0);
  Fit fit = At("input_delay", {8.0 * sigma});
  const double alone = StatedDeviation(axis_.problem, fit);
  fit.point.base[FreedTerms(axis_.problem, "input_delay")[0]] = -8.0 * sigma;
  EXPECT_NEAR(StatedDeviation(axis_.problem, fit), 0.0, 1e-9 * alone);
}

TEST_F(StatedDeviationTest, AResidualThatScattersLeavesLess) {
  Fit fit = At("current_lag", {5.0 * SigmaOf("current_lag", 0)});
  const double before = StatedDeviation(axis_.problem, fit);
  // Now the one way, now the other, for ten blocks each.
  const std::size_t together = 10 * fit.residual.size() / static_cast<std::size_t>(kBlocks);
  const Eigen::VectorXd column = fit.jacobian.rightCols(1);
  const double size = 10.0 / std::sqrt(column.squaredNorm());
  for (std::size_t k = 0; k < fit.residual.size(); ++k)
    fit.residual[k] += (k / together % 2 == 0 ? size : -size) * column(static_cast<Eigen::Index>(k)) *
                       std::sqrt(static_cast<double>(kBlocks));
  EXPECT_LT(StatedDeviation(axis_.problem, fit), 0.9 * before);
}

}  // namespace
}  // namespace contour::diagnosis
