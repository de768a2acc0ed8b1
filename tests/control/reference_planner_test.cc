#include "control/reference_planner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/control/support/contour_loop.h"
#include "tests/support/allocation_guard.h"

namespace contour {
namespace {

using test::kPeriod_s;
using test::NominalAxes;

// Along x, then along y, at `speed`; the corner comes at 0.1 s.
test::Path Corner(double speed_m_s) {
  return [=](std::size_t axis, double t) {
    const double along = speed_m_s * (t - 0.1);
    const bool moves = (along < 0.0) == (axis == 0);
    return ReferencePoint{moves ? along : 0.0, moves ? speed_m_s : 0.0, 0.0};
  };
}

void Fill(const test::Path& path, double time_s, int points, PerAxis<AxisHorizon>& wanted) {
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    wanted[i].clear();
    for (int j = 0; j < points; ++j) wanted[i].push_back(path(i, time_s + j * kPeriod_s));
  }
}

double Distance(const ReferencePoint& a, const ReferencePoint& b) {
  return std::abs(a.position_m - b.position_m);
}

/// What is followed.
void Plan(ReferencePlanner& planner, const PerAxis<AxisHorizon>& wanted, PerAxis<AxisHorizon>& followed) {
  planner.Plan(wanted, followed);
  if (followed.empty()) followed = wanted;
}

TEST(ReferencePlanner, PlansNothingWhereAllIsPossible) {
  ReferencePlanner planner(PlannerConfig{}, NominalAxes(2), kPeriod_s);
  const test::Path circle = test::Circle(0.01, 0.8);
  PerAxis<AxisHorizon> wanted(2), planned;
  for (int k = 0; k < 1000; ++k) {
    Fill(circle, k * kPeriod_s, planner.horizon_points(), wanted);
    planner.Plan(wanted, planned);
    ASSERT_TRUE(planned.empty());
  }
}

TEST(ReferencePlanner, CornersStayWithinTheTorqueShareAndNearThePath) {
  PlannerConfig config;
  const PerAxis<ControlledAxis> axes = NominalAxes(2);
  const double bound = config.torque_share * axes[0].limits.force_N / axes[0].mechanics.mass_kg;
  ReferencePlanner planner(config, axes, kPeriod_s);
  PerAxis<AxisHorizon> wanted(2), planned, before;
  double peak_m = 0.0, highest_m_s2 = 0.0, last_m = 0.0;
  for (int k = 0; k < 500; ++k) {
    Fill(Corner(0.05), k * kPeriod_s, planner.horizon_points(), wanted);
    Plan(planner, wanted, planned);
    const double x = planned[0][0].position_m, y = planned[1][0].position_m;
    peak_m = std::max(peak_m, std::min(std::hypot(std::max(x, 0.0), y), std::hypot(x, std::min(y, 0.0))));
    for (std::size_t i = 0; i < 2; ++i) {
      // One motion: what was elements 1 and 2 is now 0 and 1, and velocity is what moves the position.
      if (k > 0) {
        ASSERT_LT(Distance(planned[i][0], before[i][1]), 2e-11);
        ASSERT_LT(Distance(planned[i][1], before[i][2]), 2e-11);
      }
      const double a = (planned[i][1].velocity_m_s - planned[i][0].velocity_m_s) / kPeriod_s;
      highest_m_s2 = std::max(highest_m_s2, std::abs(a));
      const double moved = planned[i][1].position_m - planned[i][0].position_m;
      ASSERT_NEAR(moved, 0.5 * kPeriod_s * (planned[i][0].velocity_m_s + planned[i][1].velocity_m_s), 1e-12);
    }
    last_m = std::hypot(planned[0][0].position_m - wanted[0][0].position_m,
                        planned[1][0].position_m - wanted[1][0].position_m);
    before = planned;
  }
  EXPECT_LT(peak_m, 3e-6);
  EXPECT_LE(highest_m_s2, bound * (1.0 + 1e-9));
  EXPECT_GT(highest_m_s2, 0.5 * bound);
  EXPECT_EQ(last_m, 0.0);  // it has joined its reference
}

TEST(ReferencePlanner, AReferenceSetAnewIsTakenAsItIs) {
  ReferencePlanner planner(PlannerConfig{}, NominalAxes(2), kPeriod_s);
  PerAxis<AxisHorizon> wanted(2), planned;
  for (int k = 0; k < 102; ++k) {  // in the middle of a corner
    Fill(Corner(0.05), k * kPeriod_s, planner.horizon_points(), wanted);
    Plan(planner, wanted, planned);
  }
  ASSERT_NE(planned[0][0].position_m, wanted[0][0].position_m);
  const auto hold = [](std::size_t, double) { return ReferencePoint{0.123, 0.0, 0.0}; };
  Fill(hold, 0.0, planner.horizon_points(), wanted);
  Plan(planner, wanted, planned);
  EXPECT_EQ(planned[0][0].position_m, 0.123);
  EXPECT_EQ(planned[1][5].position_m, 0.123);
}

TEST(ReferencePlanner, AnyNumberOfAxesAndShortHorizons) {
  for (std::size_t count = 1; count <= kMaxAxes; ++count) {
    ReferencePlanner planner(PlannerConfig{}, NominalAxes(count), kPeriod_s);
    PerAxis<AxisHorizon> wanted(count), planned;
    for (int k = 0; k < 150; ++k) {
      Fill(Corner(0.05), k * kPeriod_s, 5, wanted);
      Plan(planner, wanted, planned);
      ASSERT_EQ(planned.size(), count);
      for (std::size_t i = 0; i < count; ++i) {
        ASSERT_EQ(planned[i].size(), 5u);
        ASSERT_LT(Distance(planned[i][0], wanted[i][0]), 2e-3);
      }
    }
  }
}

TEST(ReferencePlanner, DoesNotTouchTheHeap) {
  if (!test::AllocationGuard::kAvailable) GTEST_SKIP() << "the sanitizer owns the heap";
  ReferencePlanner planner(PlannerConfig{}, NominalAxes(2), kPeriod_s);
  PerAxis<AxisHorizon> wanted(2), planned;
  for (int k = 60; k < 130; ++k) {
    Fill(Corner(0.05), k * kPeriod_s, planner.horizon_points(), wanted);
    const test::AllocationGuard guard;
    planner.Plan(wanted, planned);
    EXPECT_EQ(guard.calls(), 0u);
  }
}

TEST(ReferencePlanner, RefusesAHorizonItCannotHold) {
  PlannerConfig config;
  config.horizon = 41;
  EXPECT_THROW(ReferencePlanner(config, NominalAxes(2), kPeriod_s), std::invalid_argument);
}

}  // namespace
}  // namespace contour
