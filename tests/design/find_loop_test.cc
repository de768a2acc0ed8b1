#include "design/find_loop.h"

#include <gtest/gtest.h>

#include "design/loop_report.h"
#include "tests/design/creeping_axes.h"
#include "tests/design/short_search.h"

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;

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

void ExpectHas(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
}

// The refusal tells of both searches.
TEST(FindLoop, RefusesWhatWouldHuntAtRest) {
  const LoopAxis axis = StiffTable();
  const FoundLoop found = FindLoop(axis, kSlowPeriod_s, kShort);
  const std::string why = WhyRefused(found, ReportOn(axis, found.tuning, kSlowPeriod_s));
  ExpectHas(why, "on the Stribeck slope at ");
  ExpectHas(why, "; and of those whose table may stick and slip where it creeps, ");
}

// Of a loop that keeps its limits but for the slope.
TEST(WhatIsWrong, NamesWhatAnAxisThatCreepsDoesAtRestAndUnderAForce) {
  LoopReport report;
  for (WorstMember& w : report.verdict.worst) w = {"on the slope", true, 1.0, 0.9, 2.0};
  report.verdict.noise_limit = 0.01;
  report.verdict.step = {.peak_m = 10e-6, .mean_m = 1e-6, .rms_m = 1e-6, .left_m = 0.5e-6};
  report.stick_slip = StickSlip{.stop_m = 0.0, .most_stop_m = 10e-6, .rest_m = 1e-6, .most_rest_m = 2e-6};
  EXPECT_EQ(WhatIsWrong(report), "");
  report.stick_slip->stop_m = 11e-6;
  EXPECT_EQ(WhatIsWrong(report),
            "from three seconds after a stop the table still moves by 11.0 um, limit 10.0: on the slope");
  report.stick_slip->stop_m = 9e-6;
  report.stick_slip->rest_m = 3e-6;
  EXPECT_EQ(WhatIsWrong(report), "at rest the table hunts by 3.0 um, limit 2.0: on the slope");
  report.verdict.step.left_m = 2e-6;
  EXPECT_EQ(WhatIsWrong(report),
            "a force is not taken up, after 200 ms the table is still off by 2.0 of 10.0 um: on the slope");
}

TEST(WhatIsWrong, SaysThatALoopOnlyHoldsWhereItsTableHunts) {
  const LoopAxis axis = HeavyTable();
  const LoopReport report = ReportOn(axis, kHoldsOnly, kPeriod_s);
  EXPECT_EQ(WhatIsWrong(report.verdict), "");
  ASSERT_TRUE(report.after_stops);
  EXPECT_TRUE(
      WhatIsWrong(report).starts_with("a force is not taken up, after 200 ms the table is still off by "))
      << WhatIsWrong(report);
  ExpectHas(Describe(report), " um on average over 200 ms, still ");
  const LoopAxis base = AxisOf("t20");
  const LoopReport other = ReportOn(base, FindLoop(base, kPeriod_s, kShort).tuning, kPeriod_s);
  EXPECT_FALSE(other.after_stops);
  ExpectHas(Describe(other), " um on average over 200 ms, a tenth of it left after ");
}

// Under a thousandth of rated torque each.
TEST(Describe, SaysWhereFrictionHoldsTooFewStepsOfTorque) {
  LoopAxis axis = AxisOf("t20");
  const LoopTuning tuning = FindLoop(axis, kPeriod_s, kShort).tuning;
  const std::string held = Describe(ReportOn(axis, tuning, kPeriod_s));
  EXPECT_EQ(held.find("at rest the loop holds"), std::string::npos) << held;
  axis.rated_force_N *= 12.0;
  const std::string text = Describe(ReportOn(axis, tuning, kPeriod_s));
  ExpectHas(text,
            "friction of 39.1 N holds fewer than 5 steps of torque (a thousandth of rated, 9.60 N): at rest "
            "the loop holds");
}

// Of one whose bristles are stiffer than its screw, as on a table of 55 kg that hunted with K 20 % stiffer.
TEST(Describe, SaysHowStiffAScrewMayBeForTheTableToRest) {
  LoopAxis axis = AxisOf("t20");
  LoopReport report;
  report.screw = RestingScrewOf(axis);
  EXPECT_EQ(Describe(report).find("at rest the lead"), std::string::npos) << "soft bristles";
  axis.axis.stiffness_N_m = 40e6;
  axis.friction.sigma0_N_m = 12.0 * 40e6;
  axis.stiffness_std = 0.01;
  report.screw = RestingScrewOf(axis);
  EXPECT_NEAR(report.screw.stable_below_N_m, 40e6 * 12.0 / 11.0, 1.0);
  ExpectHas(Describe(report),
            "at rest the lead by friction over stiffness is stable with a screw of less than "
            "43.64 N/um, 9 % stiffer than stated\n");
  axis.stiffness_std = 0.1;
  report.screw = RestingScrewOf(axis);
  ExpectHas(Describe(report),
            ", 9 % stiffer than stated, and stated is 10 %: if it is that stiff, the table hunts after a "
            "stop; the loop then keeps its torque constant");
  axis.friction.motor_share = 0.5;  // half of the bristles hold the motor
  EXPECT_NEAR(RestingScrewOf(axis).stable_below_N_m, 40e6 * 6.0 / 5.0, 1.0);
  axis.friction.motor_share = 0.95;
  EXPECT_FALSE(std::isfinite(RestingScrewOf(axis).stable_below_N_m)) << "soft bristles on the table";
  axis.friction.motor_share = 0.0;
  axis.scale_step_m = 5e-9;
  EXPECT_FALSE(std::isfinite(RestingScrewOf(axis).stable_below_N_m)) << "the table is measured";
}

// The best within the limits only holds against a force; the next search minds that.
TEST(FindLoop, FindsOneThatTakesAForceUp) {
  const LoopAxis axis = HeavyTable();
  LoopSearchOptions from = kShort;
  from.random_starts = 0;
  from.start = kHoldsOnly;
  EXPECT_FALSE(TakesUp(SearchLoop(axis, kPeriod_s, from).verdict.step));
  const FoundLoop found = FindLoop(axis, kPeriod_s, from);
  const LoopReport report = ReportOn(axis, found.tuning, kPeriod_s);
  EXPECT_EQ(WhatIsWrong(report), "");
  EXPECT_TRUE(TakesUp(found.verdict.step, 0.05)) << found.verdict.step.left_m;
}

TEST(FindLoop, RefusesABelt) {
  const LoopAxis axis = AxisOf("belt");
  const FoundLoop found = FindLoop(axis, kPeriod_s, kShort);
  const std::string why = WhyRefused(found, ReportOn(axis, found.tuning, kPeriod_s));
  ExpectHas(why, "on the Stribeck slope at ");
  ExpectHas(why, "; and of those whose table may stick and slip where it creeps, ");
}

TEST(WhyRefused, IsNothingOfALoopThatWillDo) {
  const LoopAxis axis = AxisOf("t20");
  const FoundLoop found = FindLoop(axis, kPeriod_s, kShort);
  EXPECT_EQ(WhyRefused(found, ReportOn(axis, found.tuning, kPeriod_s)), "");
  EXPECT_EQ(found.wrong_creeping, "");
}

}  // namespace
}  // namespace contour
