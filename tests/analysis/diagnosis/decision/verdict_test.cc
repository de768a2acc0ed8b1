#include "analysis/diagnosis/decision/verdict.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

constexpr double kThreshold = 15.0;

class VerdictTest : public testing::Test {
 protected:
  static test::HiddenOptions Short() {
    test::HiddenOptions o;
    o.duration_s = 5.0;
    return o;
  }

  static RemainingStructure Of(const std::string& over, double beyond) {
    RemainingStructure one;
    one.over = over;
    one.quantity = Quantity::kPosition;
    one.bins = 90.0;
    one.drop = 90.0 + beyond;
    one.score = beyond;
    one.asked = kThreshold;
    one.at = "12 mm, moving up";
    return one;
  }

  static Diagnosis Named(const std::vector<std::pair<std::string, double>>& causes) {
    Diagnosis d;
    for (const auto& [kind, score] : causes) {
      Cause c;
      c.kind = kind;
      c.log_evidence_gain = 0.5 * score;
      d.causes.push_back(c);
      d.candidates.push_back({kind, score, score, true});
    }
    return d;
  }

  Diagnosis Concluded(Diagnosis d, const std::vector<RemainingStructure>& left) const {
    Conclude(problem_, left, d);
    return d;
  }

  test::HiddenAxis axis_ = test::MakeHiddenAxis(Short());
  Problem problem_{axis_.log, axis_.stated, 1};
};

TEST_F(VerdictTest, NothingIsFoundWhereNothingIsLeft) {
  const Diagnosis d = Concluded({}, {Of("time", 5.0)});
  EXPECT_EQ(d.verdict, Verdict::kNothingFound);
  EXPECT_TRUE(d.notes.empty());
}

/// Before: nothing was found, though a cause explained far more than chance.
TEST_F(VerdictTest, WhatDoesHarmUnseenIsNoCauseAndNotNothing) {
  Diagnosis found = Named({{"viscous_nonlinear", 600.0}});
  found.causes[0].heldout_gain_high = -0.2;
  const Diagnosis d = Concluded(found, {Of("time", 5.0)});
  EXPECT_EQ(d.verdict, Verdict::kUnexplained);
  EXPECT_TRUE(d.causes.empty());
  ASSERT_EQ(d.notes.size(), 1u);
  EXPECT_NE(d.notes[0].find("viscous_nonlinear"), std::string::npos);
  Diagnosis beside = Named({{"cogging", 900.0}, {"viscous_nonlinear", 600.0}});
  beside.causes[1].heldout_gain_high = -0.2;
  const Diagnosis named = Concluded(beside, {Of("time", 5.0)});
  EXPECT_EQ(named.verdict, Verdict::kCauseFound);
  EXPECT_TRUE(named.notes.empty());
}

/// Before: a Fs/Fc of 5 (0.2 to 5.1) was the name of what a sound axis without a stated bristle left.
TEST_F(VerdictTest, WhatHasNoSizeIsNoName) {
  Diagnosis found = Named({{"stribeck", 1100.0}, {"input_delay", 130.0}});
  found.causes[0].no_size = true;
  const Diagnosis d = Concluded(found, {Of("time", 5.0)});
  EXPECT_EQ(d.verdict, Verdict::kUnexplained);
  ASSERT_EQ(d.causes.size(), 1u);
  EXPECT_TRUE(d.causes[0].part_of_it);
  ASSERT_FALSE(d.notes.empty());
  EXPECT_NE(d.notes[0].find("stribeck"), std::string::npos);
  // Next to a cause that explains far more it takes no name away.
  Diagnosis little = Named({{"input_delay", 29000.0}, {"stribeck", 870.0}});
  little.causes[1].no_size = true;
  const Diagnosis named = Concluded(little, {Of("time", 5.0)});
  EXPECT_EQ(named.verdict, Verdict::kCauseFound);
  ASSERT_EQ(named.causes.size(), 1u);
  EXPECT_TRUE(named.candidates[0].accepted);
  EXPECT_FALSE(named.candidates[1].accepted);
}

/// Before: a motor that gives three quarters of its torque was not told at all, beside a wrong pitch error.
TEST_F(VerdictTest, AFactorOnAllForcesHarmsNothing) {
  Diagnosis found = Named({{"torque_constant", 600.0}, {"cogging", 100.0}});
  found.causes[0].heldout_gain_high = -0.001;
  const Diagnosis d = Concluded(found, {Of("time", 5.0)});
  ASSERT_EQ(d.causes.size(), 2u);
  EXPECT_EQ(d.causes[0].kind, "torque_constant");
}

