#include "analysis/recording/axis_log.h"

#include <gtest/gtest.h>

namespace contour::diagnosis {
namespace {

TEST(Beginnings, AfterMoreThanTenMillisecondsAndThreeRows) {
  AxisLog log;
  log.present.assign(100, 1);
  for (std::size_t k = 20; k < 30; ++k) log.present[k] = 0;  // 10 ms: goes on
  for (std::size_t k = 40; k < 51; ++k) log.present[k] = 0;
  EXPECT_EQ(Beginnings(log), (std::vector<std::size_t>{0, 51}));
  log.period_s = 0.02;
  EXPECT_EQ(Beginnings(log), (std::vector<std::size_t>{0, 30, 51}));
  EXPECT_FALSE(IsGap(3, 0.02));
}

}  // namespace
}  // namespace contour::diagnosis
