#include <gtest/gtest.h>

#include <random>
#include <string>

#include "tests/daemon/path_way.h"
#include "tests/daemon/program/part_programs.h"

// Plans that are made beside the supply of points, and too slowly.
namespace contour {
namespace {

using test::kTolerance_m;
using test::Limits;
using test::Way;
using test::WithTolerance;
using Planning = PacedPath::Options::Planning;

/// A queue that is short, so that a plan that is late is felt at once.
constexpr std::size_t kQueue = 512;

PacedPath::Options Ahead(double feed = 1.0) { return {feed, false, false, Planning::kAheadOrSlower}; }

std::string LongProgram() { return testing::Spiral(16, 0.8, 0.1, 3, 4000); }

TEST(PlanAheadTest, InTimeItIsWhatThePathPlansItself) {
  const PerAxis<PlanLimits> limits = WithTolerance(Limits(0.25, 5.0, 200.0));
  for (const std::string& text : {LongProgram(), testing::EngravedText(3, 4, 0.05, 3, 1500)}) {
    Way itself(text, limits);
    Way ahead(text, limits, Ahead(), ProgramFormat::kGcode, kQueue);
    while (ahead.place().time_s == 0.0) {
      ahead.feeder().PlanStep();
      ahead.Cycle();
    }
    while (itself.place().time_s == 0.0) itself.Cycle();
    while (!itself.ended()) {
      for (std::size_t i = 0; i < 2; ++i)
        ASSERT_EQ(itself.consumer().Now()[i].position_m, ahead.consumer().Now()[i].position_m);
      ahead.feeder().PlanStep();
      ahead.Cycle();
      itself.Cycle();
    }
    EXPECT_TRUE(ahead.ended());
  }
}

TEST(PlanAheadTest, WhereNothingIsPlannedItRestsOnThePathAndGoesOn) {
  const PerAxis<PlanLimits> limits = WithTolerance(Limits(0.25, 5.0, 200.0));
  Way way(LongProgram(), limits, Ahead(), ProgramFormat::kGcode, kQueue);
  for (int i = 0; i < 20 && way.place().time_s == 0.0; ++i) {
    way.feeder().PlanStep();
    way.Run(100);
  }
  ASSERT_GT(way.place().time_s, 0.0);
  int rests = 0;
  while (!way.ended() && rests < 1000) {
    way.Run(20000);
    if (way.ended()) break;
    EXPECT_EQ(way.place().pace, 0.0);
    EXPECT_TRUE(way.feeder().waits_for_plan());
    ++rests;
    way.feeder().PlanStep();
  }
  EXPECT_GT(rests, 2);
  way.ExpectAtItsEnd();
  EXPECT_EQ(way.consumer().dry(), 0);
  EXPECT_LE(way.off_m(), kTolerance_m);
  way.watch().ExpectKept();
}

// Steps of planning come at any time, feeds and pauses too.
TEST(PlanAheadTest, APlannerThatIsHeldBackOnlySlowsItDown) {
  std::mt19937 random(3);
  const auto below = [&](unsigned n) { return static_cast<int>(random() % n); };
  const std::string programs[] = {LongProgram(), testing::EngravedText(3, 6, 0.05, 3, 1500),
                                  testing::RapidZigzag(12)};
  const PerAxis<PlanLimits> sets[] = {Limits(0.25, 5.0, 200.0), Limits(0.6, 2.0, 30.0),
                                      Limits(0.1, 15.0, 2000.0)};
  int waited = 0;
  for (std::size_t round = 0; round < 9; ++round) {
    SCOPED_TRACE(round);
    Way way(programs[round % 3], WithTolerance(sets[(round + round / 3) % 3]),
            Ahead(round % 2 == 1 ? 1.4 : 1.0), ProgramFormat::kGcode, kQueue);
    int until_plan = 1, until_feed = 1, until_change = 2000;
    for (int i = 0; i < 200000 && !way.ended(); ++i) {
      if (--until_plan <= 0) {
        way.feeder().PlanStep();
        until_plan = 1 + below(below(3) == 0 ? 4000 : 400);
      }
      const bool feed = --until_feed <= 0;
      if (feed) until_feed = 1 + below(30);
      if (--until_change == 0) {
        way.feeder().SetPace(i > 40000 ? 1.0 : below(4) == 0 ? 0.0 : 0.01 * (1 + below(200)));
        until_change = 1 + below(1500);
      }
      way.Cycle(feed);
      waited += way.feeder().waits_for_plan() ? 1 : 0;
    }
    way.ExpectAtItsEnd();
    EXPECT_EQ(way.consumer().dry(), 0);
    EXPECT_LE(way.off_m(), kTolerance_m);
    way.watch().ExpectKept();
  }
  EXPECT_GT(waited, 1000) << "the test shall see plans that are late";
}

// What the cycle has in hand where no more is planned is a time, whatever its period.
TEST(PlanAheadTest, TheSupplyIsHeldUpAsLongWithShortCycles) {
  PerAxis<PlanLimits> limits = WithTolerance(Limits(0.25, 5.0, 3.0));
  const auto waiting_s = [&](double period_s) {
    CommandMailbox mailbox(16, 1 << 16);
    PathFeeder feeder(mailbox);
    const Program program = ParseProgram(LongProgram(), "program of the test", ProgramFormat::kGcode);
    feeder.Begin(std::make_unique<PathGenerator>(program, test::Origin(), limits, period_s, 1), Ahead());
    while (mailbox.path_points_waiting() == 0) {
      feeder.PlanStep();
      feeder.Feed();
    }
    const std::size_t in_swing = mailbox.path_points_waiting();
    PathProgress progress;
    progress.earliest = in_swing;
    mailbox.TellProgress(progress);
    feeder.Feed();
    return static_cast<double>(mailbox.path_points_waiting() - in_swing) * period_s;
  };
  EXPECT_GT(waiting_s(1e-3), 0.1);
  EXPECT_NEAR(waiting_s(1e-3), waiting_s(0.25e-3), 0.02);
}

TEST(PlanAheadTest, HowLongItTakesIsEstimatedBetterAndBetter) {
  const PerAxis<PlanLimits> limits = WithTolerance(Limits(0.25, 5.0, 200.0));
  Way way(LongProgram(), limits, Ahead(), ProgramFormat::kGcode, kQueue);
  EXPECT_FALSE(way.feeder().duration().exact);
  way.Cycle();
  const double duration_s = way.plan().duration_s();
  EXPECT_NEAR(way.feeder().duration().duration_s, duration_s, 0.3 * duration_s);
  for (int i = 0; i < 100000 && way.place().time_s < 0.5 * duration_s; ++i) {
    way.feeder().PlanStep();
    way.Cycle();
  }
  EXPECT_NEAR(way.feeder().duration().duration_s, duration_s, 0.05 * duration_s);
  for (int i = 0; i < 100000 && !way.ended(); ++i) {
    way.feeder().PlanStep();
    way.Cycle();
  }
  EXPECT_TRUE(way.feeder().duration().exact);
  EXPECT_EQ(way.feeder().duration().duration_s, duration_s);
}

}  // namespace
}  // namespace contour
