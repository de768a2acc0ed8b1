#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "tests/daemon/program/motion_seen.h"
#include "tests/daemon/program/on_a_table.h"
#include "tests/daemon/program/part_programs.h"

// The smooth path keeps the range of every axis, also where the programmed one goes to its very end.
namespace contour {
namespace {

/// How far the motion leaves the range that the programmed path takes up, and the programmed path itself.
struct Left {
  double range_m = 0.0;
  double path_m = 0.0;
};

/// `places`: of the programmed path, from where it begins.
Left LeftBy(const std::string& text, const std::vector<std::array<double, 2>>& places_mm,
            double tolerance_m) {
  PerAxis<PlanLimits> limits = testing::TableLimits();
  for (std::size_t a = 0; a < 2; ++a) {
    limits[a].position_min_m = limits[a].position_max_m = 0.0;
    for (const auto& p : places_mm) {
      limits[a].position_min_m = std::min(limits[a].position_min_m, 1e-3 * p[a]);
      limits[a].position_max_m = std::max(limits[a].position_max_m, 1e-3 * p[a]);
    }
    limits[a].path_tolerance_m = tolerance_m;
  }
  const auto plan = PlanMotion(testing::Gcode(text), testing::Point(0, 0), limits);
  Left left;
  PerAxis<ReferencePoint> at;
  for (double t = 0.0; t < plan->duration_s(); t += 2e-4) {
    plan->At(t, at);
    for (std::size_t a = 0; a < 2; ++a) {
      left.range_m = std::max({left.range_m, at[a].position_m - limits[a].position_max_m,
                               limits[a].position_min_m - at[a].position_m});
    }
    left.path_m = std::max(left.path_m, plan->Distance_m(testing::Point(at[0].position_m, at[1].position_m)));
  }
  const testing::MotionSeen seen = testing::SeeMotion(*plan, limits);
  EXPECT_LT(seen.jerk, 1.02) << text;
  EXPECT_LT(seen.acceleration, 1.02) << text;
  return left;
}

TEST(SafeTravel, IsKeptByASmoothPathThatGoesToItsEnds) {
  // An arc, chords with few decimals, corners: all of them touch the range on all sides.
  const double tolerance_m = 2e-5;
  const Left arc =
      LeftBy("F6000\nG2 X10 Y10 I10\nG2 X0 Y0 J-10\n", {{0, 0}, {0, 0}, {10, 10}, {20, -10}}, tolerance_m);
  EXPECT_LE(arc.range_m, 1.001e-9);
  EXPECT_LE(arc.path_m, tolerance_m);
  std::string chords = "F6000\n", corners = "F6000\n";
  std::vector<std::array<double, 2>> places;
  for (int k = 0; k <= 90; ++k) {
    const double angle = 2 * std::numbers::pi * k / 90;
    const double x = std::round(1e3 * 5 * (1 - std::cos(angle))) / 1e3;
    const double y = std::round(1e3 * 5 * std::sin(angle)) / 1e3;
    places.push_back({x, y});
    chords += "G1 X" + std::to_string(x) + " Y" + std::to_string(y) + "\n";
  }
  const Left circle = LeftBy(chords, places, tolerance_m);
  EXPECT_LE(circle.range_m, 1.001e-9);
  EXPECT_LE(circle.path_m, tolerance_m);
}

TEST(SafeTravel, IsKeptByAnyMoves) {
  std::mt19937 random(9);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967295.0;
  };
  for (int round = 0; round < 12; ++round) {
    std::string text = "F4000\n";
    std::vector<std::array<double, 2>> places{{0, 0}};
    for (int k = 0; k < 40; ++k) {
      const double length = std::pow(10.0, between(-2.0, 0.7)), heading = between(-3.14, 3.14);
      const double x = std::round(1e3 * (places.back()[0] + length * std::cos(heading))) / 1e3;
      const double y = std::round(1e3 * (places.back()[1] + length * std::sin(heading))) / 1e3;
      places.push_back({x, y});
      text += "G1 X" + std::to_string(x) + " Y" + std::to_string(y) + "\n";
    }
    const Left left = LeftBy(text, places, 5e-5);
    EXPECT_LE(left.range_m, 1.001e-9) << text;
    EXPECT_LE(left.path_m, 5e-5) << text;
  }
}

}  // namespace
}  // namespace contour
