#include "analysis/diagnosis/decision/choose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "analysis/diagnosis/decision/held_out.h"
#include "tests/analysis/diagnosis/decision/unknown_torque.h"

namespace contour::diagnosis {
namespace {

class ChooseTest : public test::UnknownTorque {
 protected:
  ScoreThreshold threshold_{.flips = 20.0, .calibrated = 20.0};
};

TEST_F(ChooseTest, TheBestOneThatHoldsStaysInFront) {
  std::vector<Hypothesis> hypotheses = {Of("constant_torque"), Of("cable_spring")};
  const Choice choice = ChooseFirst(axis_.problem, axis_.base, threshold_, hypotheses);
  EXPECT_TRUE(choice.found);
  EXPECT_EQ(hypotheses[0].effect().kind, "constant_torque");
  EXPECT_FALSE(hypotheses[0].refused);
  EXPECT_GT(choice.tested, 20.0);
}

TEST_F(ChooseTest, WhereTheBestDoesNotHoldTheNextGoesToTheFront) {
  // Its score is made up: the score test at its own place promises next to nothing of it.
  Hypothesis boasting = Of("friction_drift");
  const Hypothesis there = Of("constant_torque");
  boasting.score = 250.0;
  ASSERT_GT(there.score, 100.0);
  std::vector<Hypothesis> hypotheses = {boasting, there};
  const Choice choice = ChooseFirst(axis_.problem, axis_.base, threshold_, hypotheses);
  ASSERT_TRUE(choice.found);
  EXPECT_EQ(hypotheses[0].effect().kind, "constant_torque");
  EXPECT_TRUE(hypotheses[1].refused);
}

TEST_F(ChooseTest, ANumberThatTheRefusedBestMovesIsNotNamedForIt) {
  Hypothesis best = Of("constant_torque");
  Hypothesis number = Of("input_delay");
  // Made up: a score that would hold, but with the torque in the model nothing of it is left.
  number.score = 60.0;
  best.score = 100.0 * number.score;
  // So much of its kind is left by what is known already that the best cannot hold.
  threshold_.accepted = 1;
  threshold_.leakage_of_kind = {{"constant_torque", 1e9}};
  std::vector<Hypothesis> hypotheses = {best, number};
  EXPECT_FALSE(ChooseFirst(axis_.problem, axis_.base, threshold_, hypotheses).found);
  EXPECT_TRUE(hypotheses[0].refused);
}

TEST_F(ChooseTest, FarBehindARefusedBestHoldsWhatIsStillThereWithItInTheModel) {
  const test::FittedAxis axis({{"cable_spring", 0.5, 0.0, 0.0, 0.0}});
  const auto hypothesis = [&](const SharedEffect& effect) {
    Hypothesis h{axis.With(effect)};
    h.score = axis.base.cost - h.fit.cost - Penalty(h.effect());
    return h;
  };
  const Hypothesis there = hypothesis(axis.Of("cable_spring"));
  Hypothesis best = hypothesis(axis.Of("friction_drift"));
  // Made up: a score that hides the other one, of a kind that cannot hold.
  best.score = 100.0 * there.score;
  threshold_.accepted = 1;
  threshold_.leakage_of_kind = {{"friction_drift", 1e9}};
  std::vector<Hypothesis> hypotheses = {best, there};
  ASSERT_TRUE(ChooseFirst(axis.problem, axis.base, threshold_, hypotheses).found);
  EXPECT_EQ(hypotheses[0].effect().kind, "cable_spring");
  EXPECT_TRUE(hypotheses[1].refused);
}

TEST_F(ChooseTest, FarBehindARefusedBestNothingHoldsThatIsTheSame) {
  Hypothesis best = Of("constant_torque");
  const Hypothesis same = Of("asymmetric_coulomb");
  best.score = 100.0 * same.score;
  threshold_.accepted = 1;
  threshold_.leakage_of_kind = {{"constant_torque", 1e9}};
  std::vector<Hypothesis> hypotheses = {best, same};
  EXPECT_FALSE(ChooseFirst(axis_.problem, axis_.base, threshold_, hypotheses).found);
}

TEST_F(ChooseTest, NothingHoldsBelowItsThreshold) {
  threshold_.flips = threshold_.calibrated = 1e9;
  std::vector<Hypothesis> hypotheses = {Of("constant_torque")};
  const Choice choice = ChooseFirst(axis_.problem, axis_.base, threshold_, hypotheses);
  EXPECT_FALSE(choice.found);
  EXPECT_TRUE(hypotheses[0].refused);
}

TEST_F(ChooseTest, AShapeOfTheTimeHoldsWhereTheResidualDependsOnTimeWithoutIt) {
  // The base has what is there in it: its residual is noise, whatever a score says.
  const Hypothesis there = Of("constant_torque");
  Hypothesis shape;
  Point with = there.fit.point;
  with.effects.push_back(axis_.Of("outside:force of time"));
  with.amplitudes.emplace_back(with.effects.back()->steps.size(), 0.0);
  shape.fit = FitPoint(axis_.problem, with, FitEffort{});
  shape.score = 1e4;
  std::vector<Hypothesis> hypotheses = {shape};
  EXPECT_FALSE(ChooseFirst(axis_.problem, there.fit, threshold_, hypotheses).found);
}

TEST_F(ChooseTest, AShapeThatForeseesNothingIsNotBeyondDoubt) {
  // Made up: every block of the residual is smaller with it, but the shape moves nothing.
  const Hypothesis there = Of("constant_torque");
  Hypothesis shape;
  Point with = there.fit.point;
  auto effect = std::make_shared<Effect>(*axis_.Of("cable_spring")->shorter);
  effect->kind = "outside:friction of time";
  effect->force.clear();
  with.effects.push_back(effect);
  with.amplitudes.push_back({0.0});
  shape.fit = FitPoint(axis_.problem, with, FitEffort{});
  shape.score = 1e4;
  Fit current = there.fit;
  for (double& r : current.residual) r *= 1.1;
  ASSERT_GT(Consistency(axis_.problem, current, shape.fit, LeftOut::kBlock), 1.5);
  std::vector<Hypothesis> hypotheses = {shape};
  EXPECT_FALSE(ChooseFirst(axis_.problem, current, threshold_, hypotheses).found);
}

// Before: a force of time, which has the constant in it, made a constant torque something unexplained.
TEST_F(ChooseTest, AShapeOfTheTimeTakesNoPlaceOfACauseThatForeseesAsMuch) {
  const Hypothesis there = Of("constant_torque");
  Hypothesis shape = Of("outside:force of time");
  shape.score = 2.0 * there.score;
  std::vector<Hypothesis> hypotheses = {shape};
  EXPECT_TRUE(ChooseFirst(axis_.problem, axis_.base, threshold_, hypotheses).found) << "alone it holds";
  hypotheses = {shape, there};
  ASSERT_TRUE(ChooseFirst(axis_.problem, axis_.base, threshold_, hypotheses).found);
  EXPECT_EQ(hypotheses[0].effect().kind, "constant_torque");
  EXPECT_TRUE(hypotheses[1].refused);
}

/// Whether a pitch error that moves no reading of the scale holds, in a log of this length. Made up: whatever
/// its score, and that the rows of this share of the log are smaller with it.
bool HoldsWhereItMovesNothing(double duration_s, bool places_come_again, double share,
                              const ScoreThreshold& threshold) {
  test::HiddenOptions options = test::FittedAxis::Short({{"constant_torque", 0.3, 0.0, 0.0, 0.0}});
  options.scale = true;
  options.duration_s = duration_s;
  const test::FittedAxis axis(options);
  EXPECT_EQ(FoldsShareTheStroke(axis.problem), places_come_again);
  const Fit there = axis.With(axis.Of("constant_torque"));
  Hypothesis shape;
  Point with = there.point;
  auto effect = std::make_shared<Effect>(*axis.Of("cable_spring")->shorter);
  effect->kind = "pitch_error";
  effect->force.clear();
  with.effects.push_back(effect);
  with.amplitudes.push_back({0.0});
  shape.fit = FitPoint(axis.problem, with, FitEffort{});
  shape.score = 1e4;
  Fit current = there;
  for (std::size_t k = 0; k < current.residual.size(); ++k)
    if (static_cast<double>(k % axis.problem.rows()) < share * static_cast<double>(axis.problem.rows()))
      current.residual[k] *= 1.1;
  std::vector<Hypothesis> hypotheses = {shape};
  return ChooseFirst(axis.problem, current, threshold, hypotheses).found;
}

TEST_F(ChooseTest, NorIsAShapeOnTheScaleThatForeseesNothingWherePlacesComeAgain) {
  EXPECT_FALSE(HoldsWhereItMovesNothing(30.0, true, 0.1, threshold_)) << "a scale wanders";
  // Of a log that comes nowhere twice nothing can be foreseen: its score decides.
  EXPECT_TRUE(HoldsWhereItMovesNothing(8.0, false, 0.1, threshold_));
  // Before: an error smaller than what the scale wanders by was nothing.
  EXPECT_TRUE(HoldsWhereItMovesNothing(30.0, true, 1.0, threshold_)) << "foreseen by rows all over the log";
}

TEST_F(ChooseTest, APitchErrorThatIsThereHolds) {
  test::HiddenOptions options = test::FittedAxis::Short({{"pitch_error", 3.0, 0.0, 0.0, 0.0}});
  options.scale = true;
  const test::FittedAxis axis(options);
  Hypothesis h{axis.With(axis.Of("pitch_error"))};
  h.score = axis.base.cost - h.fit.cost - Penalty(h.effect());
  std::vector<Hypothesis> hypotheses = {h};
  EXPECT_TRUE(ChooseFirst(axis.problem, axis.base, threshold_, hypotheses).found);
}

TEST_F(ChooseTest, WhatWasGivenUpIsNotAsked) {
  std::vector<Hypothesis> hypotheses = {Of("constant_torque")};
  hypotheses[0].given_up = true;
  EXPECT_FALSE(ChooseFirst(axis_.problem, axis_.base, threshold_, hypotheses).found);
  EXPECT_FALSE(hypotheses[0].refused);
}

TEST_F(ChooseTest, ResidualLeakageIsAskedForOnceSomethingIsAccepted) {
  const Hypothesis spring = Of("cable_spring");
  const double alone = Asked(axis_.problem, spring, threshold_);
  threshold_.accepted = 1;
  threshold_.leakage = 300.0;
  const double overdispersion = OverdispersionOfLast(axis_.problem, spring.fit);
  EXPECT_NEAR(Asked(axis_.problem, spring, threshold_), alone + 300.0 / overdispersion, 1e-6);
}

TEST_F(ChooseTest, WhatIsInTheModelExplainsNothingElse) {
  const Hypothesis there = Of("constant_torque");
  EXPECT_TRUE(ExplainsSomethingElse(axis_.problem, axis_.base, [&] {
    // A spring that is there in addition to nothing goes on being there in addition to the base.
    Hypothesis spring = Of("cable_spring");
    spring.score = ScoreEffects(axis_.problem, axis_.base, {spring.fit.point.effects.back()})[0].drop -
                   Penalty(spring.effect());
    return spring;
  }()));
  Hypothesis far = Of("cable_spring");
  far.score = 1e6;
  EXPECT_FALSE(ExplainsSomethingElse(axis_.problem, there.fit, far)) << "nothing of it is left";
}

}  // namespace
}  // namespace contour::diagnosis
