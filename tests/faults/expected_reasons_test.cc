#include "tools/faults/expected_reasons.h"

#include <gtest/gtest.h>

#include <set>

namespace contour::faults {
namespace {

TEST(ExpectedReasons, EveryFaultHasARowOfItsOwnAndAName) {
  std::set<std::string_view> names;
  for (const FaultName& f : kFaults) {
    EXPECT_EQ(ExpectationOf(f.fault).fault, f.fault);
    names.insert(f.name);
  }
  EXPECT_EQ(names.size(), kFaultCount);
}

TEST(ExpectedReasons, WhatStopsHasAFaultAsItsReasonAndWhatGoesOnHasNone) {
  for (const FaultName& f : kFaults) {
    const Expectation& row = ExpectationOf(f.fault);
    if (row.moving == Outcome::kGoesOn) {
      EXPECT_EQ(row.reasons[0], Reason::kNone) << f.name;
    } else {
      EXPECT_TRUE(IsFault(row.reasons[0])) << f.name;
      EXPECT_TRUE(row.reasons[1] == Reason::kNone || IsFault(row.reasons[1])) << f.name;
    }
    EXPECT_TRUE(row.warning == Reason::kNone || IsLimit(row.warning)) << f.name;
  }
}

TEST(ExpectedReasons, NoReasonMeansNothingIsAllowed) {
  const ExpectedHere here = ExpectedIn(Fault::kHeartbeatsLost, Phase::kConstant);
  EXPECT_TRUE(here.Allows(Reason::kHeartbeatLost));
  EXPECT_FALSE(here.Allows(Reason::kNone)) << "a row with one reason has an empty second place";
  EXPECT_FALSE(here.Allows(Reason::kFollowingError));
}

TEST(ExpectedReasons, AtACrawlTorqueThatIsLostSilentlyIsNotToldFromAnEncoderThatStands) {
  EXPECT_FALSE(ExpectedIn(Fault::kTorqueLostSilently, Phase::kConstant).Allows(Reason::kFeedbackFrozen));
  const ExpectedHere crawl = ExpectedIn(Fault::kTorqueLostSilently, Phase::kConstant, true);
  EXPECT_TRUE(crawl.Allows(Reason::kFeedbackFrozen));
  EXPECT_FALSE(crawl.Allows(Reason::kFollowingError));
  EXPECT_FALSE(ExpectedIn(Fault::kTorqueLost, Phase::kConstant, true).Allows(Reason::kFeedbackFrozen));
}

TEST(ExpectedReasons, WithoutTorqueNothingHasToStop) {
  for (const FaultName& f : kFaults)
    for (const Phase p : kPhases)
      if (!Holds(p)) {
        EXPECT_NE(ExpectedIn(f.fault, p).outcome, Outcome::kStops) << f.name << " " << Name(p);
      }
}

}  // namespace
}  // namespace contour::faults
