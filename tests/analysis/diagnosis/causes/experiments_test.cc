#include "analysis/diagnosis/causes/experiments.h"

#include <gtest/gtest.h>

#include <string>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

std::string ProgramFor(const test::HiddenAxis& axis, std::string_view kind) {
  const Problem problem(axis.log, axis.stated, 1);
  return DecidingExperiment(problem, kind, {}).program;
}

TEST(DecidingExperiment, MovesTheAxisOfTheLog) {
  test::HiddenOptions options;
  options.duration_s = 5.0;
  test::HiddenAxis axis = test::MakeHiddenAxis(options);
  axis.stated.axis = "feed";
  for (const CauseDefinition* cause : AllCauses()) {
    const std::string_view kind = cause->name;
    const std::string program = ProgramFor(axis, kind);
    EXPECT_EQ(program.find("axis: x"), std::string::npos) << kind;
    EXPECT_TRUE(program.empty() || program.find("axis: feed") != std::string::npos) << kind << '\n'
                                                                                    << program;
  }
  // A model alone has no name; its log may have one.
  axis.stated.axis = "";
  axis.log.axis = "z";
  EXPECT_NE(ProgramFor(axis, "cogging").find("axis: z"), std::string::npos);
  axis.log.axis = "";
  EXPECT_NE(ProgramFor(axis, "cogging").find("axis: x"), std::string::npos);
}

}  // namespace
}  // namespace contour::diagnosis
