#include "analysis/prediction_error/wave_signals.h"

#include <gtest/gtest.h>

#include <cmath>

namespace contour::diagnosis {
namespace {

TEST(Doubled, TheSecondHalfIsTheNextRowsValue) {
  EXPECT_EQ(Doubled({1.0, 4.0, 9.0}), (Signal{1.0, 4.0, 9.0, 4.0, 9.0, 9.0}));
}

TEST(WaveSignals, ASlowWaveIsItsValueAtTheRows) {
  std::vector<double> phase;
  for (int k = 0; k < 50; ++k) phase.push_back(0.3 + 1e-3 * k);
  const auto waves = WaveSignals(phase, {});
  ASSERT_EQ(waves.size(), 2U);
  for (std::size_t k = 0; k + 1 < phase.size(); ++k) {
    EXPECT_NEAR((*waves[0])[k], std::sin(phase[k]), 1e-6);
    EXPECT_NEAR((*waves[0])[phase.size() + k], std::sin(phase[k + 1]), 1e-6);
    EXPECT_NEAR((*waves[1])[k], std::cos(phase[k]), 1e-6);
  }
}

// The best straight line over a row has the wave's own mean and first moment there, by a sum over the row.
TEST(WaveSignals, AFastWaveIsTheBestStraightLineOverEachRow) {
  const std::vector<double> phase = {0.4, 2.9, 3.1, 3.1};
  const auto waves = WaveSignals(phase, {});
  for (std::size_t k = 0; k + 1 < phase.size(); ++k) {
    const double from = (*waves[0])[k], to = (*waves[0])[phase.size() + k];
    double mean = 0.0, moment = 0.0;
    constexpr int kParts = 20000;
    for (int i = 0; i < kParts; ++i) {
      const double x = 2.0 * (i + 0.5) / kParts - 1.0;
      const double s = std::sin(0.5 * (phase[k] + phase[k + 1]) + 0.5 * (phase[k + 1] - phase[k]) * x);
      mean += s / kParts;
      moment += 3.0 * s * x / kParts;
    }
    EXPECT_NEAR(0.5 * (from + to), mean, 1e-7) << k;
    EXPECT_NEAR(0.5 * (to - from), moment, 1e-7) << k;
  }
}

TEST(WaveSignals, BothFormulasMeetWhereTheyChange) {
  const auto slow = WaveSignals({1.0, 1.0 + 2.0 * 0.99999e-2}, {}),
             fast = WaveSignals({1.0, 1.0 + 2.0 * 1.00001e-2}, {});
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR((*slow[i])[0], (*fast[i])[0], 1e-6);
}

TEST(WaveSignals, TheSizeIsTheMeanOfTheRow) {
  const auto waves = WaveSignals({0.5, 0.5, 0.5}, {2.0, 4.0, 4.0});
  EXPECT_NEAR((*waves[0])[0], 3.0 * std::sin(0.5), 1e-12);
  EXPECT_NEAR((*waves[1])[1], 4.0 * std::cos(0.5), 1e-12);
}

}  // namespace
}  // namespace contour::diagnosis
