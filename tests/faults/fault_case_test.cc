#include "tools/faults/fault_case.h"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

namespace contour::faults {
namespace {

const std::vector<PlannedAxis> kAxes{{"x", 250.0}, {"y", 300.0}};

std::string Whole(const FaultCase& c) { return Key(c) + " " + std::to_string(c.feed_mm_s); }

TEST(FaultPlan, CoversEveryFaultPhaseModeAndBand) {
  PlanRequest request;
  request.runs = 6000;  // more than there are combinations
  std::set<std::string> seen;
  std::set<std::size_t> bands;
  for (const FaultCase& c : Plan(request, kAxes)) {
    seen.insert(std::string(Name(c.fault)) + std::string(Name(c.phase)) + std::string(Name(c.mode)));
    EXPECT_GE(c.feed_mm_s, kLowestFeed_mm_s);
    EXPECT_LE(c.feed_mm_s, kAxes[c.axis].velocity_mm_s);
    if (Moves(c.phase)) bands.insert(BandOf(c.feed_mm_s, kAxes[c.axis].velocity_mm_s));
  }
  std::size_t planned = 0;
  for (const FaultName& f : kFaults)
    if (IsPlanned(f.fault)) ++planned;
  EXPECT_GE(planned, 44U);
  EXPECT_EQ(seen.size(), planned * kPhases.size() * 2);
  EXPECT_EQ(bands.size(), kFeedBands);
}

TEST(FaultPlan, WhatOnlyShowsASupervisorComesWhenItIsNamed) {
  PlanRequest request;
  request.runs = 50;
  request.only = {"cycles_late"};
  for (const FaultCase& c : Plan(request, kAxes)) EXPECT_EQ(c.fault, Fault::kCyclesLate);
}

TEST(FaultPlan, ShardsTogetherAreTheWhole) {
  PlanRequest whole;
  whole.runs = 500;
  std::multiset<std::string> all;
  for (const FaultCase& c : Plan(whole, kAxes)) all.insert(Whole(c));
  std::multiset<std::string> parts;
  for (int i = 0; i < 3; ++i) {
    PlanRequest part = whole;
    part.shard = i;
    part.shards = 3;
    for (const FaultCase& c : Plan(part, kAxes)) parts.insert(Whole(c));
  }
  EXPECT_EQ(all, parts);
}

TEST(FaultPlan, ARunIsRepeatedByItsKeyAndFeed) {
  PlanRequest request;
  request.runs = 50;
  request.seed = 7;
  for (const FaultCase& c : Plan(request, kAxes)) {
    PlanRequest again;
    again.runs = 1;
    again.seed = 7;
    again.feed_mm_s = c.feed_mm_s;
    again.only = {std::string(Name(c.fault)), std::string(Name(c.phase)), std::string(Name(c.mode)),
                  c.axis_name};
    const std::vector<FaultCase> one = Plan(again, kAxes);
    ASSERT_EQ(one.size(), 1U);
    EXPECT_EQ(Whole(one[0]), Whole(c));
    EXPECT_EQ(SeedOf(one[0], 7), SeedOf(c, 7));
    EXPECT_NE(SeedOf(one[0], 8), SeedOf(c, 7));
  }
}

TEST(FaultPlan, RefusesNamesThatAreNone) {
  PlanRequest request;
  request.only = {"encoder_frozen", "no_such_thing"};
  EXPECT_THROW(Plan(request, kAxes), std::invalid_argument);
}

}  // namespace
}  // namespace contour::faults
