#include "control/report_turns.h"

#include <gtest/gtest.h>

namespace contour {
namespace {

double MostOf(std::initializer_list<double> reports_N) {
  ReportTurns turns;
  turns.Restart(*reports_N.begin());
  for (const double report_N : reports_N) turns.See(report_N);
  return turns.most_N();
}

TEST(ReportTurns, AReportThatGoesOneWayHasNone) {
  EXPECT_EQ(MostOf({3.0, 3.0, 10.0, 10.0, 50.0, 400.0}), 0.0);
  EXPECT_EQ(MostOf({3.0, -5.0, -60.0, -60.0}), 0.0);
}

TEST(ReportTurns, AKickHasGoneThereAndBackHoweverLongItStays) {
  EXPECT_EQ(MostOf({0.0, 240.0, 0.0}), 240.0);
  EXPECT_EQ(MostOf({0.0, 240.0, 240.0, 0.0}), 240.0);
  EXPECT_EQ(MostOf({0.0, -100.0, -240.0, -40.0}), 200.0) << "what it has come back by";
}

TEST(ReportTurns, TheLargestCountsUntilTheRestart) {
  EXPECT_EQ(MostOf({0.0, 10.0, 0.0, 240.0, 0.0, 5.0, 0.0}), 240.0);
  ReportTurns turns;
  turns.Restart(0.0);
  turns.See(240.0);
  turns.See(0.0);
  turns.Restart(0.0);
  turns.See(7.0);
  EXPECT_EQ(turns.most_N(), 0.0) << "what went before the restart comes back from nowhere";
}

}  // namespace
}  // namespace contour
