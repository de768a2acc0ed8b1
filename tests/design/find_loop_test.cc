#include "design/find_loop.h"

#include <gtest/gtest.h>

#include "design/loop_report.h"
#include "tests/design/creeping_axes.h"

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;
const LoopSearchOptions kShort{.random_starts = 20,
                               .runs = 2,
                               .evaluations_per_run = 200,
                               .refinements = 1,
                               .evaluations_per_refinement = 200,
                               .threads = 2,
                               .start = {},
                               .members = {}};

TEST(FindLoop, IsTheSearchWhereThatFindsOne) {
  const LoopAxis axis = AxisOf("t20");
  EXPECT_EQ(FindLoop(axis, kPeriod_s, kShort).cost, SearchLoop(axis, kPeriod_s, kShort).cost);
}

TEST(FindLoop, LetsAnAxisCreepThatSlidesAndStandsWell) {
  const LoopAxis axis = LightStage();
  const FoundLoop strict = SearchLoop(axis, kPeriod_s, kShort);
  ASSERT_FALSE(WhatIsWrong(strict.verdict).empty());
  // As long as `contour tune --from-model` looks.
  const FoundLoop found = FindLoop(axis, kPeriod_s, {.threads = 2, .start = {}, .members = {}});
  const LoopReport report = ReportOn(axis, found.tuning, kPeriod_s);
  EXPECT_EQ(WhatIsWrong(report), "");
  ASSERT_TRUE(report.stick_slip);
  EXPECT_TRUE(report.stick_slip->ComesToRest());
  // Where it slides it bears all that is asked of every axis.
  for (const MemberKind kind : {MemberKind::kAsStated, MemberKind::kFarOff, MemberKind::kLate}) {
    const WorstMember& w = report.verdict.worst[static_cast<std::size_t>(kind)];
    EXPECT_TRUE(w.stable && w.peak < 1.05 * PeakLimit(axis.limits, kind)) << w.name << " " << w.peak;
  }
  EXPECT_NE(Binding(report.verdict).name.find("Stribeck"), std::string::npos);
  const std::string text = Describe(report);
  for (const char* part :
       {"sticks and slips by up to ", "mm/s; with drive.mode: csp", "worst of the axis creeping: "})
    EXPECT_NE(text.find(part), std::string::npos) << text;
}

// A bristle three times as stiff asks for another loop; friction's slope has nothing to do with it.
TEST(FindLoop, TheSofterLimitsAreForFrictionsSlopeAlone) {
  LoopAxis axis = AxisOf("t20");
  const LoopTuning tuning = SearchLoop(axis, kPeriod_s, kShort).tuning;
  axis.friction.sigma0_N_m *= 3.0;
  const LoopReport report = ReportOn(axis, tuning, kPeriod_s);
  EXPECT_NE(WhatIsWrong(report), "");
  EXPECT_FALSE(report.stick_slip);
}

TEST(FindLoop, RefusesWhatWouldHuntAtRest) {
  const LoopAxis axis = StiffTable();
  const FoundLoop found = FindLoop(axis, kSlowPeriod_s, kShort);
  EXPECT_NE(WhatIsWrong(ReportOn(axis, found.tuning, kSlowPeriod_s)), "");
}

TEST(FindLoop, RefusesABelt) {
  const LoopAxis axis = AxisOf("belt");
  const FoundLoop found = FindLoop(axis, kPeriod_s, kShort);
  EXPECT_NE(WhatIsWrong(ReportOn(axis, found.tuning, kPeriod_s)), "");
}

}  // namespace
}  // namespace contour
