#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "daemon/program/gcode_parser.h"
#include "daemon/program/paced_path.h"
#include "daemon/program/part_of_program.h"
#include "daemon/program/stretch_plan.h"
#include "tests/daemon/program/motion_seen.h"
#include "tests/daemon/program/on_a_table.h"
#include "tests/daemon/program/part_programs.h"

// What is kept of a long program while it is driven: a few bytes for each line, and a window of the rest.
namespace contour {
namespace {

using testing::Gcode;
using testing::TableLimits;

/// Turns of a circle in chords: alike all the way, however many lines it has.
std::string Turns(int lines) {
  const std::string turn = testing::ChordCircle(4, 0.1, 4, 3000);
  const auto first = turn.find("\nG1");
  std::string text = turn.substr(0, first + 1);
  const std::string moves = turn.substr(first + 1, turn.find("M2") - first - 1);
  const auto each = std::count(moves.begin(), moves.end(), '\n');
  for (long n = 0; n < lines; n += each) text += moves;
  return text;
}

struct Largest {
  std::size_t moves = 0, nodes = 0, lines = 0;
  double seconds = 0.0;
};

/// As the daemon drives it: planned so far ahead, given up behind.
Largest Drive(const MotionPlan& plan, double ahead_s, double behind_s, double period_s = 1e-3) {
  const auto walk = plan.Walk();
  auto& stretches = dynamic_cast<StretchWalk&>(*walk);
  Largest largest;
  PerAxis<ReferencePoint> at;
  for (long k = 0;; ++k) {
    const double t = period_s * static_cast<double>(k);
    while (walk->planned_s() < t + ahead_s) walk->PlanStep();
    walk->At(t, at);
    if (k % 256 == 0) {
      walk->ForgetBefore(std::max(0.0, t - behind_s));
      const StretchWalk::Kept kept = stretches.kept();
      largest.moves = std::max(largest.moves, kept.moves);
      largest.nodes = std::max(largest.nodes, kept.nodes);
    }
    largest.lines = std::max(largest.lines, static_cast<std::size_t>(walk->Line(t)));
    largest.seconds = t;
    if (!walk->GoesOnAfter(t)) return largest;
  }
}

TEST(LongProgram, TenTimesTheLinesNeedTheSameWindow) {
  const auto plan_of = [](int lines) { return testing::PlanOf(Gcode(Turns(lines))); };
  const auto few = plan_of(5000), many = plan_of(50000);
  const Largest a = Drive(*few, 0.5, 0.1), b = Drive(*many, 0.5, 0.1);
  EXPECT_GT(b.lines, 9 * a.lines);
  EXPECT_GT(b.seconds, 9.0 * a.seconds);
  // Both in full swing.
  EXPECT_LE(b.moves, a.moves + a.moves / 4);
  EXPECT_LE(b.nodes, a.nodes + a.nodes / 4);
  EXPECT_LT(a.moves, 4000u) << "the window is shorter than the shorter program";
}

// A bore's helix is a single move, whatever its turns.
TEST(LongProgram, FiveTimesTheTurnsNeedTheSameWindow) {
  const auto plan_of = [](int turns) {
    return testing::PlanOf(Gcode("F12000\nG3 I4 P" + std::to_string(turns) + "\n"));
  };
  const auto few = plan_of(200), many = plan_of(1000);
  const Largest a = Drive(*few, 0.5, 0.1, 4e-3), b = Drive(*many, 0.5, 0.1, 4e-3);
  EXPECT_GT(b.seconds, 4.5 * a.seconds);
  EXPECT_LE(b.moves, a.moves + a.moves / 4);
  EXPECT_LE(b.nodes, a.nodes + a.nodes / 4);
}

/// How far a program is planned before its first point is handed out.
double PlannedFirst_s(double period_s) {
  auto generator =
      std::make_unique<PathGenerator>(testing::PlanOf(Gcode(Turns(20000))), TableLimits(), period_s, 1U);
  PacedPath::Options options;
  options.planning = PacedPath::Options::Planning::kAhead;
  PacedPath path(std::move(generator), options);
  double planned_s = 0.0;
  for (PacedPath::Plan plan = path.TakePlan(); plan.walk; plan = path.TakePlan()) {
    plan.walk->PlanStep();
    planned_s = plan.walk->planned_s();
    path.GivePlan(std::move(plan));
  }
  return planned_s;
}

TEST(LongProgram, HowFarAheadIsPlannedIsATimeWhateverTheCycle) {
  const double usual_s = PlannedFirst_s(1e-3);
  EXPECT_GT(usual_s, 0.5);
  for (const double period_s : {250e-6, 4e-3, 20e-3})
    EXPECT_NEAR(PlannedFirst_s(period_s), usual_s, 0.3 * usual_s) << period_s;
}

std::string HalfCircles(int lines) {
  std::string arcs = "F3000\n";
  for (int k = 0; k < lines; ++k) arcs += k % 2 == 0 ? "G3 X0.1 I0.05\n" : "G2 X0 I-0.05\n";
  return arcs;
}

std::size_t BytesKept(const std::string& text) {
  const auto plan = testing::PlanOf(Gcode(text));
  return dynamic_cast<const StretchPlan&>(*plan).program()->bytes_in_memory();
}

TEST(LongProgram, AFewBytesAreKeptForEachLine) {
  constexpr int kLines = 20000;
  // Pages that are begun.
  const double pages = 6.0 * Spool::kPageBytes;
  EXPECT_LT(static_cast<double>(BytesKept(Turns(kLines))), kLines * (8.0 * 2 + 12 + 1) + pages);
  // They turn back each time, so that each of them is a stop.
  EXPECT_LT(static_cast<double>(BytesKept(HalfCircles(kLines))), kLines * (8.0 * 2 + 12 + 40 + 64) + pages);
}

// While it is read and afterwards: what is more than a window is on disk.
TEST(LongProgram, FiveTimesTheLinesNeedNoMoreMemory) {
  const auto while_read = [](const std::string& text) {
    return ParseGcode(text, "part.ngc").moves.bytes_in_memory();
  };
  constexpr int kFew = 100000, kMany = 400000;
  // Times of every 64th line are still in memory: 16 bytes of each.
  constexpr std::size_t kMore = (kMany - kFew) / 2;
  for (const auto& program : {Turns, HalfCircles}) {
    const std::string few = program(kFew), many = program(kMany);
    EXPECT_LT(while_read(many), while_read(few) + kMore);
    EXPECT_LT(BytesKept(many), BytesKept(few) + kMore);
    EXPECT_LT(BytesKept(many), 6u << 20);
  }
}

// The same motion whether a program is in memory or on disk, and beginning at a line of it.
TEST(LongProgram, WhatIsOnDiskIsDrivenAsWhatIsInMemory) {
  const std::string turns = Turns(100000);
  const auto plan = testing::PlanOf(Gcode(turns));
  const auto& moves = dynamic_cast<const StretchPlan&>(*plan).program()->moves();
  const GcodeMoves read = ParseGcode(turns, "part.ngc");
  const GcodeMoves later = FromLine(read, "part.ngc", {.from_line = 90000, .go_there = true});
  ASSERT_EQ(moves.size(), read.moves.size());
  std::size_t i = 0;
  for (const GcodeMove& m : read.moves) {
    const PerAxis<double> end_m = moves.Begin(++i);
    for (std::size_t k = 0; k < 2; ++k) ASSERT_NEAR(end_m[k] - moves.start_m()[k], m.target_m[k], 1e-15);
  }
  const GcodeMove first = later.moves[1], last = later.moves[later.moves.size() - 1];
  EXPECT_EQ(first.line, 90000);
  EXPECT_EQ(later.moves.size(), read.moves.size() - (90000 - 3) + 1);
  EXPECT_EQ(last.target_m, read.moves[read.moves.size() - 1].target_m);
}

// A program is the same curve again when it is asked for: moves come out of what is kept as they went in.
TEST(LongProgram, WhatIsKeptOfAMoveIsTheMove) {
  const auto plan = testing::PlanOf(Gcode("F1000\nG1 X1 Y0.3\nG3 X2 I0.5\nG2 X2.5 Y0.1 R1\nG0 X0 Y0\n"));
  const auto& moves = dynamic_cast<const StretchPlan&>(*plan).program()->moves();
  ASSERT_EQ(moves.size(), 4u);
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const CurvePiece curve = moves.Curve(i);
    const CurvePoint end = PointAt(curve, curve.length_m);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_NEAR(end.position_m[k], moves.Begin(i + 1)[k], 1e-15);
      EXPECT_EQ(curve.start_m[k], moves.Begin(i)[k]);
    }
    EXPECT_EQ(moves.Move(i).line, static_cast<int>(i) + 2);
  }
  EXPECT_EQ(moves.Move(3).feed_m_s, 0.0);
}

