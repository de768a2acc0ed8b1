#include "analysis/prediction_error/steady_gain.h"

#include <gtest/gtest.h>

#include <cmath>

namespace contour::diagnosis {
namespace {

// A random walk read with noise: p = q / 2 + sqrt(q^2 / 4 + q r), gain p / (p + r).
TEST(SteadyGain, OfARandomWalkIsTheRootOfItsRiccatiEquation) {
  const double q = 0.3, r = 2.0, p = 0.5 * q + std::sqrt(0.25 * q * q + q * r);
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(1, 1);
  EXPECT_NEAR(SteadyGain(one, q * one, r, 100.0 * one)(0), p / (p + r), 1e-11);
}

// The tracker of position and velocity under white acceleration (Kalata's tracking index).
TEST(SteadyGain, OfAPositionAndVelocityTrackerIsThatOfItsTrackingIndex) {
  const double t = 1e-3, index = 0.2, reading = 4.0;
  Eigen::MatrixXd f(2, 2);
  f << 1.0, t, 0.0, 1.0;
  const Eigen::Vector2d b(0.5 * t * t, t);
  const double acceleration = index * std::sqrt(reading) / (t * t);
  const Eigen::MatrixXd q = b * b.transpose() * acceleration * acceleration;
  const Eigen::VectorXd gain = SteadyGain(f, q, reading, 1e4 * Eigen::MatrixXd::Identity(2, 2));
  const double d = (4.0 + index - std::sqrt(8.0 * index + index * index)) / 4.0;
  EXPECT_NEAR(gain(0), 1.0 - d * d, 1e-9);
  EXPECT_NEAR(gain(1) * t, 2.0 * (2.0 - gain(0)) - 4.0 * std::sqrt(1.0 - gain(0)), 1e-9);
}

TEST(SteadyGain, DoesNotDependOnWhereItBegins) {
  Eigen::MatrixXd f(2, 2);
  f << 1.0, 0.1, 0.0, 0.9;
  const Eigen::MatrixXd q = 0.01 * Eigen::MatrixXd::Identity(2, 2);
  const Eigen::VectorXd a = SteadyGain(f, q, 1.0, q), b = SteadyGain(f, q, 1.0, 1e6 * q);
  EXPECT_LT((a - b).norm(), 1e-9 * a.norm());
}

}  // namespace
}  // namespace contour::diagnosis
