#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "tests/daemon/path_way.h"
#include "tests/daemon/program/part_programs.h"

// Feeds of 0 to 200 %, as the cycle sees them.
namespace contour {
namespace {

using test::kPeriod_s;
using test::kTolerance_m;
using test::Limits;
using test::Way;
using test::WithTolerance;

std::vector<std::string> Programs() {
  return {testing::ChordCircle(10, 0.1, 3, 2500), testing::Pocket(2, 3000), testing::RapidZigzag(4),
          testing::EngravedText(3, 3, 0.05, 3, 1500), "F2000\nG1 X40\nG4 P0.3\nG1 Y20\nG0 X0 Y0\n"};
}

// The supply looks seldom and hears late, as on a busy host; the feed changes at any time, in the middle of
// another change too. Laws that come too late are withdrawn.
TEST(FeedOverrideTest, AnyFeedAtAnyTimeKeepsTheLimitsAndThePath) {
  std::mt19937 random(5);
  const auto below = [&](unsigned n) { return static_cast<int>(random() % n); };
  const auto programs = Programs();
  const PerAxis<PlanLimits> sets[] = {Limits(0.25, 5.0, 200.0), Limits(0.6, 2.0, 30.0),
                                      Limits(0.1, 15.0, 2000.0)};
  int refused = 0;
  double fastest = 0.0;
  for (std::size_t round = 0; round < 2 * programs.size(); ++round) {
    SCOPED_TRACE(round);
    Way way(programs[round % programs.size()], WithTolerance(sets[round % 3]),
            {round % 4 == 3 ? 1.7 : 1.0, false});
    double time_s = 0.0;
    int until_feed = 0, until_change = 300;
    for (int i = 0; i < 40000 && !way.ended(); ++i) {
      const bool feed = --until_feed <= 0;
      if (feed) until_feed = 1 + below(60);
      if (--until_change == 0) {
        way.feeder().SetPace(i > 8000 ? 1.0 : below(5) == 0 ? 0.0 : 0.01 * (1 + below(200)));
        until_change = 1 + below(400);
      }
      way.Cycle(feed, i / 100 % 2 == 0);
      refused += way.consumer().follower().progress().refused_law != 0 ? 1 : 0;
      ASSERT_GE(way.place().time_s, time_s - 1e-9);
      time_s = way.place().time_s;
      fastest = std::max(fastest, way.place().pace);
    }
    EXPECT_TRUE(way.ended());
    way.ExpectAtItsEnd();
    EXPECT_EQ(way.consumer().dry(), 0);
    EXPECT_LE(way.off_m(), kTolerance_m);
    way.watch().ExpectKept();
  }
  EXPECT_GT(refused, 0) << "the test shall see laws that come too late";
  EXPECT_GT(fastest, 1.5) << "and feeds that are kept";
}

TEST(FeedOverrideTest, IsFasterWhereTheFeedBinds) {
  const PerAxis<PlanLimits> limits = WithTolerance(Limits(0.5, 5.0, 200.0));
  const auto cycles = [&](const std::string& text, double feed) {
    Way way(text, limits, {feed, false});
    way.Run(100000);
    EXPECT_TRUE(way.ended());
    way.watch().ExpectKept();
    return way.cycles();
  };
  const std::string line = "F1500\nG1 X100\n";
  EXPECT_NEAR(cycles(line, 2.0), 0.5 * cycles(line, 1.0), 200);
  EXPECT_NEAR(cycles(line, 1.5), cycles(line, 1.0) / 1.5, 200);
  // Rapids are as fast as the axes already.
  EXPECT_NEAR(cycles(testing::RapidZigzag(3), 2.0), cycles(testing::RapidZigzag(3), 1.0), 5);
}

TEST(FeedOverrideTest, WhereItIsInTheProgramAndWhenItEndsAreTold) {
  Way way("F1500\nG1 X50\nG1 Y50\n", WithTolerance(Limits(0.5, 5.0, 200.0)));
  way.Run(500);
  way.feeder().SetPace(2.0);
  way.Run(500);
  EXPECT_NEAR(way.place().pace, 2.0, 1e-3);
  EXPECT_EQ(way.place().line, 2U);
  way.Run(100000);
  EXPECT_TRUE(way.ended());
  EXPECT_NEAR(way.place().time_s, way.plan().duration_s(), 3e-3);
  EXPECT_LT(way.cycles() * kPeriod_s, 0.7 * way.plan().duration_s());
}

TEST(FeedOverrideTest, APauseAboveTheProgrammedFeedGoesOnAsFast) {
  Way way("F1500\nG1 X60\nG1 Y50\nX0\n", WithTolerance(Limits(0.5, 5.0, 200.0)), {2.0, false});
  way.Run(500);
  way.feeder().SetPace(0.0);
  way.Run(1000);
  EXPECT_EQ(way.place().pace, 0.0);
  const double rested_s = way.place().time_s;
  way.feeder().SetPace(0.5);
  way.Run(600);
  EXPECT_NEAR(way.place().pace, 0.5, 1e-3);
  EXPECT_GT(way.place().time_s, rested_s);
  way.feeder().SetPace(2.0);
  way.Run(600);
  EXPECT_NEAR(way.place().pace, 2.0, 0.02);
  way.Run(100000);
  way.ExpectAtItsEnd();
  way.watch().ExpectKept();
}

TEST(FeedOverrideTest, AShapeStaysAtItsOwnFeed) {
  const char* const circle = "{shape: circle, radius_mm: 10, turns: 3, frequency_hz: 1}";
  const PerAxis<PlanLimits> limits = Limits(0.4, 8.0, 400.0);
  Way fast(circle, limits, {1.8, false}, ProgramFormat::kYaml);
  Way plain(circle, limits, {}, ProgramFormat::kYaml);
  EXPECT_FALSE(fast.feeder().path()->feed_may_exceed());
  while (!plain.ended()) {
    plain.Cycle();
    fast.Cycle();
    for (std::size_t i = 0; i < 2; ++i)
      ASSERT_EQ(plain.consumer().Now()[i].position_m, fast.consumer().Now()[i].position_m);
  }
  EXPECT_TRUE(fast.ended());
}

TEST(FeedOverrideTest, SingleBlockRestsAtTheEndOfItsLinesAtAnyFeed) {
  Way way("G61.1 F1500\nG1 X20\nG1 Y10\nG1 X60\n", WithTolerance(Limits(0.5, 5.0, 200.0)), {1.5, true});
  way.Run(3000);
  EXPECT_NEAR(way.consumer().Now()[0].position_m, 20e-3, 1e-9);
  way.feeder().SetPace(2.0);
  way.Run(500);
  EXPECT_NEAR(way.consumer().Now()[1].position_m, 0.0, 1e-9) << "another feed is no reason to go on";
  way.feeder().SetPace(2.0, true);
  way.Run(250);
  EXPECT_NEAR(way.place().pace, 2.0, 1e-3);
  way.feeder().SetPace(0.5);
  way.Run(3000);
  EXPECT_NEAR(way.consumer().Now()[1].position_m, 10e-3, 1e-9);
  way.feeder().SetPace(0.5, true);
  way.Run(600);
  EXPECT_NEAR(way.place().pace, 0.5, 1e-3);
  way.feeder().SetPace(1.2);
  way.Run(100000);
  way.ExpectAtItsEnd();
  way.watch().ExpectKept();
}

TEST(FeedOverrideTest, WaitsWhereTheProgramSaysAtAnyFeed) {
  for (const double feed : {1.0, 0.4, 1.6}) {
    Way way("F1500\nG1 X30\nM0\nG1 X60\n", WithTolerance(Limits(0.5, 5.0, 200.0)), {feed, false, true});
    way.Run(300);
    // The place where it waits may have been handed out already.
    way.feeder().SetPace(2.0);
    way.Run(3000);
    EXPECT_NEAR(way.consumer().Now()[0].position_m, 30e-3, 1e-9);
    EXPECT_EQ(way.feeder().halt().number, 1U);
    EXPECT_NEAR(way.place().time_s, way.feeder().halt().time_s, 2e-3);
    way.feeder().SetPace(1.3);
    way.Run(500);
    EXPECT_NEAR(way.consumer().Now()[0].position_m, 30e-3, 1e-9) << "another feed is no reason to go on";
    way.feeder().Release();
    way.Run(300);
    EXPECT_NEAR(way.place().pace, 1.3, 1e-3);
    way.Run(100000);
    way.ExpectAtItsEnd();
    way.watch().ExpectKept();
  }
}

// Where the axes bind, twice the feed is not twice as fast: what is left is told by what is planned.
TEST(FeedOverrideTest, WhatIsLeftAtTwiceTheFeedIsWhatTheAxesAllow) {
  const PerAxis<PlanLimits> limits = WithTolerance(Limits(0.25, 5.0, 200.0));
  std::string tight = "F60000\n", free = "F600\n";
  for (int k = 0; k < 40; ++k) tight += "G3 X0 Y0 I-1\n";
  for (int k = 0; k < 6; ++k) free += "G1 X30\nG1 X0\n";
  for (const std::string& text : {tight, free}) {
    SCOPED_TRACE(text.substr(0, 20));
    Way way(text, limits, {2.0, false, false, PacedPath::Options::Planning::kAheadOrSlower});
    const double duration_s = way.plan().duration_s();
    const auto go_on = [&] {
      way.feeder().PlanStep();
      way.Cycle();
    };
    while (way.place().time_s < 0.4 * duration_s) go_on();
    const double at_s = way.place().time_s;
    const int cycles = way.cycles();
    const double left_s = (duration_s - at_s) * way.feeder().time_share();
    while (!way.ended()) go_on();
    const double took_s = kPeriod_s * (way.cycles() - cycles);
    EXPECT_NEAR(left_s, took_s, 0.1 * took_s);
    if (text == tight) {
      EXPECT_GT(left_s, 0.9 * (duration_s - at_s)) << "as fast as it may be already";
    } else {
      EXPECT_LT(left_s, 0.6 * (duration_s - at_s));
    }
  }
}

}  // namespace
}  // namespace contour