/// Gentle at first, then tighter and tighter: turns in chords whose radius shrinks, then strokes of letters.
std::string TighterAndTighter(double shrink) {
  testing::GcodeText text(4);
  text.Line("G21 G90 F12000");
  double x_mm = 0.0, y_mm = 0.0, a = 0.0;
  for (double r_mm = 40.0; r_mm > 0.02; r_mm *= shrink) {
    const double step = std::min(0.2, 0.3 / r_mm);
    for (int k = 0; k < 40; ++k) {
      a += std::max(0.02, step);
      x_mm += r_mm * std::max(0.02, step) * std::cos(a);
      y_mm += r_mm * std::max(0.02, step) * std::sin(a);
      text.To(x_mm, y_mm);
    }
  }
  for (int k = 0; k < 60; ++k) text.To(x_mm + 0.01 * (k % 2), y_mm + 0.003 * k);
  return text.str();
}

// What is safe for all of the path is not known when it begins.
TEST(LongProgram, PathsThatGetTighterLaterKeepTheLimits) {
  const double limits_of[][3] = {{0.25, 5.0, 200.0}, {0.6, 1.9, 20.0}, {0.1, 10.0, 5000.0}};
  for (const double shrink : {0.9, 0.5, 0.05}) {
    for (const auto& l : limits_of) {
      SCOPED_TRACE(::testing::Message() << shrink << ", " << l[2]);
      PerAxis<PlanLimits> limits = TableLimits();
      for (std::size_t i = 0; i < 2; ++i) {
        limits[i].position_min_m = -1.0;
        limits[i].position_max_m = 1.0;
        limits[i].velocity_m_s = l[0];
        limits[i].acceleration_m_s2 = l[1];
        limits[i].jerk_m_s3 = l[2];
      }
      const auto plan = PlanMotion(Gcode(TighterAndTighter(shrink)), testing::Point(0, 0), limits);
      const testing::MotionSeen seen = testing::SeeMotion(*plan, limits);
      EXPECT_LT(seen.velocity, 1.02);
      EXPECT_LT(seen.acceleration, 1.02);
      EXPECT_LT(seen.jerk, 1.02);
      EXPECT_LT(seen.off_path_m, 1e-5);
    }
  }
}

}  // namespace
}  // namespace contour
