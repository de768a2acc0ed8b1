#include "analysis/diagnosis/decision/accepted.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "tests/analysis/diagnosis/decision/unknown_torque.h"

namespace contour::diagnosis {
namespace {

class AcceptedTest : public test::UnknownTorque {
 protected:
  AcceptedTest() {
    accepted_.fit = axis_.base;
    for (const char* kind : {"cable_spring", "constant_torque"})
      out_.candidates.push_back({kind, 1.0, std::numeric_limits<double>::quiet_NaN(), false});
  }

  ScoreThreshold threshold_{.flips = 20.0, .calibrated = 20.0};
  Accepted accepted_;
  Diagnosis out_;
};

TEST_F(AcceptedTest, TheFirstBecomesACauseWithItsEvidenceAndItsExperiment) {
  const Hypothesis first = Of("constant_torque");
  AcceptFirst(axis_.problem, {first}, threshold_, accepted_, out_);
  ASSERT_EQ(out_.causes.size(), 1u);
  const Cause& cause = out_.causes[0];
  EXPECT_EQ(cause.kind, "constant_torque");
  EXPECT_NEAR(cause.log_evidence_gain, 0.5 * first.score, 1e-9);
  EXPECT_NE(cause.deciding_program.find("torque_steps"), std::string::npos);
  EXPECT_GT(cause.heldout_rms_before, cause.heldout_rms_after);
  EXPECT_TRUE(cause.indistinguishable_from.empty());
  EXPECT_FALSE(out_.blocks.empty());
  EXPECT_TRUE(std::isnan(out_.candidates[0].refitted));
  EXPECT_EQ(out_.candidates[1].refitted, first.score);
  EXPECT_TRUE(out_.candidates[1].accepted);
}

TEST_F(AcceptedTest, ItIsInTheModelFromThenOn) {
  const Hypothesis first = Of("constant_torque");
  AcceptFirst(axis_.problem, {first}, threshold_, accepted_, out_);
  EXPECT_EQ(accepted_.fit.point.effects.back(), first.fit.point.effects.back());
  EXPECT_EQ(accepted_.places, (std::vector<std::size_t>{0}));
  ASSERT_EQ(accepted_.scatter.size(), 1u);
  EXPECT_GE(accepted_.scatter[0], 1.0);
  EXPECT_NEAR(accepted_.explained, first.score, 1e-9);
  EXPECT_GT(accepted_.leakage, 0.0);
  EXPECT_LT(accepted_.leakage, 0.1 * first.score);
  EXPECT_EQ(accepted_.in_presliding, 0.0);
  // What it leaves is asked of the next one.
  const ScoreThreshold next = ScoreThresholdOf(axis_.problem, accepted_, {}, 0.0, {});
  EXPECT_EQ(next.accepted, 1);
  EXPECT_NEAR(next.leakage, accepted_.leakage, 1e-9);
}

TEST_F(AcceptedTest, WhatExplainsTheSameAsWellCannotBeToldFromIt) {
  const Hypothesis first = Of("constant_torque");
  // The same signal by another name.
  auto twin = std::make_shared<Effect>(*first.fit.point.effects.back());
  twin->kind = "cable_spring";
  Hypothesis second = first;
  second.fit.point.effects.back() = twin;
  second.score = first.score - 1.0;
  AcceptFirst(axis_.problem, {first, second}, threshold_, accepted_, out_);
  EXPECT_EQ(out_.causes[0].indistinguishable_from, (std::vector<std::string>{"cable_spring"}));
  EXPECT_EQ(out_.candidates[0].refitted, second.score);
  EXPECT_FALSE(out_.candidates[0].accepted);
}

TEST_F(AcceptedTest, WhatWasRefusedOrExplainsTooLittleIsNoAlternative) {
  const Hypothesis first = Of("constant_torque");
  Hypothesis refused = first, little = first;
  auto twin = std::make_shared<Effect>(*first.fit.point.effects.back());
  twin->kind = "cable_spring";
  refused.fit.point.effects.back() = little.fit.point.effects.back() = twin;
  refused.refused = true;
  little.score = 5.0;
  AcceptFirst(axis_.problem, {first, refused, little}, threshold_, accepted_, out_);
  EXPECT_TRUE(out_.causes[0].indistinguishable_from.empty());
}

TEST_F(AcceptedTest, WhatSlidesAlikeAndExplainsMoreIsAnAlternativeThoughRefused) {
  const Hypothesis first = Of("constant_torque");
  Hypothesis refused = first;
  auto twin = std::make_shared<Effect>(*first.fit.point.effects.back());
  twin->kind = "asymmetric_coulomb";
  refused.fit.point.effects.back() = twin;
  refused.refused = true;
  refused.score = first.score + 1.0;
  AcceptFirst(axis_.problem, {first, refused}, threshold_, accepted_, out_);
  EXPECT_EQ(out_.causes[0].indistinguishable_from, (std::vector<std::string>{"asymmetric_coulomb"}));
  refused.score = first.score - 1.0;
  out_.causes.clear();
  AcceptFirst(axis_.problem, {first, refused}, threshold_, accepted_, out_);
  EXPECT_TRUE(out_.causes[0].indistinguishable_from.empty());
}

TEST_F(AcceptedTest, WhatSlidesAlikeIsToldApartByABristleThatShowsAlone) {
  const Hypothesis first = Of("constant_torque");
  const StatedFriction& f = axis_.problem.nominal.friction;
  axis_.made.axis.stated.position_step = f.Fc_plus / f.s0;
  AcceptFirst(axis_.problem, {first}, threshold_, accepted_, out_);
  EXPECT_EQ(out_.causes[0].indistinguishable_from, (std::vector<std::string>{"asymmetric_coulomb"}));
}

TEST_F(AcceptedTest, AnElementInPreslidingIsRememberedForALawThatDoesNotHold) {
  AcceptFirst(axis_.problem, {Of("presliding_hysteresis")}, threshold_, accepted_, out_);
  EXPECT_EQ(accepted_.in_presliding, accepted_.explained);
  accepted_.in_presliding = 1e4;
  const double before = ScoreThresholdOf(axis_.problem, accepted_, {}, 0.0, {}).leakage;
  for (std::size_t i = 0; i < axis_.problem.terms.size(); ++i)
    if (axis_.problem.terms[i].name == "rough")
      accepted_.fit.point.base[i] = -10.0 * axis_.problem.terms[i].sigma;
  EXPECT_GT(ScoreThresholdOf(axis_.problem, accepted_, {}, 0.0, {}).leakage, before + 50.0);
}

TEST_F(AcceptedTest, ExtensionsThatTheModelHasMayBeALittleOff) {
  const double none = ScoreThresholdOf(axis_.problem, accepted_, {}, 0.0, {}).flips;
  EXPECT_GT(ScoreThresholdOf(axis_.problem, accepted_, {}, 1e5, {}).flips, none);
}

}  // namespace
}  // namespace contour::diagnosis
