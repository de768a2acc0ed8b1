#include "daemon/program/gcode/tight_tolerance.h"

#include <gtest/gtest.h>

#include "daemon/program/gcode_parser.h"

namespace contour {
namespace {

std::string Warning(const std::string& text, double following_mm) {
  return TightTolerance(ParseGcode(text, "part.ngc"), "part.ngc", 1e-3 * following_mm);
}

TEST(TightTolerance, IsNamedWithItsFirstLineAndTheLeastOfThem) {
  const std::string text = "G64 P0.05\nG1 F600 X1\nG64 P0.01\nY1\nX0\nG64 P0.004\nY0\n";
  EXPECT_EQ(Warning(text, 0.001), "");
  EXPECT_EQ(Warning(text, 0.006),
            "part.ngc:4: a tolerance of 0.004 mm leaves the machine 0.002 mm; it is expected to be off its "
            "path by 0.006 mm, at any speed (machine.path_following_mm)");
}

TEST(TightTolerance, OfAProgramThatStatesNoneIsTheMachines) {
  EXPECT_EQ(Warning("G1 F600 X1\nG64\nY1\nG61\nX0\n", 0.05), "");
}

}  // namespace
}  // namespace contour
