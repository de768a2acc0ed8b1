#include "daemon/path_feeder.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/daemon/path_consumer.h"
#include "tests/daemon/program/keeps_limits.h"

namespace contour {
namespace {

using namespace test;

const char* const kCircle = "{shape: circle, radius_mm: 10, turns: 20, frequency_hz: 2}";
/// Moves that use acceleration and jerk to the limit much of the time.
const char* const kZigzag =
    "{shape: square, side_mm: 20, turns: 20, corner_tolerance_mm: 0.05, feed_mm_min: 6000}";

TEST(PathFeederTest, APauseStaysOnThePathWithinTheLimitsAndLeavesNoMark) {
  const PerAxis<PlanLimits> limits = Limits(0.25, 5.0, 200.0);
  CommandMailbox mailbox(16, 4096);
  PathFeeder feeder(mailbox);
  Consumer consumer(mailbox, 75.0);
  feeder.Begin(Generator(kCircle, limits));
  test::LimitWatch watch(limits, kPeriod_s);
  const auto run = [&](int cycles) {
    for (int i = 0; i < cycles && !consumer.follower().at_end(); ++i) {
      feeder.Feed();
      consumer.Tick();
      const PerAxis<ReferencePoint> now = consumer.Now();
      watch.Add(now);
      ASSERT_NEAR(std::hypot(now[0].position_m + 0.01, now[1].position_m), 0.01, 1e-12);
    }
  };
  run(1500);
  const double before_s = consumer.follower().program_place().time_s;
  feeder.SetPace(0.0);
  run(500);
  EXPECT_EQ(consumer.follower().program_place().pace, 0.0);
  for (const ReferencePoint& p : consumer.Now()) {
    EXPECT_EQ(p.velocity_m_s, 0.0);
    EXPECT_EQ(p.acceleration_m_s2, 0.0);
  }
  const double rest_s = consumer.follower().program_place().time_s;
  EXPECT_LT(rest_s - before_s, 0.4) << "some tenths of a second";
  run(20000);
  EXPECT_EQ(consumer.follower().program_place().time_s, rest_s) << "a pause may last";
  feeder.SetPace(0.5);
  run(1000);
  EXPECT_NEAR(consumer.follower().program_place().pace, 0.5, 1e-9);
  feeder.SetPace(1.0);
  run(100000);
  EXPECT_TRUE(consumer.follower().at_end());
  EXPECT_EQ(consumer.dry(), 0);
  watch.ExpectKept();
}

// The supply looks seldom and at random, as on a busy host; the pace changes at any time, in the middle of a
// change too.
TEST(PathFeederTest, AnyChangesAtAnyTimeKeepTheLimitsAndThePath) {
  std::mt19937 random(7);
  const auto below = [&](unsigned n) { return static_cast<int>(random() % n); };
  int refused = 0;
  for (int round = 0; round < 12; ++round) {
    SCOPED_TRACE(round);
    const bool zigzag = round % 2 == 1;
    const double scale = std::pow(4.0, -(round % 3));
    const PerAxis<PlanLimits> limits = Limits(0.4, 8.0 * scale, 400.0 * scale * scale);
    const char* const gentle = "{shape: circle, radius_mm: 10, turns: 20, frequency_hz: 0.5}";
    CommandMailbox mailbox(16, 4096);
    PathFeeder feeder(mailbox);
    Consumer consumer(mailbox, 120.0);
    feeder.Begin(Generator(zigzag ? kZigzag : gentle, limits), {round % 4 == 3 ? 0.3 : 1.0, false});
    const std::shared_ptr<const MotionPlan> plan = feeder.path()->generator().plan();
    test::LimitWatch watch(limits, kPeriod_s);
    double time_s = 0.0;
    int until_feed = 0, until_change = 500;
    for (int i = 0; i < 12000 && !consumer.follower().at_end(); ++i) {
      if (--until_feed <= 0) {
        feeder.Feed();
        until_feed = 1 + below(60);
      }
      if (--until_change == 0) {
        const double rates[] = {0.0, 1.0, 0.1, 0.5, 1.0};
        feeder.SetPace(rates[below(5)]);
        until_change = 1 + below(700);
      }
      consumer.Tick(i / 100 % 2 == 0);
      refused += consumer.follower().progress().refused_law != 0 ? 1 : 0;
      ASSERT_GE(consumer.follower().program_place().time_s, time_s);
      time_s = consumer.follower().program_place().time_s;
      const PerAxis<ReferencePoint> now = consumer.Now();
      watch.Add(now);
      // The very place of the program at that time.
      PerAxis<ReferencePoint> own;
      plan->At(std::min(time_s, plan->duration_s()), own);
      for (std::size_t a = 0; a < 2; ++a) ASSERT_NEAR(now[a].position_m, own[a].position_m, 1e-12) << i;
    }
    EXPECT_GT(time_s, 0.5);
    EXPECT_EQ(consumer.dry(), 0);
    watch.ExpectKept();
  }
  EXPECT_GT(refused, 0) << "the test shall see laws that come too late";
}

TEST(PathFeederTest, SingleBlockRestsAtTheEndOfEveryLineUntilItIsResumed) {
  const PerAxis<PlanLimits> limits = Limits(0.25, 5.0, 200.0);
  const char* const text = "G21 G61.1 F3000\nG1 X5\nG1 Y0.05\nG3 X5 Y10 J4.975\nG1 X40\n";
  CommandMailbox mailbox(16, 4096);
  PathFeeder feeder(mailbox);
  Consumer consumer(mailbox, 75.0);
  feeder.Begin(Generator(text, limits, ProgramFormat::kGcode), {1.0, true});
  test::LimitWatch watch(limits, kPeriod_s);
  const auto run = [&](int cycles) {
    for (int i = 0; i < cycles && !consumer.follower().at_end(); ++i) {
      feeder.Feed();
      consumer.Tick();
      watch.Add(consumer.Now());
    }
  };
  const double ends[][2] = {{5e-3, 0.0}, {5e-3, 0.05e-3}, {5e-3, 10e-3}};
  for (const double* end : ends) {
    run(2000);
    EXPECT_EQ(consumer.follower().program_place().pace, 0.0);
    EXPECT_NEAR(consumer.Now()[0].position_m, end[0], 1e-9);
    EXPECT_NEAR(consumer.Now()[1].position_m, end[1], 1e-9);
    // Another feed is no reason to go on.
    feeder.SetPace(0.5);
    run(500);
    EXPECT_NEAR(consumer.Now()[0].position_m, end[0], 1e-9);
    feeder.SetPace(1.0, true);
  }
  run(400);
  // In the middle of the last line, which is long, a pause is a pause.
  feeder.SetPace(0.0);
  run(1000);
  EXPECT_EQ(consumer.follower().program_place().pace, 0.0);
  EXPECT_LT(consumer.Now()[0].position_m, 39e-3);
  feeder.SetPace(1.0, true);
  run(4000);
  EXPECT_TRUE(consumer.follower().at_end());
  EXPECT_NEAR(consumer.follower().program_place().time_s, feeder.path()->generator().duration_s(), 2e-3);
  EXPECT_EQ(consumer.dry(), 0);
  watch.ExpectKept();
}

TEST(PathFeederTest, AProgramThatEndsFirstEndsAsItWouldHave) {
  const PerAxis<PlanLimits> limits = Limits(0.25, 5.0, 200.0);
  CommandMailbox mailbox(16, 4096);
  PathFeeder feeder(mailbox);
  Consumer consumer(mailbox, 75.0);
  feeder.Begin(Generator("{shape: line, dx_mm: 5, feed_mm_min: 3000}", limits));
  while (consumer.follower().program_place().time_s < 0.1) {
    feeder.Feed();
    consumer.Tick();
  }
  feeder.SetPace(0.0);
  for (int i = 0; i < 1000 && !consumer.follower().at_end(); ++i) {
    feeder.Feed();
    consumer.Tick();
  }
  EXPECT_TRUE(consumer.follower().at_end());
  EXPECT_TRUE(feeder.settled());
}

}  // namespace
}  // namespace contour
