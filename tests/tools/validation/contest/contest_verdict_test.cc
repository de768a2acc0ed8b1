#include "tools/validation/contest/contest_verdict.h"

#include <gtest/gtest.h>

#include <limits>
#include <sstream>

#include "tools/validation/contest/contest_report.h"

namespace contour {
namespace {

CellResult Peak(double um) {
  CellResult r;
  r.peak_um = r.rms_um = um;
  return r;
}

CellResult Turns(std::vector<double> peaks_um) {
  CellResult r = Peak(*std::max_element(peaks_um.begin(), peaks_um.end()));
  r.window_peak_um = std::move(peaks_um);
  return r;
}

CellResult Stopped() {
  CellResult r = Peak(std::numeric_limits<double>::infinity());
  r.failure = "stopped";
  return r;
}

Heat Of(CellResult full, CellResult pid, CellResult csp) {
  return {"ring",
          "nominal",
          1,
          {ControllerName::kPid, ControllerName::kCsp, ControllerName::kFull},
          {std::move(pid), std::move(csp), std::move(full)}};
}

TEST(Growing, IsAnErrorThatDoublesAndStillRises) {
  EXPECT_TRUE(Growing(Turns({1.0, 1.2, 1.6, 2.1})));
  EXPECT_FALSE(Growing(Turns({1.0, 1.2, 1.6, 1.9}))) << "less than twice the first";
  EXPECT_FALSE(Growing(Turns({1.0, 4.0, 3.0, 2.5}))) << "falls again";
  EXPECT_FALSE(Growing(Turns({0.1, 0.2, 0.3, 0.4}))) << "too small to matter";
  EXPECT_FALSE(Growing(Turns({1.0, 5.0}))) << "two turns say nothing";
}

TEST(Growing, IsNoStepOfForceWithFrictionThatRisesAfterIt) {
  EXPECT_FALSE(Growing(Turns({0.27, 0.26, 5.36, 0.66, 0.76, 0.63, 0.80, 0.93, 0.94, 0.95})));
  EXPECT_TRUE(Growing(Turns({0.27, 0.26, 5.36, 0.66, 0.76, 0.90, 1.10, 1.40}))) << "twice that after it";
  EXPECT_TRUE(Growing(Turns({0.27, 0.66, 0.76, 0.93, 0.94, 0.95}))) << "nothing but growth";
}

TEST(Verdict, CountsWhereFullIsBestNearItOrBehind) {
  const std::vector<Heat> heats{Of(Peak(1.0), Peak(9.0), Peak(3.0)), Of(Peak(3.29), Peak(9.0), Peak(3.0)),
                                Of(Peak(4.0), Peak(9.0), Peak(3.0)), Of(Peak(7.0), Peak(9.0), Peak(3.0))};
  const Verdict v = Judge(heats, {}, "nominal");
  EXPECT_EQ(v.heats, 4u);
  EXPECT_EQ(v.near_best, 2u);
  EXPECT_EQ(v.twice, 1u);
  ASSERT_EQ(v.losses.size(), 2u);
  EXPECT_EQ(v.losses[0].heat, &heats[3]) << "the worst first";
  EXPECT_EQ(v.losses[0].best, ControllerName::kCsp);
  EXPECT_TRUE(v.unstable.empty());
  EXPECT_FALSE(v.met());
}

TEST(Verdict, AStoppedMachineIsUnstableAndLost) {
  const std::vector<Heat> heats{Of(Stopped(), Peak(9.0), Peak(3.0))};
  const Verdict v = Judge(heats, {}, "nominal");
  EXPECT_EQ(v.near_best, 0u);
  EXPECT_EQ(v.unstable.size(), 1u);
  EXPECT_EQ(v.twice, 1u);
}

TEST(Verdict, LessThanACountIsNoDifferenceUnlessCountedStrictly) {
  const std::vector<Heat> heats{Of(Peak(0.0060), Peak(0.0500), Peak(0.0020)),
                                Of(Peak(0.0069), Peak(0.0500), Peak(0.0020))};
  const Verdict v = Judge(heats, {}, "nominal");
  EXPECT_EQ(v.near_best, 1u);
  EXPECT_EQ(v.twice, 1u);
  EXPECT_EQ(v.strictly_near_best, 0u);
  EXPECT_EQ(v.strictly_twice, 2u);
}

TEST(Verdict, AllStoppedIsNoWin) {
  const std::vector<Heat> heats{Of(Stopped(), Stopped(), Stopped())};
  EXPECT_EQ(Judge(heats, {}, "nominal").near_best, 0u);
}

TEST(Verdict, TenTimesTheMedianOfTheOthersIsUnstable) {
  const Heat heat = Of(Peak(33.0), Peak(3.0), Peak(3.5));
  EXPECT_TRUE(Unstable(heat, ControllerName::kFull));
  EXPECT_FALSE(Unstable(Of(Peak(32.0), Peak(3.0), Peak(3.5)), ControllerName::kFull));
}

TEST(Verdict, ARivalReachesItsFigureWithinFifteenPercent) {
  const std::vector<Heat> heats{Of(Peak(1.0), Peak(9.0), Peak(3.0)), Of(Peak(1.0), Peak(9.2), Peak(3.1)),
                                Of(Peak(1.0), Peak(20.0), Peak(3.2))};
  const Verdict v =
      Judge(heats, {{"csp", "ring", 2.8}, {"pid", "ring", 8.0}, {"csp", "ring", 2.6}, {"pid", "ring", 11.0}},
            "nominal");
  ASSERT_EQ(v.rivals.size(), 4u);
  EXPECT_DOUBLE_EQ(v.rivals[0].peak_um, 3.1);
  EXPECT_EQ(v.rivals[0].reached, Reached::kYes);
  EXPECT_EQ(v.rivals[1].reached, Reached::kYes);
  EXPECT_EQ(v.rivals[2].reached, Reached::kNo);
  EXPECT_EQ(v.rivals[3].reached, Reached::kBelow);
}

TEST(Report, TableHasMediansTheBestInBoldAndSaysWhereFullLoses) {
  const std::vector<Heat> heats{Of(Peak(4.0), Peak(9.0), Peak(3.0)), Of(Stopped(), Peak(8.0), Peak(2.0))};
  std::ostringstream text;
  WriteContestMarkdown(text, heats, Judge(heats, {}, "nominal"), "contour contest --seeds 1 2");
  EXPECT_NE(text.str().find("| nominal | 8.50 | **2.50** | stopped (!) |"), std::string::npos) << text.str();
  EXPECT_NE(text.str().find("| ring | nominal | 1 | 4.00 | 3.00 | csp | 1.33 |"), std::string::npos)
      << text.str();
  std::ostringstream csv;
  WriteContestCsv(csv, heats);
  EXPECT_NE(csv.str().find("ring,nominal,1,full,,,0,,1,stopped"), std::string::npos) << csv.str();
}

}  // namespace
}  // namespace contour
