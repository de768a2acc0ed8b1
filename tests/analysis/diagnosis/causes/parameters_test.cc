// Intervals of what a fit says, from its covariance.

#include "analysis/diagnosis/causes/parameters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/waves.h"
#include "analysis/prediction_error/fit.h"
#include "tests/analysis/support/cause_checks.h"
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

/// One effect in addition to the base of an axis whose signals are known.
struct Known {
  Fit FitOf(const SharedEffect& effect, const std::vector<double>& at, double sigma) const {
    Fit fit;
    fit.point.base.assign(axis.problem.terms.size(), 0.0);
    fit.point.effects = {effect};
    fit.point.amplitudes = {at};
    const auto n = static_cast<Eigen::Index>(ParameterCount(fit.point)),
               m = static_cast<Eigen::Index>(at.size());
    fit.covariance = Eigen::MatrixXd::Zero(n, n);
    fit.covariance.bottomRightCorner(m, m).diagonal().setConstant(sigma * sigma);
    return fit;
  }

  /// From draws of its two amplitudes.
  Cause Described(const SharedEffect& effect, const std::vector<double>& at,
                  const Eigen::MatrixXd& drawn) const {
    const Fit fit = FitOf(effect, at, 0.0);
    Eigen::MatrixXd draws =
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(ParameterCount(fit.point)), drawn.cols());
    draws.bottomRows(drawn.rows()) = drawn;
    Cause cause;
    DescribeEffect(axis.problem, fit, 0, draws, cause);
    return cause;
  }

  test::KnownAxis axis;
};

// The root of a sum of squares is only ever drawn larger: as far as it is, it was found too large.
TEST(Parameters, AnAmplitudeIsTurnedOverAboutItsValue) {
  const Known known;
  Eigen::MatrixXd draws(2, 100);
  for (Eigen::Index d = 0; d < 100; ++d) draws.col(d) << 0.0, d % 2 == 0 ? 0.75 : 0.0;
  const Interval found =
      known.Described(WaveEffect(known.axis.problem, Wave::kTorqueOfAngle, 12.0, 1.0), {1.0, 0.0}, draws)
          .parameters.at("amplitude_Nm");
  EXPECT_EQ(found.value, 1.0);
  EXPECT_NEAR(found.low, 0.75, 1e-12);  // drawn at 1.25
  EXPECT_NEAR(found.high, 1.0, 1e-12);
}

TEST(Parameters, APhaseNearHalfATurnIsNotToldAsAWholeOne) {
  const Known known;
  Eigen::MatrixXd draws(2, 100);
  for (Eigen::Index d = 0; d < 100; ++d) draws.col(d) << 0.0, d % 2 == 0 ? 0.02 : -0.02;
  const Interval phase =
      known.Described(WaveEffect(known.axis.problem, Wave::kTorqueOfAngle, 12.0, 1.0), {-1.0, 1e-6}, draws)
          .parameters.at("phase_rad");
  EXPECT_NEAR(phase.value, std::numbers::pi, 1e-5);
  EXPECT_NEAR(phase.high - phase.low, 0.04, 1e-3);
}

TEST(Parameters, AShapeIsToldOverTheTablesPositionsInItsUnit) {
  const Known known;
  const SharedEffect effect = test::OnGrid(known.axis, "pitch_error", "");
  std::vector<double> at(effect->steps.size(), 0.0);
  at[0] = 2e-6;
  Cause cause;
  cause.kind = "pitch_error";
  DescribeEffect(known.axis.problem, known.FitOf(effect, at, 1e-7), 0, cause);
  ASSERT_EQ(cause.shapes.size(), 1u);
  const ShapeTable& table = cause.shapes[0];
  EXPECT_EQ(table.ordinate, "error_um");
  EXPECT_NEAR(table.x.front(), -30.0, 1e-9) << "the middle of the stroke is at 20 mm";
  EXPECT_NEAR(table.x.back(), 70.0, 1e-9);
  EXPECT_NEAR(table.y.front(), 2.0, 1e-9);
  EXPECT_NEAR(table.y.back(), -2.0, 1e-9);
  // At the ends every cosine is one: so many independent amplitudes.
  EXPECT_NEAR(table.sigma.front(), 0.1 * std::sqrt(static_cast<double>(at.size())), 1e-9);
}

}  // namespace
}  // namespace contour::diagnosis
