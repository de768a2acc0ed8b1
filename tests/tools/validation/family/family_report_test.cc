#include "tools/validation/family/family_report.h"

#include <gtest/gtest.h>

#include <sstream>

namespace contour {
namespace {

FamilyCell Cell(const char* machine, const char* mode, char program, std::uint64_t seed) {
  FamilyCell c;
  c.setting.machine = machine;
  c.entry = {"full", mode};
  c.program = program;
  c.seed = seed;
  return c;
}
FamilyResult Result(double peak_um, double hold_um, const char* failure = "", bool refused = false) {
  return {.wind_up_um = 2.0,
          .peak_um = peak_um,
          .rms_um = 0.5 * peak_um,
          .hold_pp_um = hold_um,
          .failure = failure,
          .refused = refused};
}

TEST(FamilyReport, PeaksAreMediansOverTheSeedsInUnitsOfWindUp) {
  std::ostringstream out;
  WriteFamilyTable(out,
                   {Cell("a", "cst", 'B', 1), Cell("a", "cst", 'B', 2), Cell("a", "cst", 'B', 3),
                    Cell("a", "cst", 'C', 1)},
                   {Result(1.0, 0.1), Result(4.0, 0.6), Result(3.0, 0.2), Result(5.0, 0.1)});
  EXPECT_EQ(out.str(), "| | F/K um | full cst |\n|---|---|---|\n| a | 2.00 | 1.50 / 2.50 (0.30) |\n");
}

TEST(FamilyReport, AStoppedSeedIsNoMedianAndARefusedMachineNoPeak) {
  std::ostringstream out;
  WriteFamilyTable(out,
                   {Cell("a", "cst", 'B', 1), Cell("a", "cst", 'B', 2), Cell("a", "csp", 'B', 1),
                    Cell("b", "cst", 'B', 1)},
                   {Result(1.0, 0.1), Result(900.0, 0.0, "a fault"), Result(1.0, 0.0),
                    Result(0.0, 0.0, "no design", true)});
  EXPECT_NE(out.str().find("| a | 2.00 | stopped (0.05) | 0.50 (0.00) |"), std::string::npos) << out.str();
  EXPECT_NE(out.str().find("| b | 2.00 | refused |"), std::string::npos) << out.str();
}

TEST(FamilyReport, TheTableForProgramsHasARowPerRun) {
  std::ostringstream out;
  WriteFamilyCsv(out, {Cell("a", "cst", 'B', 7)}, {Result(1.0, 0.1, "said \"no\", twice")});
  EXPECT_NE(out.str().find(
                "\na,ideal,near,lugre,,full,cst,B,7,2,1,0.5,0.1,0,0,0,0,0,0,0,\"said \"\"no\"\", twice\"\n"),
            std::string::npos)
      << out.str();
}

TEST(FamilyReport, RatiosAreToFullInTheModeOfTheBetterCircle) {
  FamilyCell b = Cell("a", "csp", 'B', 1), c = Cell("a", "csp", 'C', 1);
  b.entry.controller = c.entry.controller = "cnc";
  std::ostringstream out;
  WriteFamilyRatios(out,
                    {Cell("a", "cst", 'B', 1), Cell("a", "cst", 'C', 1), Cell("a", "csp", 'B', 1),
                     Cell("a", "csp", 'C', 1), b, c},
                    {Result(0.1, 0.0), Result(4.0, 0.0), Result(0.5, 0.0), Result(1.0, 0.0), Result(2.0, 0.0),
                     Result(3.0, 0.0)});
  EXPECT_NE(out.str().find("| a | csp | 4.00 / 3.00 |\n| median | | 4.00 / 3.00 |"), std::string::npos)
      << out.str();
}

TEST(FamilyReport, WithoutARivalThereIsNoRatio) {
  std::ostringstream out;
  WriteFamilyRatios(out, {Cell("a", "cst", 'B', 1)}, {Result(1.0, 0.0)});
  EXPECT_EQ(out.str(), "");
}

}  // namespace
}  // namespace contour
