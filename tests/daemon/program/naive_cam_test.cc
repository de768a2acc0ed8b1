#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "daemon/program/gcode_parser.h"
#include "daemon/program/part_of_program.h"

// G64 Q, LinuxCNC's naive CAM detector. Its rule is that of LinuxCNC's emccanon (2.9), `linkable` and
// `chord_deviation`; its `rs274` prints moves as they are before it.
namespace contour {
namespace {

std::vector<int> LinesOf(const std::string& text, const GcodeSettings& settings = {}) {
  std::vector<int> lines;
  for (const GcodeMove& m : ParseGcode(text, "part.ngc", settings).moves) lines.push_back(m.line);
  return lines;
}

TEST(NaiveCam, MovesWithinQOfOneLineBecomeOne) {
  const std::string moves = "G1 X1 F600\nX2 Y0.003\nX3\nX4 Y0.02\n";
  EXPECT_EQ(LinesOf("G64 P0.01 Q0.005\n" + moves), (std::vector<int>{4, 5}));
  EXPECT_EQ(LinesOf("G64 Q0.005\n" + moves), (std::vector<int>{4, 5}));
  EXPECT_EQ(LinesOf("G64 P0.01 Q0.001\n" + moves), (std::vector<int>{2, 3, 4, 5}));
  EXPECT_EQ(LinesOf("G64 P0.01 Q0.5\n" + moves), (std::vector<int>{5}));
  // Inches.
  EXPECT_EQ(LinesOf("G20 G64 P0.01 Q0.005\n" + moves), (std::vector<int>{4, 5}));
}

TEST(NaiveCam, NothingIsJoinedUnlessQAsksForIt) {
  const std::string moves = "G1 X1 F600\nX2\nX3\n";
  for (const char* mode :
       {"G64", "G64 P0.01", "G64 P0.01 Q0", "G61", "G61.1", "G64 Q1\nG64 P0.01", "G64 Q1\nG61"})
    EXPECT_EQ(LinesOf(std::string(mode) + "\n" + moves).size(), 3U) << mode;
}

TEST(NaiveCam, WhatEndsALine) {
  for (const char* between : {"F500", "G4 P0.1", "M3 S100", "G64 P0.02 Q1", "T1"})
    EXPECT_EQ(LinesOf("G64 P0.01 Q1 F600\nG1 X1\nX2\n" + std::string(between) + "\nX3\nX4\n").size() -
                  (between[1] == '4' && between[0] == 'G' && between[2] == ' ' ? 1U : 0U),
              2U)
        << between;
  EXPECT_EQ(LinesOf("G64 P0.01 Q1 F600\nG1 X1\nG0 X2\nG1 X3\nX4\n").size(), 3U) << "a rapid";
  EXPECT_EQ(LinesOf("G64 P0.01 Q1 F600\nG1 X1\nX2 U1\nX3\nX4\n").size(), 3U) << "axes beside the tool";
  EXPECT_EQ(LinesOf("G64 P0.01 Q1 F600\nG1 X5\nX-5\nX0\n").size(), 3U) << "back by more than Q";
  EXPECT_EQ(LinesOf("G64 P0.01 Q1 F600\nG1 X0.5\nX0\nX0.5\n").size(), 3U) << "back to its begin";
}

TEST(NaiveCam, NothingReachesAcrossTheLineAtWhichAPartBegins) {
  GcodeSettings from_five;
  from_five.begins_at_line = 5;
  const std::string twice = "G64 P0.01 Q1 F600\nG91\no1 repeat [2]\nG1 X1\nX1\no1 endrepeat\nM2\n";
  EXPECT_EQ(LinesOf(twice, from_five), (std::vector<int>{4, 5, 4, 5}));
}

TEST(NaiveCam, AHundredPointsAtMost) {
  std::string text = "G64 P0.01 Q0.1 F600 G1\n";
  for (int k = 1; k <= 1010; ++k) text += "X" + std::to_string(k) + "\n";
  EXPECT_EQ(LinesOf(text).size(), 10U);
}

TEST(NaiveCam, AnArcOfSeveralTurnsStaysOne) {
  EXPECT_EQ(LinesOf("G64 P0.01 Q0.02 F600\nG2 I0.004 P2\n").size(), 1U);
}

TEST(NaiveCam, AFlatArcInXYIsALine) {
  // The middle of the arc is 5 um from its chord.
  const std::string arc = "G1 X1 F600\nG3 X2 R25\nG1 X3\n";
  EXPECT_EQ(LinesOf("G64 P0.01 Q0.006\n" + arc).size(), 1U);
  EXPECT_EQ(LinesOf("G64 P0.01 Q0.004\n" + arc).size(), 3U);
  EXPECT_EQ(LinesOf("G18 G64 P0.01 Q0.006\nG1 X1 F600\nG3 X2 R25\nG1 X3\n").size(), 3U);
  EXPECT_EQ(LinesOf("G64 P0.01 Q0.02 F600\nG2 I0.004\nG2 I0.1 P3\n").size(), 3U) << "circles stay";
}

// No point of the moves is farther from the path than Q, whatever they are.
TEST(NaiveCam, EveryPointIsWithinQ) {
  std::string text = "G64 P0.01 Q0.02 F600 G1\n";
  std::vector<std::array<double, 2>> points;
  for (int k = 1; k <= 3000; ++k) {
    points.push_back({0.01 * k, 0.4 * std::sin(0.02 * k) + 0.009 * std::sin(13.0 * k)});
    text += "X" + std::to_string(points.back()[0]) + " Y" + std::to_string(points.back()[1]) + "\n";
  }
  const GcodeMoves p = ParseGcode(text, "part.ngc");
  EXPECT_LT(p.moves.size(), 400U);
  std::size_t move = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    while (p.moves[move].line < static_cast<int>(k) + 2) ++move;
    const std::array<double, 6> begin_m = move == 0 ? p.start_m : p.moves[move - 1].target_m;
    const std::array<double, 6>& end_m = p.moves[move].target_m;
    const double dx = end_m[0] - begin_m[0], dy = end_m[1] - begin_m[1], length = std::hypot(dx, dy);
    const double off_m =
        ((1e-3 * points[k][0] - begin_m[0]) * dy - (1e-3 * points[k][1] - begin_m[1]) * dx) / length;
    EXPECT_LE(std::abs(off_m), 20.001e-6) << k;
  }
}

TEST(NaiveCam, BeginningAtALineAndSingleBlockFindEveryLine) {
  const std::string text = "G64 P0.01 Q1\nG1 X1 F600\nX2\nX3\nX4\n";
  GcodeSettings settings;
  settings.begins_at_line = 4;
  EXPECT_EQ(LinesOf(text, settings), (std::vector<int>{3, 4, 5}));
  settings.joins_lines = false;
  EXPECT_EQ(LinesOf(text, settings), (std::vector<int>{2, 3, 4, 5}));
}

}  // namespace
}  // namespace contour