TEST_F(VerdictTest, WhatIsLeftWithoutACauseIsUnexplained) {
  const Diagnosis d = Concluded({}, {Of("the position and the direction", 40.0)});
  EXPECT_EQ(d.verdict, Verdict::kUnexplained);
  ASSERT_EQ(d.notes.size(), 1u);
  EXPECT_NE(d.notes[0].find("the position and the direction"), std::string::npos);
  EXPECT_NE(d.notes[0].find("12 mm, moving up"), std::string::npos);
}

TEST_F(VerdictTest, ACauseKeepsItsNameWhenLittleIsLeft) {
  const Diagnosis d = Concluded(Named({{"cogging", 20000.0}}), {Of("time", 100.0)});
  EXPECT_EQ(d.verdict, Verdict::kCauseFound);
  ASSERT_EQ(d.causes.size(), 1u);
  EXPECT_TRUE(d.candidates[0].accepted);
  EXPECT_EQ(d.notes.size(), 1u);  // that something small is left
}

TEST_F(VerdictTest, ACauseThatLeavesATenthLosesIt) {
  const Diagnosis d = Concluded(Named({{"presliding_hysteresis", 6000.0}, {"cable_spring", 500.0}}),
                                {Of("time", 900.0), Of("the speed", 4.0)});
  EXPECT_EQ(d.verdict, Verdict::kUnexplained);
  ASSERT_EQ(d.causes.size(), 2u) << "told with size and gain";
  for (const Cause& c : d.causes) EXPECT_TRUE(c.part_of_it) << c.kind;
  EXPECT_FALSE(d.candidates[0].accepted);
  EXPECT_NE(d.notes.back().find("presliding_hysteresis, cable_spring"), std::string::npos);
}

TEST_F(VerdictTest, ATorqueMakesAnErrorOfTheLeadNoLessTrueUnlessItIsLarge) {
  const Diagnosis concluded = Concluded(Named({{"pitch_error", 9000.0}}), {Of("time", 900.0)});
  EXPECT_EQ(concluded.verdict, Verdict::kCauseFound);
  EXPECT_EQ(concluded.causes.size(), 1u);
  const Diagnosis large =
      Concluded(Named({{"pitch_error", 3400.0}, {"outside:force of time", 7000.0}}), {Of("time", 180.0)});
  EXPECT_EQ(large.verdict, Verdict::kUnexplained);
}

TEST_F(VerdictTest, WhatDoesHarmOnUnseenDataIsNotTold) {
  Diagnosis found = Named({{"encoder_eccentricity", 400.0}});
  found.causes[0].heldout_gain_low = -9.0;
  found.causes[0].heldout_gain_high = -7.0;
  const Diagnosis d = Concluded(found, {Of("time", 5.0)});
  EXPECT_TRUE(d.causes.empty());
  EXPECT_EQ(d.verdict, Verdict::kUnexplained);
  found.causes[0].heldout_gain_high = 0.01;
  EXPECT_EQ(Concluded(found, {Of("time", 5.0)}).causes.size(), 1u) << "not beyond its interval";
}

TEST_F(VerdictTest, WhatIsFoundIsNotListedAsNotExcited) {
  Diagnosis found = Named({{"backlash", 400.0}});
  found.not_excited = {"backlash", "cross_coupling"};
  EXPECT_EQ(Concluded(found, {Of("time", 5.0)}).not_excited, (std::vector<std::string>{"cross_coupling"}));
}

TEST_F(VerdictTest, FurtherOrdersOfATurnMakeNoNameWrong) {
  RemainingStructure angle = Of("the angle of the motor and the direction", 1200.0);
  angle.series = true;
  EXPECT_EQ(Concluded(Named({{"cogging", 8000.0}}), {angle, Of("time", 80.0)}).verdict, Verdict::kCauseFound);
  EXPECT_EQ(Concluded({}, {angle}).verdict, Verdict::kUnexplained);
}

TEST_F(VerdictTest, AShapeOutsideTheCatalogueIsNoExplanation) {
  const Diagnosis much = Concluded(Named({{"friction_drift", 34000.0}, {"outside:friction of time", 9000.0}}),
                                   {Of("time", 5.0)});
  EXPECT_EQ(much.verdict, Verdict::kUnexplained);
  ASSERT_EQ(much.causes.size(), 1u) << "the shape itself is no cause";
  EXPECT_TRUE(much.causes[0].part_of_it);
  const Diagnosis little =
      Concluded(Named({{"friction_drift", 34000.0}, {"outside:friction of time", 90.0}}), {Of("time", 5.0)});
  EXPECT_EQ(little.verdict, Verdict::kCauseFound);
  ASSERT_EQ(little.causes.size(), 1u);
  EXPECT_EQ(little.causes[0].kind, "friction_drift");
}

}  // namespace
}  // namespace contour::diagnosis
