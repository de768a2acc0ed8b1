#include "estimator/torque_in_period.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;

/// A drive whose own loops raise the torque evenly while an offset is sent in steps, integrated finely.
TEST(TorqueInPeriod, IsTheMeanOfWhatActedWhateverTheLag) {
  for (const double lag_s : {0.05e-3, 0.2e-3, 0.8e-3}) {
    TorqueInPeriod torque(kPeriod_s, lag_s);
    constexpr int kSteps = 10000;
    double offset_N = 0.0, own_N = 0.0, before_N = 0.0, worst_N = 0.0, worst_of_ends_N = 0.0;
    for (const double sent_N : std::array{8.0, 16.0, 24.0, 20.0, 0.0, -30.0}) {
      double sum_N = 0.0;
      for (int i = 0; i < kSteps; ++i) {
        const double step_s = kPeriod_s / kSteps;
        const double kept = std::exp(-step_s / lag_s);
        sum_N += own_N + offset_N;
        offset_N = sent_N + kept * (offset_N - sent_N);
        own_N += 5.0 / kSteps;
      }
      const double now_N = own_N + offset_N, mean_N = sum_N / kSteps;
      worst_N = std::max(worst_N, std::abs(torque.Mean_N(before_N, now_N, sent_N) - mean_N));
      worst_of_ends_N = std::max(worst_of_ends_N, std::abs(0.5 * (before_N + now_N) - mean_N));
      before_N = now_N;
    }
    EXPECT_LT(worst_N, 0.01) << lag_s;
    EXPECT_GT(worst_of_ends_N, 1.0) << lag_s;
  }
}

TEST(TorqueInPeriod, WithoutAnOffsetIsTheMeanOfTheEnds) {
  TorqueInPeriod torque(kPeriod_s, 0.2e-3);
  EXPECT_EQ(torque.Mean_N(3.0, 5.0, 0.0), 4.0);
}

}  // namespace
}  // namespace contour
