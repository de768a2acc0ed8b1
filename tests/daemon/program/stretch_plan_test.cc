#include "daemon/program/stretch_plan.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "daemon/program/smooth_path.h"
#include "tests/daemon/program/motion_seen.h"
#include "tests/daemon/program/on_a_table.h"
#include "tests/daemon/program/part_programs.h"

namespace contour {
namespace {

using testing::ErrorOf;
using testing::Gcode;
using testing::MotionSeen;
using testing::PlanOf;
using testing::Point;
using testing::SeeMotion;
using testing::TableLimits;

double Duration_s(const std::string& text) { return PlanOf(Gcode(text))->duration_s(); }

TEST(StretchPlan, ChordsAreAsFastAsTheArcTheyStandFor) {
  const double arc_s = Duration_s("G21 F3000\nG3 X0 Y0 I-10\n");
  for (const double chord_mm : {0.01, 0.02, 0.1, 0.5})
    for (const int decimals : {3, 4}) {
      const double chords_s = Duration_s(testing::ChordCircle(10, chord_mm, decimals, 3000));
      EXPECT_LT(chords_s, 1.02 * arc_s) << chord_mm << ", " << decimals;
      EXPECT_GT(chords_s, 0.98 * arc_s) << chord_mm << ", " << decimals;
    }
}

TEST(StretchPlan, ShortMovesFollowTheCurveTheyAreTakenFrom) {
  // Within 10 um it could be anywhere; a smooth curve is followed as closely as its decimals tell it.
  const auto plan = PlanOf(Gcode(testing::ChordCircle(10, 0.02, 4, 3000)));
  for (double t = 0.05; t < plan->duration_s() - 0.05; t += 0.01) {
    PerAxis<ReferencePoint> p;
    plan->At(t, p);
    const double r = std::hypot(p[0].position_m - 0.003 + 0.01, p[1].position_m + 0.004);
    EXPECT_NEAR(r, 0.01, 1.5e-6) << t;
  }
}

TEST(StretchPlan, TooMuchFeedAndCurvatureSlowDown) {
  const std::string circle = "G3 X0 Y0 I-1\n";
  // 5 m/s^2 on 1 mm are 70.7 mm/s, 200 m/s^3 are 58.5.
  const MotionSeen seen = SeeMotion(*PlanOf(Gcode("F60000\n" + circle + circle + circle)), TableLimits());
  EXPECT_NEAR(seen.fastest_m_s, std::cbrt(200.0 * 1e-6), 2e-3);
  EXPECT_LT(seen.jerk, 1.02);
  EXPECT_GT(seen.jerk, 0.95);
}

TEST(StretchPlan, FeedIsReachedAndKeptBetweenCorners) {
  const MotionSeen seen = SeeMotion(*PlanOf(Gcode("F3000\nG1 X50\nY50\nX0\n")), TableLimits());
  EXPECT_NEAR(seen.fastest_m_s, 0.05, 1e-4);
  EXPECT_GT(seen.slowest_m_s, 3e-3);
  EXPECT_GT(seen.off_path_m, 6e-6);
}

TEST(StretchPlan, ExactStopStopsAndExactPathKeepsTheCorner) {
  const std::string corner = "F3000\nG1 X10\nY10\n";
  for (const char* mode : {"G61\n", "G61.1\n"}) {
    const MotionSeen seen = SeeMotion(*PlanOf(Gcode(mode + corner)), TableLimits());
    EXPECT_LT(seen.slowest_m_s, 1e-3) << mode;
    EXPECT_LT(seen.off_path_m, 1e-12) << mode;
  }
  // A line that runs into an arc: the curvature jumps, and a tenth of the tolerance has to do.
  const MotionSeen tangent = SeeMotion(*PlanOf(Gcode("G61\nF3000\nG1 X10\nG3 X20 Y10 J10\n")), TableLimits());
  EXPECT_GT(tangent.slowest_m_s, 0.01);
  EXPECT_LT(tangent.off_path_m, 0.81e-6);
  EXPECT_LT(tangent.jerk, 1.02);
}

TEST(StretchPlan, ADwellIsAStopWhereItIsProgrammed) {
  const auto plan = PlanOf(Gcode("G4 P0.5\nF3000\nG1 X10\nG4 P0.25\nG1 Y10\nG4 P0.125\n"));
  const double moves_s = Duration_s("F3000\nG1 X10\n") + Duration_s("F3000\nG1 Y10\n");
  EXPECT_NEAR(plan->duration_s(), moves_s + 0.875, 1e-9);
  PerAxis<ReferencePoint> p;
  plan->At(0.3, p);
  EXPECT_EQ(p[0].position_m, 0.003);
  plan->At(0.5 + Duration_s("F3000\nG1 X10\n") + 0.1, p);
  EXPECT_NEAR(p[0].position_m, 0.013, 1e-15);
  EXPECT_EQ(p[0].velocity_m_s, 0.0);
}

TEST(StretchPlan, NothingButDwellsIsAHold) {
  const auto plan = PlanOf(Gcode("G4 P2\n"));
  EXPECT_TRUE(plan->is_hold());
  EXPECT_NEAR(plan->duration_s(), 2.0, 1e-12);
  EXPECT_NEAR(plan->Distance_m(Point(0.003, -0.003)), 0.001, 1e-15);
}

TEST(StretchPlan, RangesAreCheckedBeforeAnythingIsPlanned) {
  std::string text = "F3000\n";
  for (int k = 0; k < 20000; ++k) text += k % 2 == 0 ? "G1 X1\n" : "G1 X0\n";
  EXPECT_NE(
      ErrorOf([&] { PlanOf(Gcode(text + "G1 X250\n")); }).find("test.ngc:20002: axis x: position 253 mm"),
      std::string::npos);
}

TEST(StretchPlan, SameAtAnyTimeInAnyOrder) {
  const Program program = Gcode(testing::EngravedText(1, 20, 0.05, 3, 1500));
  const auto forth = PlanOf(program), back = PlanOf(program);
  const double duration_s = back->duration_s();
  std::vector<PerAxis<ReferencePoint>> seen;
  for (int k = 0; k <= 200; ++k) forth->At(duration_s * k / 200, seen.emplace_back());
  for (int k = 200; k >= 0; --k) {
    PerAxis<ReferencePoint> p;
    back->At(duration_s * k / 200, p);
    for (std::size_t i = 0; i < p.size(); ++i)
      EXPECT_EQ(p[i].position_m, seen[static_cast<std::size_t>(k)][i].position_m);
  }
}

TEST(StretchPlan, LongProgramsArePlannedAsFarAsTheyAreDriven) {
  std::string text = "F3000\n";
  for (int k = 0; k < 20000; ++k)
    text += "G1 X" + std::to_string(k % 2) + "\nY" + std::to_string(k % 3) + "\n";
  const auto plan = PlanOf(Gcode("G61.1\n" + text));
  EXPECT_TRUE(plan->GoesOnAfter(1.0));
  const auto walk = plan->Walk();
  PerAxis<ReferencePoint> p;
  walk->At(1.0, p);
  EXPECT_GT(walk->Line(1.0), 2);
  EXPECT_LT(walk->Line(1.0), 40);
}

TEST(PathTree, FindsTheNearestOfManyMoves) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(-0.02, 0.02);
  PerAxis<double> at = Point(0, 0);
  MoveStore moves(at);
  for (int k = 0; k < 1000; ++k) {
    const PerAxis<double> to = Point(anywhere(random), anywhere(random));
    moves.Add({LinePiece(at, to), 0.0, 0.0, 0}, to);
    at = to;
  }
  const PathTree tree(moves);
  for (int k = 0; k < 200; ++k) {
    const PerAxis<double> point = Point(anywhere(random), anywhere(random));
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < moves.size(); ++i)
      nearest = std::min(nearest, Distance_m(moves.Curve(i), point));
    EXPECT_EQ(tree.Distance_m(point), nearest);
  }
}

