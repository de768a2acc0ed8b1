#include "daemon/program/gcode_parser.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "daemon/program/gcode/ignored_events.h"
#include "daemon/program/gcode/program_halts.h"
#include "tests/daemon/program/on_a_table.h"

namespace contour {
namespace {

using Kind = GcodeMove::Kind;
using Corner = GcodeMove::Corner;

const double kPi = std::numbers::pi;

GcodeMoves Parse(const std::string& text) { return ParseGcode(text, "part.ngc"); }

/// Where a move ends, in millimetres, of the letters in use.
std::vector<double> EndOf_mm(const GcodeMoves& p, std::size_t move) {
  std::vector<double> end;
  for (std::size_t k = 0; k < p.letters.size(); ++k) end.push_back(p.moves.at(move).target_m[k] * 1e3);
  return end;
}

TEST(GcodeParser, ModesLastUntilTheyAreChanged) {
  const GcodeMoves p = Parse("G21 G90 F600\nG1 X10 Y5\nX20\nG91 y-5\nG0 X-20 Y0\n");
  ASSERT_EQ(p.letters, "XY");
  ASSERT_EQ(p.moves.size(), 4u);
  EXPECT_EQ(EndOf_mm(p, 0), (std::vector<double>{10, 5}));
  EXPECT_EQ(EndOf_mm(p, 1), (std::vector<double>{20, 5}));
  EXPECT_EQ(p.moves[2].kind, Kind::kLine);
  EXPECT_EQ(EndOf_mm(p, 2), (std::vector<double>{20, 0}));
  EXPECT_EQ(p.moves[3].kind, Kind::kRapid);
  EXPECT_EQ(EndOf_mm(p, 3), (std::vector<double>{0, 0}));
  EXPECT_DOUBLE_EQ(p.moves[0].feed_m_s, 0.01);
  EXPECT_EQ(p.moves[3].line, 5);
}

TEST(GcodeParser, InchesScaleWayAndFeed) {
  const GcodeMoves p = Parse("G20\nG1 X1 F60\n");
  EXPECT_DOUBLE_EQ(p.moves[0].target_m[0], 0.0254);
  EXPECT_DOUBLE_EQ(p.moves[0].feed_m_s, 0.0254);
}

TEST(GcodeParser, CommentsNumbersAndBlanksAreIgnored) {
  const GcodeMoves p = Parse("%\n; all of it G5\nN10 (G1 X99) g 1 X 1 . 5 F100 ; Y3\n\n%\nG1 nonsense\n");
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
      Parse("G64 P0.005 G1 X1 F100\nX2\nG20 G64 P0.001 X3\nG64 P0 X4\nG61 X5\nG64 P1 G21\nX6\n");
  ASSERT_EQ(p.moves.size(), 6u);
  for (const std::size_t k : {0u, 1u, 2u, 5u}) EXPECT_EQ(p.moves[k].corner, Corner::kBlended) << k;
  EXPECT_EQ(p.moves[1].tolerance_m, 5e-6);
  EXPECT_NEAR(p.moves[2].tolerance_m, 25.4e-6, 1e-18);
  EXPECT_EQ(p.moves[3].corner, Corner::kContinuous);
  EXPECT_EQ(p.moves[4].corner, Corner::kExactPath);
  EXPECT_EQ(p.moves[5].tolerance_m, 1e-3);
}

TEST(GcodeParser, ErrorsNameLineAndColumn) {
  const struct {
    const char* text;
    const char* message;
  } wrong[] = {
      {"G1 X1 F100\nG5 X2\n", "part.ngc:2:1: G5 is not supported: splines"},
      {"G1.04 X1 F100\n", "part.ngc:1:1: expected a G code with at most one decimal"},
      {"G1.001 X1 F100\n", "part.ngc:1:1: expected a G code with at most one decimal"},
      {"G99999999999999999999 X1 F100\n", "part.ngc:1:1: expected a G code"},
      {"G1 X1\n", "part.ngc:1:1: a feed (F) is missing"},
      {"G1 X1 F0\n", "part.ngc:1:1: a feed (F) is missing, or is zero"},
      {"F100\n  G94 G1 X1\n", "part.ngc:2:7: a feed (F) is missing, or is zero; G94 forgets"},
      {"G93 G1 X1 F2\nX2\n", "part.ngc:2:1: a feed (F) is missing: G93 needs it"},
      {"X1\n", "part.ngc:1:1: a position without"},
      {"G80 X1\n", "part.ngc:1:1: G80 takes no axis words"},
      {"G0 X1\nG80\nX2\n", "part.ngc:3:1: a position without G0, G1, G2 or G3 since G80"},
      {"G80 G0 G1 X1 F100\n", "part.ngc:1:8: G1: a second code of the same modal group"},
      {"G80 G0 G92 X1\n", "part.ngc:1:5: G0 and G92 would both use the axis words"},
      {"G4 X2\n", "part.ngc:1:1: G4: expected P with a time in seconds; X and U are positions here"},
      {"G0 G43 H1 Z5\n",
       "part.ngc:1:8: G43 of tool 1: there is no table of tools. Name one by machine.tool_table"},
      {"G43\n", "part.ngc:1:1: G43: expected H with a tool's number, or T and M6 before it"},
      {"T2 M6\nG43\n", "part.ngc:2:1: G43 of tool 2: there is no table of tools"},
      {"G43 H-1\n", "part.ngc:1:5: H: expected a number that is not negative"},
      {"T1.5 M6\n", "part.ngc:1:1: T: expected the whole number of a tool"},
      {"G43 H1.5\n", "part.ngc:1:5: G43: expected H with the number of a tool"},
      {"WHILE [#1 LT 5] DO1\n", "part.ngc:1:1: WHILE needs an O word before it"},
      {"N5 IF [#1 EQ 0] GOTO 10\n", "part.ngc:1:4: IF needs an O word before it"},
      {"G0 X1\nGOTO 10\n", "part.ngc:2:1: GOTO needs an O word"},
      {"END1\n", "part.ngc:1:1: END needs an O word"},
      {"$H\n", "part.ngc:1:1: a command of GRBL is no G-code"},
      {"$110=200\n", "part.ngc:1:1: a command of GRBL is no G-code"},
      {"$1 M3 S100\n", "part.ngc:1:1: a choice of spindles is not supported"},
      {"M104 S200\n", "part.ngc:1:1: M104 is not supported: M100 to M199 are programs of LinuxCNC's user"},
      {"G1 X F100\n", "part.ngc:1:6: expected a number"},
      {"G1 X1 X2 F100\n", "part.ngc:1:7: word X is given twice"},
      {"G0 G1 X1 F100\n", "part.ngc:1:4: G1: a second code of the same modal group"},
      {"G61 G64 P0.01\n", "part.ngc:1:5: G64: a second code of the same modal group"},
      {"M7 M8\n", "part.ngc:1:4: M8: a second code of the same modal group"},
      {"G92 X0 G1\n", "part.ngc:1:8: G1 and G92 would both use the axis words"},
      {"G2 X10 I5 R5 F100\n", "part.ngc:1:1: an arc takes either I and J, or R"},
      {"F100 G18 G2 X10\n", "part.ngc:1:10: an arc takes either I and K, or R"},
      {"G2 X10 I5 K1 F100\n", "part.ngc:1:11: K is not in the plane of the arc"},
      {"G90.1 G2 X10 I5 F100\n", "part.ngc:1:7: G90.1: expected both"},
      {"G2 X10 I4 F100\n", "part.ngc:1:1: the arc's end is 6 mm from its centre, its start 4 mm"},
      {"G2 X.001 I.0005 F100\n",
       "part.ngc:1:1: the arc's radius of 0.0005 mm is too small, expected at least 0.00127 mm"},
      {"G2 I0 F100\n", "part.ngc:1:1: the arc's radius is zero"},
      {"G2 X10 R4 F100\n", "part.ngc:1:8: R 4 mm is too small for an arc over 10 mm"},
      {"G2 R4 F100\n", "part.ngc:1:4: an arc with R needs an end"},
      {"G2 X10 I5 P0 F100\n", "part.ngc:1:11: P of an arc: expected at least one turn"},
      {"G17.1 G1 U1 F1\n", "part.ngc:1:1: G17.1 is not supported: planes of U, V and W"},
      {"G4\n", "part.ngc:1:1: G4: expected P"},
      {"G4 P1 G2 X1 I.5 F1\n", "part.ngc:1:7: G4 and an arc"},
      {"G64 P-0.01\nG1 X1 F100\n", "part.ngc:1:5: G64: expected a tolerance"},
      {"G1 X1 F100 P0.01\n", "part.ngc:1:12: P belongs to G2, G3, G4, G10, G64, G82 and G89"},
      {"G1 X1 F100 Q0.01\n", "part.ngc:1:12: Q belongs to G64, G73 and G83"},
      {"G1 X1 F100 H1\n", "part.ngc:1:12: H belongs to G43"},
      {"G43.1 Z5\n", "part.ngc:1:1: G43.1 is not supported: tool lengths"},
      {"G41 D1\n", "part.ngc:1:1: G41 is not supported: cutter compensation; let the CAM"},
      {"G84 X1 Z1\n", "part.ngc:1:1: G84 is not supported: a canned cycle that turns or stops the spindle"},
      {"G71\n",
       "part.ngc:1:1: G71 is not supported: turning cycles here; where G70 is meant as inches and G71 as "
       "millimetres, write G20 and G21"},
      {"G76 P1\n", "part.ngc:1:1: G76 is not supported: thread cutting"},
      {"G95\n", "part.ngc:1:1: G95 is not supported: feed per revolution"},
      {"G10 L1 P1 X1\n", "part.ngc:1:5: G10: expected L2 or L20"},
      {"G10 L2 P1 R5\n", "part.ngc:1:1: G10: a rotation"},
      {"G10 L2 P1 X1 R0 I1\n", "part.ngc:1:1: G10: a rotation"},
      {"G53 G0 X1\n",
       "part.ngc:1:1: G53 counts from the machine's own zero, and the machine is not referenced"},
      {"G28\n", "part.ngc:1:1: G28 counts"},
      {"M62 P1\n", "part.ngc:1:1: M62 is not supported: inputs and outputs"},
      {"M333\n", "part.ngc:1:1: M333 is not supported"},
      {"G0 A90\n", "part.ngc:1:4: A: rotary axes are not supported"},
      {"G1 X1 (open\n", "part.ngc:1:7: comment is not closed"},
      {"G1 (a (b)\n", "part.ngc:1:7: a comment inside a comment"},
      {"G1 X(a)1\n", "part.ngc:1:5: expected a number"},
      {"G1 X1 I3 F100\n", "part.ngc:1:7: I, J and K belong to G2 and G3"},
      {"G1 X1e3 F100\n", "part.ngc:1:6: E words are not supported; a number has no exponent"},
      {"G1 X1.2.3 F100\n", "part.ngc:1:5: a number with two decimal points"},
      {"G1 X1-2 F100\n", "part.ngc:1:6: found '-', expected a word"},
      {"G1 X1 N5 F100\n", "part.ngc:1:7: found 'n', expected a word"},
      {"N10 /G1 X1 F100\n", "part.ngc:1:5: found '/', expected a word"},
      {"G0 X#<hole>\n", "part.ngc:1:5: parameter #<hole> has not been set"},
      {"G0 X[1/0]\n", "part.ngc:1:9: division by zero"},
      {"G0 X[1+2\n", "part.ngc:1:9: expected an operator or ']'"},
      {"G0 X1\n%\n", "part.ngc:2:1: found '%', expected a word"},
      {"%\nG0 X1\n", "part.ngc:2:1: the file begins with a percent sign"},
      {"o1 if [1]\nG0 X1\n", "part.ngc:1:1: O1: this is not closed"},
      {"o1 endsub\n", "part.ngc:1:1: O1: this does not belong"},
      {"o<hole> call\n", "part.ngc:1:13: there is no sub Ohole"},
      {"o1 sub\nG0 X1 (\no1 endsub\no1 call\n", "part.ngc:2:7: comment is not closed"},
      {"M2\n", "part.ngc: the program does not move"},
  };
  for (const auto& w : wrong) {
    const std::string error = testing::ErrorOf([&] { Parse(w.text); });
    EXPECT_EQ(error.rfind(w.message, 0), 0u) << w.text << "gave: " << error;
  }
}

// As LinuxCNC's interpreter does: the safe line of many posts has G80 and G0 in one block.
TEST(GcodeParser, G80GivesWayToTheMotionOfItsBlock) {
  for (const char* text : {"G00 G17 G40 G49 G80 G90 X5\nX6\n", "G80 G0 X5\nX6\n", "G80 G0 G80 X5\nX6\n"}) {
    const GcodeMoves p = Parse(text);
    ASSERT_EQ(p.moves.size(), 2u) << text;
    EXPECT_EQ(p.moves[0].kind, Kind::kRapid) << text;
    EXPECT_EQ(EndOf_mm(p, 1), (std::vector<double>{6})) << text;
  }
  EXPECT_NEAR(Parse("G80 G3 X0 Y20 J10 F100\n").moves[0].sweep_rad, kPi, 1e-12);
  EXPECT_EQ(EndOf_mm(Parse("G80 G80\nG80 G92 X3\nG0 X1\n"), 0), (std::vector<double>{-2}));
}

TEST(GcodeParser, HelicesAndPlanes) {
  const GcodeMoves p =
      Parse("F100 G3 X0 Y20 J10 Z5 P2\nG18 G2 X10 Z5 I5\nG19 G3 Y30 J5\nG17.0 G2 X20 Y30 R5 Z1\n");
  ASSERT_EQ(p.letters, "XYZ");
  EXPECT_NEAR(p.moves[0].sweep_rad, 3.0 * kPi, 1e-12);
  EXPECT_DOUBLE_EQ(p.moves[0].target_m[2], 0.005);
  // Seen with Z to the right and X upwards, clockwise about (5, 5) from (Z5, X0).
  EXPECT_EQ(p.moves[1].plane, (std::array<std::uint8_t, 2>{2, 0}));
  EXPECT_NEAR(p.moves[1].centre_m[0], 0.005, 1e-15);
  EXPECT_NEAR(p.moves[1].centre_m[1], 0.005, 1e-15);
  EXPECT_NEAR(p.moves[1].sweep_rad, -kPi, 1e-12);
  EXPECT_EQ(p.moves[2].plane, (std::array<std::uint8_t, 2>{1, 2}));
  EXPECT_DOUBLE_EQ(p.moves[3].target_m[2], 0.001);
}

TEST(GcodeParser, OffsetsCountFromProgramZero) {
  const GcodeMoves p = Parse(
      "G0 X5\nG92 X1\nG0 X2\nG10 L2 P2 X100\nG55 G0 X2\nG92.2\nX2\nG92.3\nX2\nG92.1 G54\nX2\n"
      "G10 L20 P1 X10\nX11\n");
  std::vector<double> x;
  for (std::size_t k = 0; k < p.moves.size(); ++k) x.push_back(EndOf_mm(p, k)[0]);
  ASSERT_EQ(x.size(), 7u);
  const double wanted[] = {5, 6, 106, 102, 106, 2, 3};
  for (std::size_t k = 0; k < x.size(); ++k) EXPECT_NEAR(x[k], wanted[k], 1e-12) << k;
}

TEST(GcodeParser, MachineCoordinatesOfAReferencedMachine) {
  GcodeSettings settings;
  settings.zero_m = {0.1, 0.0, 0.0, 0.0, 0.0, 0.0};
  const GcodeMoves p = ParseGcode("G92 X-3\nG53 G0 X101\nG28 X7\n", "part.ngc", settings);
  EXPECT_NEAR(p.moves[0].target_m[0], 0.001, 1e-15);
  EXPECT_NEAR(p.moves[1].target_m[0], 0.010, 1e-15);
  EXPECT_NEAR(p.moves[2].target_m[0], -0.1, 1e-15);
}

TEST(GcodeParser, FeedsStandForTheToolAndInverseTimeForTheMove) {
  // The tool goes 3 mm while U goes 4: the path in all axes is 5 mm at 5/3 of the feed.
  const GcodeMoves p = Parse("G1 X3 U4 F60\nU8\nG93 X13 F2\nF1 G94 X14\nG20\nF1\nG21 X15\n");
  EXPECT_NEAR(p.moves[0].feed_m_s, 1e-3 * 5.0 / 3.0, 1e-15);
  EXPECT_NEAR(p.moves[1].feed_m_s, 1e-3, 1e-15);
  EXPECT_NEAR(p.moves[2].feed_m_s, 10e-3 * 2.0 / 60.0, 1e-15);
  // F is read before the units of its block, and stays what it was when they change.
  EXPECT_NEAR(p.moves[3].feed_m_s, 1e-3 / 60.0, 1e-15);
  EXPECT_NEAR(p.moves[4].feed_m_s, 25.4e-3 / 60.0, 1e-15);
}

TEST(GcodeParser, ArcsWithRoundedEndsMeetThemSmoothly) {
  // 20 um between the radii at start and end: two arcs that meet, without a bend between them.
  for (const char* text : {"G0 X10\nG3 X0 Y-10.02 I-10 J0 F100\n", "G0 X10\nG3 X0 Y10.02 I-10 J0 F100\n",
                           "G0 X10\nG2 X9.98 Y0 I-10 J0 P3 F100\n"}) {
    const GcodeMoves q = Parse(text);
    for (std::size_t k = 1; k < q.moves.size(); ++k) {
      const GcodeMove& m = q.moves[k];
      const auto& from = q.moves[k - 1].target_m;
      const double r = std::hypot(from[0] - m.centre_m[0], from[1] - m.centre_m[1]);
      const double begin = std::atan2(from[1] - m.centre_m[1], from[0] - m.centre_m[0]);
      EXPECT_NEAR(m.centre_m[0] + r * std::cos(begin + m.sweep_rad), m.target_m[0], 1e-15) << text;
      EXPECT_NEAR(m.centre_m[1] + r * std::sin(begin + m.sweep_rad), m.target_m[1], 1e-15) << text;
      EXPECT_NEAR(std::hypot(m.centre_m[0], m.centre_m[1]), 0.0, 25e-6);
      if (k < 2) continue;
      // Both centres and the point between are on one line.
      const auto& c = q.moves[k - 1].centre_m;
      EXPECT_NEAR((from[0] - c[0]) * (from[1] - m.centre_m[1]) - (from[1] - c[1]) * (from[0] - m.centre_m[0]),
                  0.0, 1e-15);
    }
    EXPECT_NEAR(std::abs(q.moves.back().target_m[0]), std::abs(Parse(text).moves.back().target_m[0]), 1e-15);
  }
}

TEST(GcodeParser, WholeTurnsSurviveRounding) {
  const GcodeMoves p = Parse("G91 G1 X0.1 F100\nX0.2\nG90 G3 X0.3 Y0 I5\nX0.3 Y0.0000001 I5\n");
  EXPECT_NEAR(p.moves[2].sweep_rad, 2.0 * kPi, 1e-9);
}

TEST(GcodeParser, EventsStandBetweenMoves) {
  const GcodeMoves p = Parse("T1 M6\nG0 X1\nM3 S1000\nG1 X2 F100\nM0\nX3\nX4 M8 M1\n");
  ASSERT_EQ(p.events.size(), 7u);
  const std::size_t before[] = {0, 0, 1, 1, 2, 3, 4};
  for (std::size_t k = 0; k < p.events.size(); ++k) EXPECT_EQ(p.events[k].before_move, before[k]) << k;
  EXPECT_EQ(p.events[2].letter, 'S');
  EXPECT_EQ(p.events[2].value, 1000.0);
  EXPECT_TRUE(p.events[4].holds());
  EXPECT_EQ(p.moves[1].corner, Corner::kExactStop);
  EXPECT_EQ(p.moves[2].corner, Corner::kContinuous);
  EXPECT_EQ(p.moves[3].corner, Corner::kExactStop);
}

TEST(GcodeParser, ParametersExpressionsAndSubs) {
  const GcodeMoves p = Parse(
      "O1000 (number of the program)\n"
      "o<step> sub\n#<way>=[#1*2]\nG91 G1 X#<way> Y[-sin[30]*#1]\no<step> endsub\n"
      "F100 #31=1\no2 while [#31 le 3]\no<step> call [#31]\n#31=[#31+1]\no2 endwhile\n"
      "o3 repeat [2]\nZ1\no3 endrepeat\n"
      "o4 if [#31 gt 5]\nZ50\no4 elseif [#31 eq 4]\nZ5\no4 else\nZ70\no4 endif\n"
      "o5 do\nZ-1\no5 while [#5422 gt 5]\n");
  ASSERT_EQ(p.moves.size(), 8u);
  EXPECT_NEAR(p.moves[2].target_m[0], 12e-3, 1e-15);
  EXPECT_NEAR(p.moves[2].target_m[1], -3e-3, 1e-15);
  EXPECT_TRUE(p.moves[2].in_sub);
  EXPECT_FALSE(p.moves[3].in_sub);
  EXPECT_EQ(p.moves[2].line, 4);
  EXPECT_NEAR(p.moves[5].target_m[2], 7e-3, 1e-15);
  EXPECT_NEAR(p.moves[7].target_m[2], 5e-3, 1e-15);
}

TEST(GcodeParser, PolarCoordinatesAndNamesOfModes) {
  const GcodeMoves p = Parse("G0 @10 ^30\n^90\nG91 @5 ^90\nG20\nG90 X[#<_imperial>*2 + #<_plane>/170]\n");
  EXPECT_NEAR(p.moves[0].target_m[1], 5e-3, 1e-15);
  EXPECT_NEAR(p.moves[1].target_m[1], 10e-3, 1e-15);
  EXPECT_NEAR(p.moves[2].target_m[0], -15e-3, 1e-15);
  EXPECT_NEAR(p.moves[3].target_m[0], 3 * 25.4e-3, 1e-15);
  EXPECT_NE(testing::ErrorOf([] { Parse("G91 G0 @10 ^30\n"); }).find("part.ngc:1:8: the angle"),
            std::string::npos);
}

TEST(GcodeParser, BlockDeleteLeavesLinesOut) {
  GcodeSettings settings;
  EXPECT_EQ(ParseGcode("/N1 G0 X1\nG0 Y1\n", "part.ngc", settings).letters, "Y");
  settings.block_delete = false;
  EXPECT_EQ(ParseGcode("/N1 G0 X1\nG0 Y1\n", "part.ngc", settings).letters, "XY");
}

TEST(GcodeParser, WordsThatDoNothingAreNamedOnce) {
  const auto warning = [](const char* text, bool simulated = false, const EventUse& use = {}) {
    GcodeMoves moves = Parse(text);
    UseEvents(moves, "part.ngc", use);
    return IgnoredEvents(moves, "part.ngc", simulated);
  };
  EXPECT_EQ(warning("G0 X1\nM3 S900\nX2\nM3 S100 M8\n"),
            "part.ngc:2: no output listens to M3, M8, S: ignored, here and below");
  EXPECT_EQ(warning("G0 X1\nM0\n"), "");
  EXPECT_EQ(warning("G0 X1\nM0\n", true), "part.ngc:2: a simulation goes on at M0");
  EXPECT_EQ(warning("T1\nG0 X1\nM1\n"),
            "part.ngc:1: no output listens to T: ignored, here and below; M1 does not wait without "
            "--optional-stop");
  EXPECT_EQ(warning("T1\nG0 X1\nM1\n", false, {true, [](const GcodeEvent& e) { return e.letter == 'T'; }}),
            "");
  EXPECT_EQ(warning("G0 X1\n"), "");
  EXPECT_EQ(warning("G64 P0.01 Q0.01\nG0 X1\n"), "");
}

TEST(GcodeParser, AProgramHaltsWhereSomethingIsDoneAboutItsEvents) {
  GcodeMoves moves = Parse("M3 S900\nG64 G1 F100 X1\nT7 M6 M8\nX2\nM0\nM0\nX3\nM1\nX4\nM5\n");
  UseEvents(moves, "part.ngc", {false, [](const GcodeEvent& e) { return e.letter == 'M' && e.code <= 5; }});
  const std::vector<ProgramHalt> halts = HaltsOf(moves);
  std::string text;
  for (const ProgramHalt& halt : halts) {
    text += std::to_string(halt.before_move) + ":";
    for (const GcodeEvent& event : halt.events) text += " " + WordOf(event) + (event.waits ? "!" : "");
    text += "; ";
  }
  // Without the switch M1 is nobody's business but that of the output that the rule above has for it.
  EXPECT_EQ(text, "0: M3; 1: T7 M6!; 2: M0! M0!; 3: M1; 4: M5; ");
  EXPECT_EQ(moves.moves[0].corner, GcodeMove::Corner::kExactStop);
}

TEST(GcodeParser, BytesThatAreNoTextAreNamed) {
  const auto error = [](const std::string& text) {
    return testing::ErrorOf([&] { static_cast<void>(Parse(text)); });
  };
  EXPECT_EQ(error("G0 X1\n\xEF\xBB\xBFG0 X2\n"),
            "part.ngc:2:1: found byte 0xEF, expected a word such as X10");
  EXPECT_EQ(error("G0 X1\f\n"), "part.ngc:1:6: found byte 0x0C, expected a word such as X10");
  EXPECT_EQ(error(std::string("G0 X1\0\n", 7)), "part.ngc:1:6: found byte 0x00, expected a word such as X10");
  EXPECT_EQ(error("G0 X1 !\n"), "part.ngc:1:7: found '!', expected a word such as X10");
}

// At once, and not after millions of lines.
TEST(GcodeParser, ALoopThatNothingLeavesIsNamedByItsLine) {
  const auto error = [](const std::string& text) {
    return testing::ErrorOf([&] { static_cast<void>(Parse(text)); });
  };
  const std::string endless =
      ": the condition always holds, and nothing leaves the loop: the program does not end";
  const std::string found = error("G21\no1 while [1 EQ 1]\nG0 X1\nG0 X2\no1 endwhile\n");
  EXPECT_TRUE(found.starts_with("part.ngc:2:") && found.ends_with(endless)) << found;
  const std::string done = error("o1 do\nG0 X1\nG0 X2\no1 while [2]\n");
  EXPECT_TRUE(done.starts_with("part.ngc:4:") && done.ends_with(endless)) << done;
  // Who leaves it, and who never comes to it.
  for (const char* sound :
       {"#1=0\no1 while [1]\n#1=[#1+1]\no2 if [#1 GT 3]\no1 break\no2 endif\nG0 X#1\no1 endwhile\n",
        "o1 while [1]\nG0 X1\nM2\no1 endwhile\n", "o1 while [0]\no1 endwhile\nG0 X1\n",
        "#1=3\no1 while [#1 GT 0]\n#1=[#1-1]\nG0 X#1\no1 endwhile\n"})
    EXPECT_FALSE(Parse(sound).moves.empty()) << sound;
}

TEST(GcodeParser, AByteOrderMarkBeforeTheFirstLineIsSkipped) {
  for (const char* program : {"G0 X1\nG0 X2\n", "%\nG0 X1\nG0 X2\n%\nnonsense"}) {
    const GcodeMoves moves = Parse(std::string("\xEF\xBB\xBF") + program);
    ASSERT_EQ(moves.moves.size(), 2u) << program;
    EXPECT_EQ(EndOf_mm(moves, 0), std::vector<double>{1.0});
  }
}

// Of Unix, Windows and old controls; each counts as one line.
TEST(GcodeParser, ALineEndsWithLfCrOrBoth) {
  for (const std::string end : {"\n", "\r", "\r\n"}) {
    std::string program;
    for (const char* line :
         {"G0 X1 ; out", "", "o1 repeat [2]", "G0 X2 (there)", "G0 X3", "o1 endrepeat", "G0 X4"})
      program += line + end;
    const GcodeMoves moves = Parse(program + "G0 X5");
    ASSERT_EQ(moves.moves.size(), 7u) << static_cast<int>(end[0]);
    EXPECT_EQ(EndOf_mm(moves, 4), std::vector<double>{3.0});
    EXPECT_EQ(EndOf_mm(moves, 6), std::vector<double>{5.0});
    EXPECT_EQ(testing::ErrorOf([&] { static_cast<void>(Parse(program + "G0 X!" + end)); }).substr(0, 13),
              "part.ngc:8:5:");
    // Further than one mark of the lines' places.
    std::string longer;
    for (int i = 0; i < 600; ++i) longer += "G0 X1" + end;
    EXPECT_EQ(testing::ErrorOf([&] { static_cast<void>(Parse(longer + "G0 X!")); }).substr(0, 15),
              "part.ngc:601:5:");
  }
}

// Whatever comes over the socket is read or refused.
TEST(GcodeParser, NonsenseIsRefusedAndNothingWorse) {
  const std::string sound =
      "%\nG21 G18 F500\nG2 X4 Z2 I2 K1 P3\n#<a>=[1+sin[30]*2**3/##1]\no1 sub\nG1 X#<a> Y-[3.5]\no1 endsub\n"
      "o1 call [2] [3]\no2 repeat [3]\nG10 L20 P2 X1 G55\no2 endrepeat\nG64 P0.01\nG4 P1 (c)\n%\n";
  const std::string signs = "GMXYZIJKRPFNO#<>[]()%/;*+-.0123456789 eE\n\r\t\x01\xff";
  std::mt19937 random(1);
  int refused = 0;
  for (int k = 0; k < 3000; ++k) {
    std::string text = sound;
    for (int changes = 1 + k % 4; changes > 0; --changes) {
      const std::size_t at = random() % text.size();
      const char sign = signs[random() % signs.size()];
      if (random() % 3 == 0) {
        text.erase(at, 1 + random() % 5);
      } else if (random() % 2 == 0) {
        text.insert(at, 1 + random() % 3, sign);
      } else {
        text[at] = sign;
      }
      if (text.empty()) text = "G";
    }
    if (!testing::ErrorOf([&] { Parse(text); }).empty()) ++refused;
  }
  EXPECT_GT(refused, 300);
  for (const char* deep : {"[", "#", "-", "sin["}) {
    std::string text = "G0 X";
    for (int k = 0; k < 200000; ++k) text += deep;
    EXPECT_NE(testing::ErrorOf([&] { Parse(text); }).find("inside each other"), std::string::npos) << deep;
  }
  EXPECT_NE(testing::ErrorOf([&] { Parse("F1 G2 I1 P9" + std::string(200, '0')); }).find("more turns"),
            std::string::npos);
}

TEST(GcodeParser, ProgramsThatDoNotEndAreRefused) {
  const std::string error = testing::ErrorOf([] { Parse("#1=1\no1 while [#1]\n#1=2\no1 endwhile\n"); });
  EXPECT_NE(error.find("does it end?"), std::string::npos) << error;
}

}  // namespace
}  // namespace contour
