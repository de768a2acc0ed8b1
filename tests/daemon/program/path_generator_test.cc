#include "daemon/program/path_generator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/daemon/program/on_a_table.h"

namespace contour {
namespace {

using testing::Point;
using testing::TableLimits;
using testing::Yaml;

TEST(PathGenerator, HandsOutOnePointPerPeriodAndFlagsTheLast) {
  PathGenerator generator(Yaml("shape: circle\nradius_mm: 1\nfrequency_hz: 1.3\nturns: 2\n"),
                          Point(0.01, 0.02), TableLimits(), 0.001, 7);
  PathPoint point;
  std::uint64_t count = 0;
  PerAxis<ReferencePoint> expected;
  while (generator.Next(point)) {
    EXPECT_EQ(point.program_id, 7u);
    EXPECT_EQ(point.last, count + 1 == generator.points());
    generator.plan()->At(static_cast<double>(count) * 0.001, expected);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(point.axes[i].position_m, expected[i].position_m);
    ++count;
  }
  EXPECT_EQ(count, generator.points());
  EXPECT_EQ(generator.points_done(), count);
  EXPECT_GE(static_cast<double>(count - 1) * 0.001, generator.duration_s() - 1e-9);
  EXPECT_LT(static_cast<double>(count - 2) * 0.001, generator.duration_s());
  EXPECT_FALSE(generator.Next(point));
  EXPECT_NEAR(point.axes[0].position_m, 0.01, 1e-15);
  EXPECT_NEAR(point.axes[1].velocity_m_s, 0.0, 1e-15);
}

TEST(PathGenerator, WholeNumberOfPeriodsGetsNoExtraPoint) {
  PathGenerator generator(Yaml("shape: hold\nseconds: 0.3\n"), Point(0, 0), TableLimits(), 0.001, 1);
  EXPECT_EQ(generator.points(), 301u);
}

TEST(PathGenerator, LongProgramsStartAtOnce) {
  PathGenerator generator(Yaml("shape: circle\nradius_mm: 0.1\nfrequency_hz: 0.125\nturns: 1000000\n"),
                          Point(0, 0), TableLimits(), 0.001, 1);
  EXPECT_GT(generator.points(), 7'999'999'999u);
  PathPoint point;
  ASSERT_TRUE(generator.Next(point));
  EXPECT_FALSE(point.last);
}

}  // namespace
}  // namespace contour
