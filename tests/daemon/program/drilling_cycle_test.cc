// Drilling cycles, move by move, as LinuxCNC's interpreter has them (daemon.gcode_agrees_with_linuxcnc
// compares more), and what is refused because controls differ in it.

#include <gtest/gtest.h>

#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include "daemon/program/gcode_parser.h"
#include "tests/daemon/program/on_a_table.h"

namespace contour {
namespace {

/// Of each move: t (rapid), f (feed) or d (dwell), and the end in mm.
std::vector<std::string> MovesOf(const std::string& lines) {
  std::istringstream text(CanonicalText("G21 G90 F100\nG0 X0 Y0 Z10\n" + lines + "M2\n", "part.ngc"));
  std::vector<std::string> moves;
  for (std::string line; std::getline(text, line);) {
    double x = 0.0, y = 0.0, z = 0.0;
    int number = 0;
    char kind[32]{};
    if (std::sscanf(line.c_str(), "%d %31s X%lf Y%lf Z%lf", &number, kind, &x, &y, &z) < 2 || number < 3)
      continue;
    char move[64]{};
    const std::string name(kind);
    if (name == "DWELL")
      std::snprintf(move, sizeof move, "d");
    else
      std::snprintf(move, sizeof move, "%c %g %g %g", name == "STRAIGHT_FEED" ? 'f' : 't', x, y, z);
    moves.emplace_back(move);
  }
  return moves;
}

using Moves = std::vector<std::string>;

TEST(DrillingCycle, RetractsToItsPlaneOrToWhereTheSeriesBegan) {
  EXPECT_EQ(MovesOf("G81 X5 Y6 Z-2 R3\nX7\n"),
            (Moves{"t 5 6 10", "t 5 6 3", "f 5 6 -2", "t 5 6 3", "t 7 6 3", "f 7 6 -2", "t 7 6 3"}));
  EXPECT_EQ(MovesOf("G98 G81 X5 Y6 Z-2 R3\nX7\n"), (Moves{"t 5 6 10", "t 5 6 3", "f 5 6 -2", "t 5 6 10",
                                                          "t 7 6 10", "t 7 6 3", "f 7 6 -2", "t 7 6 10"}));
  // From below the plane it goes up first.
  EXPECT_EQ(MovesOf("G0 Z1\nG98 G81 X5 Z-2 R3\n"),
            (Moves{"t 0 0 1", "t 0 0 3", "t 5 0 3", "f 5 0 -2", "t 5 0 3"}));
}

TEST(DrillingCycle, GoesUpToAHigherPlaneBeforeItGoesAcross) {
  EXPECT_EQ(MovesOf("G81 X5 Z-2 R3\nX7 R4\n"), (Moves{"t 5 0 10", "t 5 0 3", "f 5 0 -2", "t 5 0 3", "t 5 0 4",
                                                      "t 7 0 4", "f 7 0 -2", "t 7 0 4"}));
}

TEST(DrillingCycle, PecksDwellsAndFeedsOut) {
  EXPECT_EQ(MovesOf("G83 X5 Z-2 R3 Q2\n"),
            (Moves{"t 5 0 10", "t 5 0 3", "f 5 0 1", "t 5 0 3", "t 5 0 1.254", "f 5 0 -1", "t 5 0 3",
                   "t 5 0 -0.746", "f 5 0 -2", "t 5 0 3"}));
  EXPECT_EQ(MovesOf("G73 X5 Z-2 R3 Q4\n"),
            (Moves{"t 5 0 10", "t 5 0 3", "f 5 0 -1", "t 5 0 -0.746", "f 5 0 -2", "t 5 0 3"}));
  EXPECT_EQ(MovesOf("G82 X5 Z-2 R3 P1\n"), (Moves{"t 5 0 10", "t 5 0 3", "f 5 0 -2", "d", "t 5 0 3"}));
  EXPECT_EQ(MovesOf("G85 X5 Z-2 R3\n"), (Moves{"t 5 0 10", "t 5 0 3", "f 5 0 -2", "f 5 0 3", "t 5 0 3"}));
  EXPECT_EQ(MovesOf("G98 G89 X5 Z-2 R3 P1\n"), (Moves{"t 5 0 10", "t 5 0 3", "f 5 0 -2", "d", "f 5 0 10"}));
}

TEST(DrillingCycle, IncrementalHolesComeOneAfterTheOther) {
  EXPECT_EQ(MovesOf("G91 G81 X5 Z-2 R-3 L2\n"),
            (Moves{"t 5 0 10", "t 5 0 7", "f 5 0 5", "t 5 0 7", "t 10 0 7", "f 10 0 5", "t 10 0 7"}));
}

TEST(DrillingCycle, WhatControlsDifferInIsRefused) {
  const std::string head = "G21 G90 F100\nG0 X0 Y0 Z10\nG98 G81 X5 Z-2 R3\n";
  for (const char* line : {"G91 X10 L5\n", "G20 X1\n", "G18 X1\n", "G55 X1\n", "G92 Z0\n", "G10 L2 P1 Z1\n",
                           "G91 G82 X1 Z-1 R1 P1\n"}) {
    const std::string error = testing::ErrorOf([&] { CanonicalText(head + line, "part.ngc"); });
    EXPECT_NE(error.find("part.ngc:4:1: "), std::string::npos) << line << error;
    EXPECT_NE(error.find("end them by G80"), std::string::npos) << line << error;
  }
  for (const char* line : {"G80 G91\n", "G90 X1\n", "G54 G21 G17 X1\n", "G0 G91 X1\n", "G80\nG92 Z0\n"})
    EXPECT_NO_THROW(CanonicalText(head + line, "part.ngc")) << line;
  EXPECT_NE(testing::ErrorOf([&] {
              CanonicalText(head + "G83 X1 Z-2 R3 Q0.000000001\n", "part.ngc");
            }).find("more pecks"),
            std::string::npos);
  // A series begun anew states all of it.
  EXPECT_NE(testing::ErrorOf([&] {
              CanonicalText(head + "G0 X1\nG81 X7\n", "part.ngc");
            }).find("part.ngc:5:1: G81: expected R"),
            std::string::npos);
}

// A million holes of a million pecks each were within the bounds of both.
TEST(DrillingCycle, HolesTimesPecksAreBounded) {
  const auto error_of = [](const std::string& lines) {
    return testing::ErrorOf([&] { CanonicalText("G21 G91 F100\nG0 Z10\n" + lines + "M2\n", "part.ngc"); });
  };
  const std::string one = error_of("G83 X1 Z-2 R-3 Q0.9 L600000\n");
  EXPECT_EQ(one.find("part.ngc:3:1: G83: "), 0U) << one;
  EXPECT_NE(one.find("fewer holes (L) or deeper pecks (Q)"), std::string::npos) << one;
  // All of a program's together: 4000 strokes and 4 999 000.
  const std::string all = error_of("G81 X1 Z-2 R-1 L1000\nG80\nG83 X1 Z-2 R-3 Q0.9 L499900\n");
  EXPECT_EQ(all.find("part.ngc:5:1: G83: "), 0U) << all;
  EXPECT_EQ(error_of("G81 X1 Z-2 R-1 L1000\n"), "");
}

}  // namespace
}  // namespace contour
