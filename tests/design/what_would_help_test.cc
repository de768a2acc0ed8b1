#include "design/what_would_help.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/design/creeping_axes.h"

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;
constexpr int kThreads = 2;

bool Has(const std::vector<std::string>& help, const std::string& part) {
  return std::any_of(help.begin(), help.end(),
                     [&](const std::string& h) { return h.find(part) != std::string::npos; });
}

TEST(WhatWouldHelp, IsAnotherTuningWhereThereIsOne) {
  EXPECT_EQ(WhatWouldHelp(AxisOf("t20"), kPeriod_s, kThreads),
            std::vector<std::string>{"another tuning: contour tune --from-model finds one"});
}

// The second search finds it, so it is not said that there is none; and what it cannot do is said.
TEST(WhatWouldHelp, IsAnotherTuningForAnAxisThatCreepsBadly) {
  const std::vector<std::string> help = WhatWouldHelp(LightStage(), kPeriod_s, kThreads);
  ASSERT_EQ(help.size(), 1u);
  EXPECT_EQ(
      help.front(),
      "another tuning: contour tune --from-model finds one, with which its table still sticks and slips "
      "where it creeps");
}

TEST(WhatWouldHelp, IsCspAndAScaleForABelt) {
  const std::vector<std::string> help = WhatWouldHelp(AxisOf("belt"), kPeriod_s, kThreads, true);
  EXPECT_TRUE(Has(help, "drive.mode: csp"));
  EXPECT_TRUE(Has(help, "a linear scale at the table"));
  EXPECT_FALSE(Has(help, "another tuning"));
}

TEST(WhatWouldHelp, IsNoScaleForAnAxisThatHasOne) {
  LoopAxis axis = AxisOf("belt");
  axis.scale_step_m = 5e-9;
  EXPECT_FALSE(Has(WhatWouldHelp(axis, kPeriod_s, kThreads, true), "scale"));
}

}  // namespace
}  // namespace contour
