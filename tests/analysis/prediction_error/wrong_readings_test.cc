#include "analysis/prediction_error/wrong_readings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace contour::diagnosis {
namespace {

constexpr double kStep = 1e-6;

/// A sine of 1 rad and 2 Hz, read in counts.
AxisLog Sine() {
  AxisLog log;
  for (std::size_t k = 0; k < 3000; ++k) {
    const double q = std::sin(4.0 * std::numbers::pi * 1e-3 * static_cast<double>(k));
    log.position.push_back(std::round(q / kStep) * kStep);
    log.command.push_back(0.0);
    log.present.push_back(1);
  }
  log.rows = log.position.size();
  return log;
}

TEST(TakeOutWrongReadings, ALostFrameGoesAndItsNeighboursStay) {
  AxisLog log = Sine();
  log.position[700] = 0.0;
  log.position[1500] += 0.01;
  TakeOutWrongReadings(log, kStep);
  EXPECT_EQ(log.wrong_readings, 2U);
  for (const std::size_t k : {700U, 1500U}) {
    EXPECT_EQ(log.present[k], 0);
    EXPECT_TRUE(std::isnan(log.position[k]));
    EXPECT_EQ(log.present[k - 1], 1);
    EXPECT_EQ(log.present[k + 1], 1);
  }
}

TEST(TakeOutWrongReadings, AStopAStepAndTheEncodersRoundingAreNone) {
  AxisLog log = Sine();
  for (std::size_t k = 1010; k < 3000; ++k)
    log.position[k] = log.position[1010];  // at full speed into a stop
  TakeOutWrongReadings(log, kStep);
  EXPECT_EQ(log.wrong_readings, 0U);
  for (std::size_t k = 2000; k < 3000; ++k) log.position[k] += 0.1;
  TakeOutWrongReadings(log, kStep);
  EXPECT_EQ(log.wrong_readings, 0U);
}

TEST(TakeOutWrongReadings, RowsThatAreMissingAlreadyStaySo) {
  AxisLog log = Sine();
  log.position[700] = std::nan("");
  log.present[700] = 0;
  TakeOutWrongReadings(log, kStep);
  EXPECT_EQ(log.wrong_readings, 0U);
}

}  // namespace
}  // namespace contour::diagnosis
