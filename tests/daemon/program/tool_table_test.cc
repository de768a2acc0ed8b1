#include "daemon/program/gcode/tool_table.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <variant>

#include "daemon/program/gcode_parser.h"
#include "daemon/program/placed_program.h"
#include "daemon/program/program.h"
#include "tests/support/scratch_directory.h"

namespace contour {
namespace {

constexpr char kTable[] =
    "; T number, P pocket, Z length in mm, D diameter\r\n"
    "T1 P1 Z42.5 D6 ;end mill\r\n"
    "\n"
    "t2 p2 z+10 x-1.5 ;a comment with T1 in it\n"
    "T12P7Z0";

std::string ErrorOf(const std::string& table) {
  try {
    ParseToolTable(table, "tools.tbl");
  } catch (const ProgramError& error) {
    return error.what();
  }
  return {};
}

TEST(ToolTable, IsReadAsLinuxCncWritesIt) {
  const ToolTable table = ParseToolTable(kTable, "tools.tbl");
  ASSERT_EQ(table.offsets_m.size(), 3u);
  EXPECT_DOUBLE_EQ((*table.Find(1))[2], 0.0425);
  EXPECT_DOUBLE_EQ((*table.Find(2))[0], -0.0015);
  EXPECT_DOUBLE_EQ((*table.Find(2))[2], 0.01);
  EXPECT_EQ(*table.Find(12), AxisValues{});
  EXPECT_EQ(*table.Find(0), AxisValues{}) << "no tool has no length";
  EXPECT_EQ(table.Find(3), nullptr);
  EXPECT_EQ(ParseToolTable(std::string("\xEF\xBB\xBF") + kTable, "tools.tbl").offsets_m, table.offsets_m)
      << "behind a byte order mark";
}

TEST(ToolTable, MatterToProgramsThatAskForLengths) {
  for (const char* text : {"G43 H1\n", "g1x2g43\n", "N10 G 04 3\n", "G043\n"})
    EXPECT_TRUE(AsksForLengths(text)) << text;
  for (const char* text : {"G1 X43 Y0.43\n", "G4 P43\n", "G1 X1 N43\n", ""})
    EXPECT_FALSE(AsksForLengths(text)) << text;
}

TEST(ToolTable, SaysWhatIsWrongAndWhere) {
  const struct {
    const char* text;
    const char* message;
  } wrong[] = {
      {"P1 Z5\n", "tools.tbl:1: expected T and the number of a tool"},
      {"T1 Z5\nT1 Z6\n", "tools.tbl:2: tool 1 is in the table twice"},
      {"T1 Z\n", "tools.tbl:1: expected a letter and a number, as in T1 P1 Z42.5, found 'Z' without one"},
      {"T1 Z+-5\n", "tools.tbl:1: expected a letter and a number"},
      {"T1 Znan\n", "tools.tbl:1: expected a letter and a number"},
      {"T1.5\n", "tools.tbl:1: expected T with a whole number from 0 to 99999"},
      {"T1 T2\n", "tools.tbl:1: T is given twice"},
      {"T1 Z42.5 Z7\n", "tools.tbl:1: Z is given twice"},
      {"T-1\n", "tools.tbl:1: expected T"},
      {"T1 R5\n", "tools.tbl:1: found 'R', expected T, P, X"},
      {"T1 Z5 B2\n", "tools.tbl:1: a tool's offset along B is not supported"},
      {"T1 Z5,2\n", "tools.tbl:1: expected a letter and a number"},
  };
  for (const auto& w : wrong) EXPECT_EQ(ErrorOf(w.text).rfind(w.message, 0), 0u) << w.text << ErrorOf(w.text);
}

GcodeSettings WithTable() {
  GcodeSettings settings;
  settings.tools = std::make_shared<const ToolTable>(ParseToolTable(kTable, "tools.tbl"));
  settings.zero_m.emplace();
  return settings;
}

/// Without the numbers of the lines.
std::string Moves(const std::string& program) {
  std::istringstream lines(CanonicalText(program, "part.ngc", WithTable()));
  std::string moves;
  for (std::string line; std::getline(lines, line);) moves += line.substr(line.find(' ')) + "\n";
  return moves;
}

std::string Refused(const std::string& program) {
  try {
    Moves(program);
  } catch (const ProgramError& error) {
    return error.what();
  }
  return {};
}

TEST(ToolLength, LiftsTheProgramByTheToolsLength) {
  EXPECT_EQ(Moves("G0 Z5\nG43 H1\nG0 Z5\nG49\nG0 Z5\n"), Moves("G0 Z5\nG0 Z47.5\nG0 Z5\n"));
  EXPECT_EQ(Moves("G43 H1 G0 Z5\n"), Moves("G0 Z47.5\n")) << "it is in force in its own block";
  EXPECT_EQ(Moves("G43 H1\nG0 X5\n"), Moves("G0 X5\n")) << "nothing moves by itself";
  EXPECT_EQ(Moves("G43 H1\nG43 H2\nG0 Z1 X0\n"), Moves("G0 Z11 X-1.5\n")) << "the last one is in force";
  EXPECT_EQ(Moves("G20 G43 H1\nG0 Z1\n"), Moves("G0 Z67.9\n")) << "the table is in millimetres";
}

TEST(ToolLength, WithoutHIsThatOfTheToolInTheSpindle) {
  EXPECT_EQ(Moves("T1 M6\nT2\nG43\nG0 Z5\n"), Moves("T1 M6\nT2\nG0 Z47.5\n")) << "T alone only selects";
  EXPECT_EQ(Moves("T2 M6 G43\nG0 Z5\n"), Moves("T2 M6\nG0 Z15\n"));
  EXPECT_EQ(Moves("T2 M6 G43 H1\nG43 H0\nG0 Z5\n"), Moves("T2 M6\nG0 Z15\n"));
  EXPECT_EQ(Refused("G43 H0\n").rfind("part.ngc:1:1: G43: expected H with a tool's number, or T and M6", 0),
            0u);
}

TEST(ToolLength, IsAnOffsetAsTheOthersAre) {
  EXPECT_EQ(Moves("G0 Z50\nG43 H1\nG92 Z0\nG0 Z1\n"), Moves("G0 Z50\nG0 Z51\n"));
  EXPECT_EQ(Moves("G0 Z50\nG43 H1\nG92 Z0\nG49\nG0 Z1\n"), Moves("G0 Z50\nG0 Z8.5\n"));
  EXPECT_EQ(Moves("G0 Z50\nG43 H1\nG10 L20 P1 Z0\nG0 Z1\n"), Moves("G0 Z50\nG0 Z51\n"));
  EXPECT_EQ(Moves("G43 H1\nG53 G0 Z5\n"), Moves("G0 Z5\n")) << "the machine's own coordinates have none";
  EXPECT_EQ(Moves("G43 H1\nG0 Z5\nG91 Z1\n"), Moves("G0 Z47.5\nZ48.5\n"));
  EXPECT_EQ(Moves("G43 H1 G99 G81 X1 Z-5 R2 F100\nG80\n"), Moves("G99 G81 X1 Z37.5 R44.5 F100\nG80\n"));
}

TEST(ToolLength, OfAToolThatIsNotInTheTableIsRefused) {
  EXPECT_EQ(Refused("G0 X1\nG43 H3\n"), "part.ngc:2:5: G43 of tool 3: it is not in tools.tbl");
  EXPECT_EQ(Refused("T3 M6\nG43\n"), "part.ngc:2:1: G43 of tool 3: it is not in tools.tbl");
  EXPECT_EQ(Refused("G81 X1 Z-5 R2 F100\nG43 H1\n").rfind("part.ngc:2:1: G43 among drilling cycles", 0), 0u);
}

TEST(ToolLength, TheTableIsReadAnewForEveryProgram) {
  const test::ScratchDirectory scratch;
  const std::filesystem::path file = scratch.path() / "tools.tbl";
  PerAxis<PlanLimits> limits;
  PlanLimits z;
  z.axis = "z";
  limits.push_back(z);
  ReadOptions options;
  options.part.tool_table = file.string();
  PerAxis<double> at_m;
  at_m.push_back(0.0);
  const Placement here = Placement::Here(at_m);
  for (const double length_mm : {10.0, 20.0}) {
    std::ofstream(file) << "T1 Z" << length_mm << "\n";
    const Program program =
        ReadPlaced({"G43 H1\nG0 Z0\n", "part.ngc", ProgramFormat::kGcode}, here, limits, options);
    EXPECT_EQ(std::get<GcodeMoves>(program.shape).moves.front().target_m[0], 1e-3 * length_mm);
  }
  std::filesystem::remove(file);
  EXPECT_THROW(ReadPlaced({"G43 H1\nG0 Z0\n", "part.ngc", ProgramFormat::kGcode}, here, limits, options),
               ProgramError);
  EXPECT_NO_THROW(ReadPlaced({"G0 Z0\n", "part.ngc", ProgramFormat::kGcode}, here, limits, options))
      << "a program without lengths asks for no table";
  EXPECT_THROW(LoadToolTable("/dev/zero"), ProgramError);
}

}  // namespace
}  // namespace contour
