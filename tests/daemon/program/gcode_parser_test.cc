#include "daemon/program/gcode_parser.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/daemon/program/on_a_table.h"

namespace contour {
namespace {

using Kind = GcodeMove::Kind;
using Corner = GcodeMove::Corner;

const double kPi = std::numbers::pi;

GcodeMoves Parse(const std::string& text) { return ParseGcode(text, "part.ngc"); }

TEST(GcodeParser, ModesLastUntilTheyAreChanged) {
  const GcodeMoves p = Parse("G21 G90 F600\nG1 X10 Y5\nX20\nG91 y-5\nG0 X-20 Y0\n");
  ASSERT_EQ(p.letters, "XY");
  ASSERT_EQ(p.moves.size(), 4u);
  EXPECT_EQ(p.moves[0].target_m, (std::vector<double>{0.01, 0.005}));
  EXPECT_EQ(p.moves[1].target_m, (std::vector<double>{0.02, 0.005}));
  EXPECT_EQ(p.moves[2].kind, Kind::kLine);
  EXPECT_EQ(p.moves[2].target_m, (std::vector<double>{0.02, 0.0}));
  EXPECT_EQ(p.moves[3].kind, Kind::kRapid);
  EXPECT_EQ(p.moves[3].target_m, (std::vector<double>{0.0, 0.0}));
  EXPECT_DOUBLE_EQ(p.moves[0].feed_m_s, 0.01);
  EXPECT_EQ(p.moves[3].line, 5);
}

TEST(GcodeParser, InchesScaleWayAndFeed) {
  const GcodeMoves p = Parse("G20\nG1 X1 F60\n");
  EXPECT_DOUBLE_EQ(p.moves[0].target_m[0], 0.0254);
  EXPECT_DOUBLE_EQ(p.moves[0].feed_m_s, 0.0254);
}

TEST(GcodeParser, CommentsNumbersAndBlanksAreIgnored) {
  const GcodeMoves p = Parse("%\n; all of it G5\nN10 (G1 X99) g 1 X 1 . 5 F100 ; Y3\n\n%\n");
  ASSERT_EQ(p.moves.size(), 1u);
  EXPECT_DOUBLE_EQ(p.moves[0].target_m[0], 0.0015);
  EXPECT_EQ(p.letters, "X");
}

TEST(GcodeParser, ArcsByCentreAndByRadius) {
  const GcodeMoves centre = Parse("G3 X0 Y20 J10 F100\nG2 I-5\n");
  EXPECT_NEAR(centre.moves[0].sweep_rad, kPi, 1e-12);
  EXPECT_NEAR(centre.moves[0].centre_m[1], 0.01, 1e-15);
  EXPECT_DOUBLE_EQ(centre.moves[1].sweep_rad, -2.0 * kPi);
  // A quarter about (0, 10) from the origin to (10, 10), the short and the long way round.
  const GcodeMoves shorter = Parse("G3 X10 Y10 R10 F100\n");
  EXPECT_NEAR(shorter.moves[0].centre_m[0], 0.0, 1e-15);
  EXPECT_NEAR(shorter.moves[0].centre_m[1], 0.01, 1e-15);
  EXPECT_NEAR(shorter.moves[0].sweep_rad, 0.5 * kPi, 1e-12);
  const GcodeMoves longer = Parse("G3 X10 Y10 R-10 F100\n");
  EXPECT_NEAR(longer.moves[0].centre_m[0], 0.01, 1e-15);
  EXPECT_NEAR(longer.moves[0].centre_m[1], 0.0, 1e-15);
  EXPECT_NEAR(longer.moves[0].sweep_rad, 1.5 * kPi, 1e-12);
  const GcodeMoves clockwise = Parse("G2 X10 Y10 R10 F100\n");
  EXPECT_NEAR(clockwise.moves[0].centre_m[0], 0.01, 1e-15);
  EXPECT_NEAR(clockwise.moves[0].sweep_rad, -0.5 * kPi, 1e-12);
}

TEST(GcodeParser, PathControlAndDwell) {
  const GcodeMoves p = Parse("G1 X1 F100\nG61 X2\nG61.1 X3\nG4 P0.5\nG64 X4\nM2\nnonsense\n");
  ASSERT_EQ(p.moves.size(), 5u);
  EXPECT_EQ(p.moves[0].corner, Corner::kContinuous);
  EXPECT_EQ(p.moves[1].corner, Corner::kExactPath);
  EXPECT_EQ(p.moves[2].corner, Corner::kExactStop);
  EXPECT_EQ(p.moves[3].kind, Kind::kDwell);
  EXPECT_EQ(p.moves[3].dwell_s, 0.5);
  EXPECT_EQ(p.moves[4].corner, Corner::kContinuous);
}

TEST(GcodeParser, ToleranceOfG64IsModalInTheUnitsInForce) {
  const GcodeMoves p =
      Parse("G64 P0.005 G1 X1 F100\nX2\nG20 G64 P0.001 X3\nG64 X4\nG61 X5\nG64 P1 G21\nX6\n");
  ASSERT_EQ(p.moves.size(), 6u);
  for (const std::size_t k : {0u, 1u, 2u, 5u}) EXPECT_EQ(p.moves[k].corner, Corner::kBlended) << k;
  EXPECT_EQ(p.moves[1].tolerance_m, 5e-6);
  EXPECT_NEAR(p.moves[2].tolerance_m, 25.4e-6, 1e-18);
  EXPECT_EQ(p.moves[3].corner, Corner::kContinuous);
  EXPECT_EQ(p.moves[4].corner, Corner::kExactPath);
  EXPECT_EQ(p.moves[5].tolerance_m, 1e-3);
}

TEST(GcodeParser, ErrorsNameTheLine) {
  const struct {
    const char* text;
    const char* message;
  } wrong[] = {
      {"G1 X1 F100\nG5 X2\n", "part.ngc:2: G5 is not supported"},
      {"G1.04 X1 F100\n", "part.ngc:1: G1.04 is not supported"},
      {"G99999999999999999999 X1 F100\n", "part.ngc:1: G1e+20 is not supported"},
      {"G1 X1\n", "part.ngc:1: a feed (F) is missing"},
      {"X1\n", "part.ngc:1: a position without"},
      {"G1 X F100\n", "part.ngc:1: a number is missing after X"},
      {"G1 X1 X2 F100\n", "part.ngc:1: word X is given twice"},
      {"G0 G1 X1 F100\n", "part.ngc:1: G1: a second motion"},
      {"G2 X10 I5 R5 F100\n", "part.ngc:1: an arc takes either"},
      {"G2 X10 F100\n", "part.ngc:1: an arc takes either"},
      {"G2 X10 I4 F100\n", "part.ngc:1: the arc's end is 6 mm from its centre"},
      {"G2 X10 R4 F100\n", "part.ngc:1: R 4 mm is too small"},
      {"G2 R4 F100\n", "part.ngc:1: an arc with R needs an end"},
      {"G3 X0 Y20 Z3 J10 F100\n", "part.ngc:1: helical arcs"},
      {"G1 X1 F0\n", "part.ngc:1: F: expected a feed above zero"},
      {"G4\n", "part.ngc:1: G4: expected P"},
      {"G64 P0\nG1 X1 F100\n", "part.ngc:1: G64: expected P with a tolerance above zero"},
      {"G64 P-0.01\nG1 X1 F100\n", "part.ngc:1: G64: expected P with a tolerance above zero"},
      {"G1 X1 F100 P0.01\n", "part.ngc:1: P belongs to G4 and G64"},
      {"G61 P0.01\nG1 X1 F100\n", "part.ngc:1: P belongs to G4 and G64"},
      {"G64 G4 P0.01\n", "part.ngc:1: G4 and G64 in the same block"},
      {"G61 G64 P0.01\n", "part.ngc:1: G64: a second path control"},
      {"M3 S100\n", "part.ngc:1: M3 is not supported"},
      {"G1 X1 F100 T1\n", "part.ngc:1: T1 is not supported"},
      {"G1 X1 (open\n", "part.ngc:1: comment is not closed"},
      {"G1 X1 I3 F100\n", "part.ngc:1: I, J and R belong to G2 and G3"},
      {"G1 X1e3 F100\n", "part.ngc:1: E3 is not supported"},
      {"G1 X#1 F100\n", "part.ngc:1: a number is missing after X"},
      {"M2\n", "part.ngc: the program does not move"},
  };
  for (const auto& w : wrong) {
    const std::string error = testing::ErrorOf([&] { Parse(w.text); });
    EXPECT_EQ(error.rfind(w.message, 0), 0u) << w.text << "gave: " << error;
  }
}

}  // namespace
}  // namespace contour
