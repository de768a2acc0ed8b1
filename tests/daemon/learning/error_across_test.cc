#include "daemon/learning/error_across.h"

#include <gtest/gtest.h>

#include "tests/daemon/learning/pass_of_a_table.h"
#include "tests/daemon/program/on_a_table.h"

namespace contour {
namespace {

using test::kPeriod_s;

struct Seen {
  std::shared_ptr<const MotionPlan> plan;
  ErrorAcross error;
};

Seen Pass(const std::string& program,
          const std::function<void(const MotionPlan&, double, PerAxis<double>&)>& table) {
  PathGenerator generator(testing::Yaml(program), testing::Point(0.0, 0.0), testing::TableLimits(), kPeriod_s,
                          1);
  const auto plan = generator.plan();
  const std::vector<PathPoint> told = test::PointsOf(generator);
  MeasuredPass pass({ToSi(test::kScrew), ToSi(test::kScrew)}, told.size(), kPeriod_s);
  const test::Table at = [&](const std::vector<PathPoint>&, std::size_t now) {
    PerAxis<double> t(2);
    table(*plan, kPeriod_s * static_cast<double>(now), t);
    return t;
  };
  for (std::size_t k = 0; k < told.size(); ++k) pass.Add(test::RowAt(told, k, at));
  EXPECT_EQ(pass.Problem(), "");
  return {plan, FindErrorAcross(*plan, pass, nullptr, kPeriod_s)};
}

PerAxis<ReferencePoint> On(const MotionPlan& plan, double time_s) {
  PerAxis<ReferencePoint> points;
  plan.At(time_s, points);
  return points;
}

TEST(ErrorAcross, BeingLateIsNoError) {
  const Seen seen = Pass("{shape: circle, radius_mm: 10, feed_mm_min: 10000, turns: 2}",
                         [](const MotionPlan& plan, double time_s, PerAxis<double>& table_m) {
                           const auto late = On(plan, time_s - 2e-3);
                           for (std::size_t i = 0; i < 2; ++i) table_m[i] = late[i].position_m;
                         });
  EXPECT_NEAR(seen.error.late_s, 2e-3, 1e-5);
  // What is left is the zero of the scale, a mean over a pass that is late at its end too.
  // 0.33 mm behind; measured against the point of the same instant it would be 2.8 um off the circle.
  for (const auto& axis : seen.error.error_m)
    for (std::size_t k = 10; k + 10 < axis.size(); ++k) ASSERT_NEAR(axis[k], 0.0, 40e-9) << k;
}

TEST(ErrorAcross, IsTheWayBackToThePath) {
  const double wider_m = 1e-6;
  const Seen seen =
      Pass("{shape: circle, radius_mm: 10, feed_mm_min: 3000, turns: 2}",
           [&](const MotionPlan& plan, double time_s, PerAxis<double>& table_m) {
             const CommandedCircle c = *plan.circle();
             const auto on = On(plan, time_s);
             for (std::size_t i = 0; i < 2; ++i)
               table_m[i] = c.centre_m[i] + (on[i].position_m - c.centre_m[i]) * (1.0 + wider_m / c.radius_m);
           });
  const CommandedCircle c = *seen.plan->circle();
  for (std::size_t k = 200; k + 200 < seen.error.error_m[0].size(); ++k) {
    const auto on = On(*seen.plan, kPeriod_s * static_cast<double>(k));
    for (std::size_t i = 0; i < 2; ++i)
      ASSERT_NEAR(seen.error.error_m[i][k], -wider_m * (on[i].position_m - c.centre_m[i]) / c.radius_m,
                  100e-9)
          << k;
  }
}

}  // namespace
}  // namespace contour
