#include "estimator/drive_lag.h"

#include <gtest/gtest.h>

namespace contour {
namespace {

TEST(DriveLag, NominalLagSplitsTheCommandEightyToTwenty) {
  DriveLag<1> lag(1e-3, 0.2e-3);
  for (int i = 0; i < 20; ++i) lag.Step(10.0);
  EXPECT_NEAR(lag.Step(20.0)[0], 0.8 * 20.0 + 0.2 * 10.0, 0.02);
}

TEST(DriveLag, MeansMatchAFineIntegration) {
  DriveLag<2> lag(1e-3, 0.3e-3);
  double f = 0.0;
  const int fine = 200000;
  const double h = 1e-3 / fine;
  for (const double u : {5.0, -3.0, 0.0, 8.0}) {
    const auto looked = lag.Look(u);
    const auto means = lag.Step(u);
    EXPECT_EQ(looked, means);
    for (std::size_t part = 0; part < 2; ++part) {
      double sum = 0.0;
      for (int i = 0; i < fine / 2; ++i) {
        const double next = f + h / 0.3e-3 * (u - 0.5 * (f + f + h / 0.3e-3 * (u - f)));
        sum += 0.5 * (f + next);
        f = next;
      }
      EXPECT_NEAR(means[part], sum / (fine / 2), 1e-6);
    }
    EXPECT_NEAR(lag.force_N(), f, 1e-6);
  }
}

TEST(DriveLag, WithoutLagTheCommandActsAtOnce) {
  DriveLag<2> lag(1e-3, 0.0);
  lag.Step(3.0);
  const auto means = lag.Step(7.0);
  EXPECT_EQ(means[0], 7.0);
  EXPECT_EQ(means[1], 7.0);
}

}  // namespace
}  // namespace contour
