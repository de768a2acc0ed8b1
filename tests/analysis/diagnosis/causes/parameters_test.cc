// Intervals of what a fit says, from its covariance.

#include "analysis/diagnosis/causes/parameters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/prediction_error/fit.h"
#include "tests/analysis/support/hidden_axis.h"
#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis {
namespace {

class OfAFit : public testing::Test {
 protected:
  OfAFit() : learnt_(Made()) {}

  static test::HiddenAxis Made() {
    test::HiddenOptions o;
    o.seed = 3;
    o.duration_s = 10.0;
    o.scale = o.temperature = o.axis2 = false;
    return test::MakeHiddenAxis(o);
  }

  /// An effect at these amplitudes, each with its standard deviation, the base known exactly.
  Cause Described(const std::string& kind, const std::vector<double>& at, const std::vector<double>& sigma) {
    Fit fit;
    fit.point = learnt_.point;
    for (const SharedEffect& e : CatalogueEffects(learnt_.problem))
      if (e->kind == kind && e->steps.size() == at.size() && fit.point.effects.empty())
        fit.point.effects = {e};
    fit.point.amplitudes = {at};
    const auto n = static_cast<Eigen::Index>(ParameterCount(fit.point));
    const auto base = static_cast<Eigen::Index>(fit.point.base.size());
    fit.covariance = Eigen::MatrixXd::Zero(n, n);
    for (std::size_t i = 0; i < sigma.size(); ++i)
      fit.covariance(base + static_cast<Eigen::Index>(i), base + static_cast<Eigen::Index>(i)) =
          sigma[i] * sigma[i];
    Cause cause;
    cause.kind = kind;
    DescribeEffect(learnt_.problem, fit, 0, cause);
    return cause;
  }

  test::LearntProblem learnt_;
};

// The fit has its logarithm: as far up as down there, and farther up in rad/s.
TEST_F(OfAFit, AStribeckSpeedIsAsFarOffUpwardsAsDownwardsByItsFactor) {
  const Interval vs = Described("stribeck", {0.1, 0.0}, {0.05, 0.2}).parameters.at("vs_rad_s");
  // Of 400 draws, the tail is known to some 8 % of its distance.
  EXPECT_NEAR(std::log(vs.high / vs.value), 1.96 * 0.2, 0.06);
  EXPECT_NEAR(std::log(vs.value / vs.low), 1.96 * 0.2, 0.06);
}

TEST_F(OfAFit, ATorqueIsAsFarOffUpwardsAsDownwards) {
  const Interval torque = Described("constant_torque", {0.01}, {0.001}).parameters.at("torque_Nm");
  EXPECT_NEAR(torque.high - torque.value, 1.96e-3, 3e-4);
  EXPECT_NEAR(torque.value - torque.low, 1.96e-3, 3e-4);
}

}  // namespace
}  // namespace contour::diagnosis
