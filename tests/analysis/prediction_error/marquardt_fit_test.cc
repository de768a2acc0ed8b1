#include "analysis/prediction_error/marquardt_fit.h"

#include <gtest/gtest.h>

#include <cmath>

namespace contour::diagnosis {
namespace {

LeastSquares Problem(Eigen::Index parameters, double sigma = 1e6) {
  LeastSquares p;
  p.sigma = Eigen::VectorXd::Constant(parameters, sigma);
  p.step = Eigen::VectorXd::Constant(parameters, 1e-6);
  p.longest = Eigen::VectorXd::Constant(parameters, 1e6);
  return p;
}

/// r = A x - b.
LeastSquares Line(double sigma) {
  LeastSquares p = Problem(2, sigma);
  p.residual = [](const Eigen::VectorXd& x) {
    Eigen::VectorXd r(4);
    for (int i = 0; i < 4; ++i) r(i) = x(0) + i * x(1) - (i == 3 ? 8.0 : 2.0 * i);
    return r;
  };
  return p;
}

TEST(MarquardtFit, ALineIsFittedAsByHand) {
  // Through (0, 0), (1, 2), (2, 4), (3, 8): slope 2.6, intercept -0.4.
  Eigen::VectorXd x = Eigen::VectorXd::Zero(2);
  FitByMarquardt(Line(1e6), {50, 1e-15}, x);
  EXPECT_NEAR(x(0), -0.4, 1e-5);
  EXPECT_NEAR(x(1), 2.6, 1e-5);
}

TEST(MarquardtFit, APriorDrawsTowardsZeroAsItsWeightSays) {
  // (A'A + 1 / sigma^2) x = A'b with A'A = [4 6; 6 14], A'b = [14, 34].
  Eigen::VectorXd x = Eigen::VectorXd::Zero(2);
  FitByMarquardt(Line(0.5), {50, 1e-15}, x);
  Eigen::Matrix2d a;
  a << 8.0, 6.0, 6.0, 18.0;
  const Eigen::Vector2d expected = a.inverse() * Eigen::Vector2d(14.0, 34.0);
  EXPECT_LT((x - expected).norm(), 1e-5);
}

TEST(MarquardtFit, GoesRoundTheValleyOfRosenbrock) {
  LeastSquares p = Problem(2);
  p.residual = [](const Eigen::VectorXd& x) {
    return Eigen::Vector2d(10.0 * (x(1) - x(0) * x(0)), 1.0 - x(0));
  };
  Eigen::VectorXd x(2);
  x << -1.2, 1.0;
  FitByMarquardt(p, {200, 1e-12}, x);
  EXPECT_LT((x - Eigen::Vector2d(1.0, 1.0)).norm(), 1e-3);
}

TEST(MarquardtFit, NoStepIsLongerThanAllowed) {
  LeastSquares p = Problem(1);
  p.longest(0) = 0.25;
  p.residual = [](const Eigen::VectorXd& x) { return Eigen::VectorXd::Constant(1, x(0) - 10.0); };
  Eigen::VectorXd x = Eigen::VectorXd::Zero(1);
  FitByMarquardt(p, {4, 0.0}, x);
  EXPECT_NEAR(x(0), 1.0, 1e-6);
}

TEST(MarquardtFit, WhereNothingIsBetterItStays) {
  LeastSquares p = Problem(1);
  p.residual = [](const Eigen::VectorXd& x) {
    return Eigen::VectorXd::Constant(1, x(0) == 3.0 ? 1.0 : std::nan(""));
  };
  Eigen::VectorXd x = Eigen::VectorXd::Constant(1, 3.0);
  FitByMarquardt(p, {5, 0.0}, x);
  EXPECT_EQ(x(0), 3.0);
}

TEST(MarquardtFit, ThreadsDoNotChangeTheJacobian) {
  LeastSquares p = Line(1.0);
  const Eigen::Vector2d x(0.3, 0.7);
  const Eigen::MatrixXd one = p.Jacobian(x, p.residual(x));
  p.threads = 3;
  EXPECT_EQ(one, p.Jacobian(x, p.residual(x)));
  EXPECT_NEAR(one(3, 1), 3.0, 1e-8);
  EXPECT_NEAR(p.Normal(one)(0, 0), 4.0 + 1.0, 1e-7);
}

}  // namespace
}  // namespace contour::diagnosis
