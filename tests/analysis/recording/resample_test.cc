#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "analysis/recording/read_log.h"
#include "tests/config/test_files.h"

namespace contour::diagnosis {
namespace {

TEST(Resample, RowsFollowACurveAndKeepTheImpulse) {
  // Steps of 10 and 12 ms, as a robot's recorder has them.
  std::string text = "time_s,torque_Nm,position_rad\n";
  double t = 0.0, impulse = 0.0;
  for (int i = 0; i < 300; ++i) {
    const double step = i % 3 == 0 ? 12e-3 : 10e-3, u = std::sin(3.0 * t);
    text += std::to_string(t) + "," + std::to_string(u) + "," + std::to_string(std::sin(2.0 * t)) + "\n";
    impulse += i + 1 < 300 ? u * step : 0.0;
    t += step;
  }
  const AxisLog log = ReadLog(WriteTestFile("log.csv", text), {.resample_Hz = 94.0});
  EXPECT_DOUBLE_EQ(log.period_s, 1.0 / 94.0);
  EXPECT_NE(log.note.find("94"), std::string::npos);
  double kept = 0.0;
  for (std::size_t k = 0; k < log.size(); ++k) {
    EXPECT_NEAR(log.position[k], std::sin(2.0 * static_cast<double>(k) / 94.0), 5e-6);
    kept += log.command[k] / 94.0;
  }
  EXPECT_NEAR(kept, impulse, 0.012);
}

TEST(Resample, AGapStaysOne) {
  std::string text = "time_s,torque_Nm,position_rad\n";
  for (int i = 0; i < 200; ++i) text += std::to_string(i < 100 ? 0.01 * i : 5.003 + 0.01 * i) + ",1,2\n";
  const AxisLog log = ReadLog(WriteTestFile("log.csv", text), {.resample_Hz = 50.0});
  EXPECT_EQ(Beginnings(log).size(), 2U);
  EXPECT_NEAR(static_cast<double>(log.size()) * log.period_s, 6.99, 0.05);
}

}  // namespace
}  // namespace contour::diagnosis
