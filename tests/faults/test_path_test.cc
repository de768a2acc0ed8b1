#include "tools/faults/test_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tools/machine/load_emulated_machine.h"

namespace contour::faults {
namespace {

struct Walked {
  double fastest_m_s = 0.0;
  double farthest_m = 0.0;
  double steepest_m_s2 = 0.0;
  double largest_step_m = 0.0;  ///< between a position and the one before carried on
  int turns = 0;
  double turned_s = 0.0;
  PathPoint last;
  std::size_t points = 0;
};

class TestPathOfXy : public ::testing::TestWithParam<double> {
 protected:
  Walked Walk(bool reverses, double end_s) {
    PerAxis<double> start;
    start.push_back(0.01);
    start.push_back(-0.02);
    PerAxis<bool> moves;
    moves.push_back(true);
    moves.push_back(false);
    TestPath path({1e-3 * GetParam(), -1, 0.1, reverses, end_s}, machine_, start, moves, 3);
    Walked w;
    PathPoint p;
    double before_m_s = 0.0;
    double carried_m = start[0];
    while (path.Next(p)) {
      const ReferencePoint& r = p.axes[0];
      w.fastest_m_s = std::max(w.fastest_m_s, std::abs(r.velocity_m_s));
      w.farthest_m = std::max(w.farthest_m, std::abs(r.position_m));
      w.steepest_m_s2 = std::max(w.steepest_m_s2, std::abs(r.acceleration_m_s2));
      w.largest_step_m = std::max(w.largest_step_m, std::abs(r.position_m - carried_m));
      if (before_m_s * r.velocity_m_s < 0.0) {
        ++w.turns;
        w.turned_s = 1e-3 * static_cast<double>(w.points);
      }
      if (r.velocity_m_s != 0.0) before_m_s = r.velocity_m_s;
      carried_m = r.position_m + 1e-3 * r.velocity_m_s + 0.5e-6 * r.acceleration_m_s2;
      EXPECT_EQ(p.axes[1].position_m, -0.02);
      ++w.points;
      w.last = p;
    }
    reversal_s_ = path.reversal_s();
    return w;
  }

  MachineConfig machine_ = LoadEmulatedMachine(std::string(CONTOUR_CONFIG_DIR) + "/xy_emulated.yaml").machine;
  double reversal_s_ = 0.0;
};

TEST_P(TestPathOfXy, StaysWithinItsLimitsAndEndsAtRest) {
  const Walked w = Walk(false, 1.0);
  const double feed = 1e-3 * GetParam();
  EXPECT_NEAR(w.fastest_m_s, feed, 1e-9);
  EXPECT_LE(w.steepest_m_s2, 5.0);
  EXPECT_LT(w.farthest_m, 0.2);
  EXPECT_LT(w.largest_step_m, 200.0 * 1e-9 / 6.0 + 1e-12) << "a step beyond the jerk limit";
  EXPECT_TRUE(w.last.last);
  EXPECT_EQ(w.last.axes[0].velocity_m_s, 0.0);
  EXPECT_EQ(w.turns, 0);
}

TEST_P(TestPathOfXy, TurnsOnceWhenItSays) {
  const Walked w = Walk(true, 1.0);
  EXPECT_EQ(w.turns, 1);
  EXPECT_NEAR(w.turned_s, reversal_s_, 2e-3);
  EXPECT_TRUE(w.last.last);
}

// Before: 0.45 m where 0.4 m were free, and the machine stopped at its position limit.
TEST_P(TestPathOfXy, TurnsWithinAShortTravel) {
  machine_.axes.at("x").limits.position_mm = {-60.0, 60.0};
  const Walked w = Walk(true, 1.0);
  EXPECT_EQ(w.turns, 1);
  EXPECT_LT(w.farthest_m, 0.06);
  EXPECT_NEAR(w.turned_s, reversal_s_, 2e-3);
}

// Before: an axis of 1 m at 622 mm/s went beyond its limit.
TEST_P(TestPathOfXy, GoesStraightWithinAShortTravel) {
  machine_.axes.at("x").limits.position_mm = {-60.0, 60.0};
  const Walked w = Walk(false, 1.0);
  EXPECT_EQ(w.turns, 0);
  EXPECT_LT(w.farthest_m, 0.06);
  EXPECT_TRUE(w.last.last);
}

INSTANTIATE_TEST_SUITE_P(Feeds, TestPathOfXy, ::testing::Values(0.01, 1.0, 30.0, 250.0));

}  // namespace
}  // namespace contour::faults