TEST(SmoothPath, IsTwiceContinuouslyDifferentiableAndNearEnough) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937 random(seed);
    const auto between = [&](double low, double high) {
      return low + (high - low) * static_cast<double>(random()) / 4294967295.0;
    };
    const double tolerance_m = std::pow(10.0, between(-7.0, -3.5));
    std::vector<ProgrammedMove> moves;
    PerAxis<double> at = Point(0, 0);
    MoveStore store(at);
    for (int k = 0; k < 60; ++k) {
      const double length = std::pow(10.0, between(-6.0, -2.0)), heading = between(-3, 3);
      const PerAxis<double> to =
          Point(at[0] + length * std::cos(heading), at[1] + length * std::sin(heading));
      moves.push_back({LinePiece(at, to), 0.01, tolerance_m, k});
      store.Add(moves.back(), to);
      at = to;
    }
    const ProgrammedPath path(moves);
    const SmoothPath smooth = SmoothPathThrough(path).path;
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(smooth.Position(0.0)[i], 0.0);
      EXPECT_NEAR(smooth.Position(smooth.to_m())[i], at[i], 1e-16);
    }
    for (std::size_t k = 1; k < smooth.pieces(); ++k) {
      const double way = smooth.break_m(k);
      const PathDerivatives a = smooth.At(way, k - 1), b = smooth.At(way, k);
      const double h = std::min(way - smooth.break_m(k - 1), smooth.break_m(k + 1) - way);
      for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(a.position_m[i], b.position_m[i], 1e-15);
        EXPECT_NEAR(a.first[i], b.first[i], 1e-9);
        EXPECT_NEAR(a.second[i] * h, b.second[i] * h, 1e-8);
      }
    }
    const PathTree tree(store);
    for (std::size_t k = 0; k < smooth.pieces(); ++k)
      for (int j = 0; j < 20; ++j) {
        const double way = smooth.break_m(k) + (smooth.break_m(k + 1) - smooth.break_m(k)) * j / 20;
        EXPECT_LT(tree.Distance_m(smooth.Position(way)), tolerance_m * 1.01) << seed << " " << way;
      }
  }
}

}  // namespace
}  // namespace contour
