#include "daemon/learning/learnt_under.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "tests/support/scratch_directory.h"

namespace contour {
namespace {

Placement At(double start_m) {
  PerAxis<double> start, zero;
  start.push_back(start_m);
  zero.push_back(0.0);
  return {start, zero};
}

TEST(LearntUnder, TellsApartWhereAProgramBegins) {
  EXPECT_EQ(LearntUnder("G1 X1", At(0.0), ""), LearntUnder("G1 X1", At(1e-9), ""));
  EXPECT_NE(LearntUnder("G1 X1", At(0.0), ""), LearntUnder("G1 X1", At(1e-4), ""));
  EXPECT_NE(LearntUnder("G1 X1", At(0.0), ""), LearntUnder("G1 X2", At(0.0), ""));
}

TEST(LearntUnder, AToolThatWasMeasuredAnewMakesAnotherProgram) {
  const test::ScratchDirectory scratch;
  const std::string table = (scratch.path() / "tools.tbl").string();
  const auto key = [&](const char* program, const char* lengths) {
    std::ofstream(table) << lengths;
    return LearntUnder(program, At(0.0), table);
  };
  EXPECT_NE(key("G43 H1", "T1 Z10"), key("G43 H1", "T1 Z10.02"));
  EXPECT_EQ(key("G1 X43", "T1 Z10"), key("G1 X43", "T1 Z10.02")) << "it has no lengths";
}

}  // namespace
}  // namespace contour
