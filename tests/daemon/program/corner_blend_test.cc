#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/daemon/program/on_a_table.h"

// Corners with a tolerance (G64 P, corner_tolerance_mm).
namespace contour {
namespace {

using testing::Gcode;
using testing::PlanOf;
using testing::TableLimits;
using testing::Yaml;

struct Seen {
  double off_path_m = 0.0;
  double fastest_m_s = 0.0;
  double slowest_m_s = 1e9;  ///< between 50 ms after the start and 50 ms before the end
  double velocity = 0.0;     ///< of one axis, as shares of the limits
  double acceleration = 0.0;
  double jerk = 0.0;
  double velocity_mismatch_m_s = 0.0;  ///< of what is stated against differences of positions
};

/// The reference, every `step_s`.
Seen Sample(const MotionPlan& plan, double step_s = 1e-4) {
  const PerAxis<PlanLimits> limits = TableLimits();
  Seen seen;
  PerAxis<ReferencePoint> before, now;
  plan.At(0.0, before);
  for (double t = step_s; t < plan.duration_s(); t += step_s) {
    plan.At(t, now);
    PerAxis<double> point;
    double speed = 0.0;
    for (std::size_t i = 0; i < now.size(); ++i) {
      point.push_back(now[i].position_m);
      speed = std::hypot(speed, now[i].velocity_m_s);
      const double change = (now[i].acceleration_m_s2 - before[i].acceleration_m_s2) / step_s;
      const double difference = (now[i].position_m - before[i].position_m) / step_s;
      const double mean = 0.5 * (now[i].velocity_m_s + before[i].velocity_m_s);
      seen.velocity = std::max(seen.velocity, std::abs(now[i].velocity_m_s) / limits[i].velocity_m_s);
      seen.acceleration =
          std::max(seen.acceleration, std::abs(now[i].acceleration_m_s2) / limits[i].acceleration_m_s2);
      seen.jerk = std::max(seen.jerk, std::abs(change) / limits[i].jerk_m_s3);
      seen.velocity_mismatch_m_s = std::max(seen.velocity_mismatch_m_s, std::abs(difference - mean));
    }
    seen.off_path_m = std::max(seen.off_path_m, plan.Distance_m(point));
    seen.fastest_m_s = std::max(seen.fastest_m_s, speed);
    if (t > 0.05 && t < plan.duration_s() - 0.05) seen.slowest_m_s = std::min(seen.slowest_m_s, speed);
    before = now;
  }
  return seen;
}

void ExpectWithinLimits(const Seen& seen, const std::string& what) {
  EXPECT_LT(seen.velocity, 1.0 + 1e-9) << what;
  EXPECT_LT(seen.acceleration, 1.0 + 1e-9) << what;
  EXPECT_LT(seen.jerk, 1.0 + 1e-6) << what;
  EXPECT_LT(seen.velocity_mismatch_m_s, 2e-7) << what;  // 200 m/s^3 (0.1 ms)^2 / 12 is the trapezoid's error
}

/// 2 um of the tolerance, or half of it, is left for the machine.
double ShareOfTheBlend_m(double tolerance_mm) {
  return std::max(tolerance_mm - 2e-3, 0.5 * tolerance_mm) * 1e-3;
}

TEST(CornerBlend, UsesTheToleranceWithinTheLimitsAndMovesOn) {
  for (const char* shape : {"square", "diamond"}) {
    double slower = 0.0;
    for (const double tolerance_mm : {0.001, 0.002, 0.005, 0.01}) {
      const std::string text = std::string("{shape: ") + shape + ", side_mm: 10, feed_mm_min: 3000, turns: 2";
      const auto plan = PlanOf(Yaml(text + ", corner_tolerance_mm: " + std::to_string(tolerance_mm) + "}"));
      const Seen seen = Sample(*plan);
      const std::string what = shape + std::to_string(tolerance_mm);
      ExpectWithinLimits(seen, what);
      EXPECT_LT(seen.off_path_m, ShareOfTheBlend_m(tolerance_mm) * (1 + 1e-9)) << what;
      EXPECT_GT(seen.off_path_m, ShareOfTheBlend_m(tolerance_mm) * 0.98) << what;
      EXPECT_NEAR(seen.fastest_m_s, 0.05, 1e-9) << what;
      EXPECT_GT(seen.slowest_m_s, 1.2 * slower) << what << ": more tolerance, more speed";
      slower = seen.slowest_m_s;
      EXPECT_LT(plan->duration_s(), PlanOf(Yaml(text + ", corners: exact_stop}"))->duration_s()) << what;
    }
  }
}

TEST(CornerBlend, TheSquareIsTheOverlapOfTwoStops) {
  // Axes of a square are independent: x brakes at its jerk limit, d = j t^3 / 6 before the corner, while y
  // already runs. Half of the overlap is (6 d / j)^(1/3).
  const auto duration = [](const char* corner) {
    return PlanOf(Yaml("{shape: square, side_mm: 10, feed_mm_min: 3000, turns: 4, corner_tolerance_mm: " +
                       std::string(corner) + "}"))
        ->duration_s();
  };
  const double half_s = std::cbrt(6 * 3e-6 / 200.0);
  // Four turns have 15 corners; a tolerance of 1 pm is a stop in each but for 0.3 us.
  EXPECT_NEAR(duration("1e-9") - duration("0.005"), 15 * 2 * half_s, 15 * 6e-5);
}

TEST(CornerBlend, NeverLaterThanStopping) {
  for (const char* p : {"0.0001", "0.001", "0.005", "0.02", "0.1", "1"}) {
    for (const char* moves : {"X10\nY10\nX0\nY0\n", "X1 Y0.2\nX0.3 Y-0.5\nX0\nX-0.1\nX0\n",
                              "X5\nX10 Y1\nX11 Y3\nG3 X11 Y13 J5\nG1 X0 F6000\nY0\n"}) {
      const double stopping_s = PlanOf(Gcode("G61\nG1 F3000 " + std::string(moves)))->duration_s();
      const auto plan = PlanOf(Gcode("G64 P" + std::string(p) + "\nG1 F3000 " + moves));
      EXPECT_LT(plan->duration_s(), stopping_s * 1.02) << p << moves;
    }
  }
}

TEST(CornerBlend, TheCornerItselfIsMissedByAtMostTwiceTheTolerance) {
  // 160 degrees: a blend that used all of its 3 um off the legs would pass the tip at 17 um.
  const auto plan = PlanOf(Gcode("G64 P0.005\nG1 F3000 X10\nX0.603074 Y3.420201\n"));
  double nearest = 1.0;
  for (double t = 0.0; t < plan->duration_s(); t += 1e-5) {
    PerAxis<ReferencePoint> now;
    plan->At(t, now);
    nearest = std::min(nearest, std::hypot(now[0].position_m - 0.013, now[1].position_m + 0.004));
  }
  EXPECT_LT(nearest, 2 * 3e-6 * 1.001);
  EXPECT_GT(nearest, 2 * 3e-6 * 0.99);
  EXPECT_LT(Sample(*plan).jerk, 1.02);
}

TEST(CornerBlend, AnyPolygonStaysWithinToleranceAndLimits) {
  std::mt19937 random(7);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int run = 0; run < 100; ++run) {
    const std::string tolerance = std::to_string(std::pow(10.0, between(-3.5, 0.0)));
    std::string text;
    const double longest_mm = std::pow(10.0, between(-2.0, 1.0));
    double heading_rad = between(-3.1, 3.1);
    for (int k = 0; k < 12; ++k) {
      if (k % 4 == 0) text += "\nG1 F" + std::to_string(between(100, 15000));
      // Turns of less than about a degree count as none, and are not blended.
      heading_rad += (k % 2 ? 1 : -1) * between(0.03, 3.14);
      const double length_mm = between(0.05, 1.0) * longest_mm;
      text += "\nX" + std::to_string(length_mm * std::cos(heading_rad)) + " Y" +
              std::to_string(length_mm * std::sin(heading_rad));
    }
    const auto stopping = PlanOf(Gcode("G91 G61" + text + "\n"));
    text = "G91 G64 P" + tolerance + text + "\n";
    const auto plan = PlanOf(Gcode(text));
    EXPECT_LT(plan->duration_s(), stopping->duration_s() * 1.02) << text;
    const Seen seen = Sample(*plan, std::min(1e-4, plan->duration_s() / 2000));
    EXPECT_LT(seen.velocity, 1.02) << text;
    EXPECT_LT(seen.acceleration, 1.02) << text;
    EXPECT_LT(seen.jerk, 1.1) << text;  // at an instant, not over a cycle
    EXPECT_LT(seen.velocity_mismatch_m_s, 2e-7) << text;
    EXPECT_LT(seen.off_path_m, ShareOfTheBlend_m(std::stod(tolerance)) * (1 + 1e-6)) << text;
    PerAxis<ReferencePoint> end;
    plan->At(plan->duration_s(), end);
    EXPECT_NEAR(std::hypot(end[0].velocity_m_s, end[1].velocity_m_s), 0.0, 1e-9) << text;
  }
}

TEST(CornerBlend, ReversalsAndDwellsAreStops) {
  for (const char* moves : {"X10\nX0\n", "X10\nG4 P0.1\nG1 Y10\n", "X10\nG4 P0\nG1 Y10\n"}) {
    const Seen seen = Sample(*PlanOf(Gcode(std::string("G64 P0.01\nG1 F3000 ") + moves)));
    EXPECT_LT(seen.off_path_m, 1e-9) << moves;
    EXPECT_LT(seen.slowest_m_s, 2e-5) << moves;
  }
}

TEST(CornerBlend, TangentPiecesArePassedAtFullSpeed) {
  const Seen seen = Sample(*PlanOf(Gcode("G64 P0.005\nG1 F3000 X10\nG3 X15 Y5 J5\nG1 Y10\n")));
  EXPECT_NEAR(seen.slowest_m_s, 0.05, 1e-3);
  EXPECT_LT(seen.jerk, 1.02);
}

TEST(CornerBlend, ALineThatMeetsAnArcAtAnAngleIsBlendedToo) {
  const Seen seen = Sample(*PlanOf(Gcode("G64 P0.01\nG1 F3000 X10\nG2 X20 I5 J0\n")));
  EXPECT_GT(seen.slowest_m_s, 2e-3);
  EXPECT_LT(seen.off_path_m, ShareOfTheBlend_m(0.01));
  EXPECT_LT(seen.jerk, 1.02);
}

TEST(CornerBlend, AChangeOfFeedAndADwellOfNothingBesideBlends) {
  const Seen seen =
      Sample(*PlanOf(Gcode("G64 P0.01\nG1 F3000 X10\nF900 X12\nF6000 X30\nY10\nG4 P0\nG1 X0 Y5\n")));
  EXPECT_LT(seen.acceleration, 1.02);
  EXPECT_LT(seen.jerk, 1.02);
  EXPECT_NEAR(seen.fastest_m_s, 0.1, 5e-4);
  EXPECT_LT(seen.off_path_m, 8e-6 * (1 + 1e-9));
}

TEST(CornerBlend, WithoutJerkLimitsTooAndInThreeAxes) {
  PerAxis<PlanLimits> limits = TableLimits();
  limits.push_back(limits[0]);
  limits[2].axis = "z";
  for (PlanLimits& l : limits) l.jerk_m_s3 = 0.0;
  PerAxis<double> start(3);
  std::fill(start.begin(), start.end(), 0.0);
  const Program program = Gcode("G64 P0.01\nG1 F3000 X5 Y5 Z5\nX10 Y0 Z8\nX10 Y10 Z0\n");
  const auto plan = PlanMotion(program, start, limits);
  double off_path = 0.0;
  for (double t = 0.0; t < plan->duration_s(); t += 1e-4) {
    PerAxis<ReferencePoint> now;
    plan->At(t, now);
    PerAxis<double> point;
    for (const ReferencePoint& p : now) {
      point.push_back(p.position_m);
      EXPECT_LT(std::abs(p.acceleration_m_s2), 5.0 * (1 + 1e-9));
    }
    off_path = std::max(off_path, plan->Distance_m(point));
  }
  EXPECT_LT(off_path, 8e-6 * (1 + 1e-9));
  EXPECT_GT(off_path, 7e-6);
}

TEST(CornerBlend, G64WithoutPIsTheMachinesTolerance) {
  const auto plain = PlanOf(Gcode("G1 F3000 X10\nY10\n"));
  const auto back = PlanOf(Gcode("G64 P0.5\nG64\nG1 F3000 X10\nY10\n"));
  const auto same = PlanOf(Gcode("G64 P0.01\nG1 F3000 X10\nY10\n"));
  EXPECT_EQ(plain->duration_s(), back->duration_s());
  EXPECT_NEAR(plain->duration_s(), same->duration_s(), 1e-12);
  EXPECT_NEAR(Sample(*plain).off_path_m, ShareOfTheBlend_m(0.01), 0.2e-6);
}

TEST(CornerBlend, TurnsAreCountedThroughBlends) {
  const auto plan =
      PlanOf(Yaml("{shape: square, side_mm: 2, feed_mm_min: 3000, turns: 3, corner_tolerance_mm: 0.01}"));
  double before = 0.0;
  for (double t = 0.0; t < plan->duration_s(); t += 1e-4) {
    EXPECT_GE(plan->Turns(t), before);
    before = plan->Turns(t);
  }
  EXPECT_NEAR(plan->Turns(plan->duration_s()), 3.0, 1e-9);
}

}  // namespace
}  // namespace contour
