#include "daemon/rt/late_attribution.h"

#include <gtest/gtest.h>

namespace contour {
namespace {

constexpr std::int64_t kUs = 1000;
constexpr LatenessLimits kLimits{200 * kUs, 50'000 * kUs};

/// A cycle of 20 us wake-up and 10, 20, 30, 10, 10 us of work.
CycleTiming Ordinary() {
  CycleTiming t;
  t.wakeup_late_ns = 20 * kUs;
  t.received_ns = 30 * kUs;
  t.estimated_ns = 50 * kUs;
  t.decided_ns = 80 * kUs;
  t.stepped_ns = 90 * kUs;
  t.sent_ns = 100 * kUs;
  return t;
}

/// The same with this much more from one stage on.
CycleTiming Delayed(std::int64_t CycleTiming::*from, std::int64_t delay_ns) {
  CycleTiming t = Ordinary();
  bool later = false;
  for (auto stage : {&CycleTiming::wakeup_late_ns, &CycleTiming::received_ns, &CycleTiming::estimated_ns,
                     &CycleTiming::decided_ns, &CycleTiming::stepped_ns, &CycleTiming::sent_ns}) {
    later = later || stage == from;
    if (later) t.*stage += delay_ns;
  }
  return t;
}

LateCause CauseOf(const CycleTiming& t, LateCause before = LateCause::kNone, std::int64_t overrun_ns = 0) {
  return FindLateCause(t, {before, overrun_ns, t.voluntary_switches * 4900 * kUs}, kLimits);
}

TEST(LateAttribution, ACycleInTimeHasNoCause) {
  CycleTiming t = Ordinary();
  EXPECT_EQ(CauseOf(t), LateCause::kNone);
  t.page_faults = t.involuntary_switches = t.voluntary_switches = 9;
  t.run_delay_ns = 90 * kUs;
  EXPECT_EQ(CauseOf(t), LateCause::kNone) << "whatever happened, it was in time";
}

TEST(LateAttribution, TheLongestPartIsToBlame) {
  EXPECT_EQ(CauseOf(Delayed(&CycleTiming::wakeup_late_ns, 300 * kUs)), LateCause::kWakeUp);
  EXPECT_EQ(CauseOf(Delayed(&CycleTiming::received_ns, 300 * kUs)), LateCause::kReceive);
  EXPECT_EQ(CauseOf(Delayed(&CycleTiming::estimated_ns, 300 * kUs)), LateCause::kEstimate);
  EXPECT_EQ(CauseOf(Delayed(&CycleTiming::decided_ns, 300 * kUs)), LateCause::kControl);
  EXPECT_EQ(CauseOf(Delayed(&CycleTiming::stepped_ns, 300 * kUs)), LateCause::kControl);
  EXPECT_EQ(CauseOf(Delayed(&CycleTiming::sent_ns, 300 * kUs)), LateCause::kSend);
}

TEST(LateAttribution, WhatHeldAPartUpComesBeforeThePart) {
  CycleTiming t = Delayed(&CycleTiming::decided_ns, 300 * kUs);
  t.page_faults = 40;
  EXPECT_EQ(CauseOf(t), LateCause::kPageFault);
  t.run_delay_ns = 290 * kUs;
  EXPECT_EQ(CauseOf(t), LateCause::kPreempted) << "a few faults do not take as long as another thread did";
  t = Delayed(&CycleTiming::decided_ns, 300 * kUs);
  t.involuntary_switches = 1;
  EXPECT_EQ(CauseOf(t), LateCause::kPreempted) << "a kernel that does not tell how long";
  t.run_delay_ns = 40 * kUs;
  EXPECT_EQ(CauseOf(t), LateCause::kControl) << "not for as long as that";
  t = Delayed(&CycleTiming::decided_ns, 300 * kUs);
  t.voluntary_switches = 1;
  EXPECT_EQ(CauseOf(t), LateCause::kStopped);
  EXPECT_EQ(FindLateCause(t, {LateCause::kNone, 0, 30 * kUs}, kLimits), LateCause::kControl)
      << "it hardly waited";
}

TEST(LateAttribution, ALateWakeUp) {
  CycleTiming t = Delayed(&CycleTiming::wakeup_late_ns, 5000 * kUs);
  t.page_faults = 3;  // of the telemetry before the sleep
  EXPECT_EQ(CauseOf(t), LateCause::kWakeUp) << "a thread that sleeps touches no memory";
  t.voluntary_switches = 1;
  EXPECT_EQ(CauseOf(t), LateCause::kPageFault)
      << "of the code that it wakes up into: the wait is for the page";
  t.page_faults = 0;
  EXPECT_EQ(CauseOf(t), LateCause::kStopped);
  t.run_delay_ns = 4900 * kUs;
  EXPECT_EQ(CauseOf(t), LateCause::kPreempted);
}

TEST(LateAttribution, ThrottlingIsKnownByItsLength) {
  CycleTiming t = Delayed(&CycleTiming::decided_ns, 50'000 * kUs);
  t.run_delay_ns = 49'900 * kUs;
  t.involuntary_switches = 1;
  EXPECT_EQ(CauseOf(t), LateCause::kThrottled);
  EXPECT_EQ(FindLateCause(t, {}, {200 * kUs, 0}), LateCause::kPreempted) << "it is off";
  t = Delayed(&CycleTiming::decided_ns, 20'000 * kUs);
  t.run_delay_ns = 19'900 * kUs;
  EXPECT_EQ(CauseOf(t), LateCause::kPreempted);
}

TEST(LateAttribution, SkippedGridPointsHaveTheCauseOfTheCycleBefore) {
  CycleTiming t = Ordinary();
  t.skipped_grid_points = 3;
  EXPECT_EQ(CauseOf(t, LateCause::kPageFault), LateCause::kPageFault);
  t.after_send_ns = 3000 * kUs;
  EXPECT_EQ(CauseOf(t), LateCause::kAfterSend);
  t.run_delay_ns = 2900 * kUs;
  EXPECT_EQ(CauseOf(t), LateCause::kPreempted);
}

TEST(LateAttribution, ACycleThatBeganLateHasTheCauseOfTheOneThatRanIntoIt) {
  CycleTiming t = Delayed(&CycleTiming::wakeup_late_ns, 300 * kUs);
  EXPECT_EQ(CauseOf(t, LateCause::kPreempted, 300 * kUs), LateCause::kPreempted) << "there was no sleep";
  EXPECT_EQ(CauseOf(t, LateCause::kPreempted, 0), LateCause::kWakeUp) << "it had slept in between";
  EXPECT_EQ(CauseOf(t, LateCause::kNone, 300 * kUs), LateCause::kAfterSend)
      << "the frames before were in time";
  t.sent_ns += 900 * kUs;
  EXPECT_EQ(CauseOf(t, LateCause::kPreempted, 300 * kUs), LateCause::kSend) << "it took longer by itself";
}

}  // namespace
}  // namespace contour
