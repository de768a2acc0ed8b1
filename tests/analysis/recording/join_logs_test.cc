#include "analysis/recording/read_log.h"

#include <gtest/gtest.h>

#include <cmath>

#include "config/config_error.h"

namespace contour::diagnosis {
namespace {

AxisLog Log(double period_s = 0.1) {
  AxisLog log;
  log.source = "a.csv";
  log.period_s = period_s;
  log.present = {1, 1, 1};
  log.command = {1.0, 3.0, 5.0};
  log.position = {2.0, 4.0, 6.0};
  log.rows = 3;
  return log;
}

TEST(JoinLogs, HalfASecondOfGridPointsWithoutRowsLiesBetween) {
  const AxisLog log = JoinLogs({Log(), Log()});
  EXPECT_EQ(log.rows, 6U);
  ASSERT_EQ(log.size(), 11U);
  EXPECT_EQ(log.present, (std::vector<std::uint8_t>{1, 1, 1, 0, 0, 0, 0, 0, 1, 1, 1}));
  EXPECT_DOUBLE_EQ(log.command[5], 5.0);
  EXPECT_TRUE(std::isnan(log.position[5]));
  EXPECT_DOUBLE_EQ(log.position[8], 2.0);
}

TEST(JoinLogs, AColumnThatNotAllHaveIsLeftOut) {
  AxisLog with = Log();
  with.temperature_degC = {20.0, 20.0, 21.0};
  EXPECT_TRUE(JoinLogs({with, Log()}).temperature_degC.empty());
  EXPECT_TRUE(JoinLogs({Log(), with}).temperature_degC.empty());
  const AxisLog both = JoinLogs({with, with});
  ASSERT_EQ(both.temperature_degC.size(), 11U);
  EXPECT_DOUBLE_EQ(both.temperature_degC[5], 21.0);
}

TEST(JoinLogs, OneLogStaysAsItIs) { EXPECT_EQ(JoinLogs({Log()}).command, Log().command); }

TEST(JoinLogs, LogsOfDifferentKindsAreRefused) {
  AxisLog linear = Log();
  linear.linear = true;
  EXPECT_THROW(JoinLogs({Log(), linear}), ConfigError);
  EXPECT_THROW(JoinLogs({Log(), Log(0.2)}), ConfigError);
  EXPECT_THROW(JoinLogs({}), ConfigError);
}

}  // namespace
}  // namespace contour::diagnosis
