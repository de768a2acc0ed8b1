#include "analysis/diagnosis/decision/guesses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/analysis/support/fitted_axis.h"

namespace contour::diagnosis {
namespace {

class GuessesTest : public testing::Test {
 protected:
  std::vector<Scored> ScoredOf(const std::string& kind) const {
    std::vector<SharedEffect> effects;
    for (const SharedEffect& e : CatalogueEffects(axis_.problem))
      if (e->kind == kind) effects.push_back(e);
    std::vector<Scored> scored = ScoreEffects(axis_.problem, axis_.base, effects);
    std::stable_sort(scored.begin(), scored.end(),
                     [](const Scored& a, const Scored& b) { return a.drop > b.drop; });
    return scored;
  }

  Hypothesis At(const Scored& s, bool implausible) const {
    Hypothesis r;
    r.fit.point = Near(axis_.problem, axis_.base, s).point;
    r.implausible = implausible;
    return r;
  }

  test::FittedAxis axis_{{{"constant_torque", 0.3, 0.0, 0.0, 0.0}}};
};

TEST_F(GuessesTest, NearBeginsAtTheLinearEstimateInsideItsBounds) {
  const Scored s = ScoredOf("constant_torque")[0];
  const InitialGuess guess = Near(axis_.problem, axis_.base, s);
  ASSERT_EQ(guess.point.effects.size(), 1u);
  const double Fc = axis_.made.axis.stated.friction.Fc_plus;
  EXPECT_NEAR(guess.point.amplitudes[0][0], 0.3 * Fc, 0.1 * Fc);
  EXPECT_EQ(guess.known, &axis_.base);
}

TEST_F(GuessesTest, AKneeIsAFamilyOfItsOwn) {
  const std::vector<Scored> scored = ScoredOf("viscous_nonlinear");
  std::vector<std::string> families;
  for (const Scored& s : scored) families.push_back(FamilyOf(*s.effect));
  std::sort(families.begin(), families.end());
  families.erase(std::unique(families.begin(), families.end()), families.end());
  EXPECT_EQ(families.size(), 2u);
}

TEST_F(GuessesTest, WhatEndedWhereNoMachineIsBeginsAtTheNextPlaceOfItsFamily) {
  const std::vector<Scored> scored = ScoredOf("viscous_nonlinear");
  const auto bent =
      std::find_if(scored.begin(), scored.end(), [](const Scored& s) { return s.effect->order > 1.0; });
  ASSERT_NE(bent, scored.end());
  EXPECT_TRUE(OtherPlaces(axis_.problem, axis_.base, scored, {}).empty());
  std::vector<Hypothesis> hypotheses;
  hypotheses.push_back(At(*bent, false));
  EXPECT_TRUE(OtherPlaces(axis_.problem, axis_.base, scored, hypotheses).empty());
  hypotheses[0].implausible = true;
  const std::vector<InitialGuess> guesses = OtherPlaces(axis_.problem, axis_.base, scored, hypotheses);
  ASSERT_EQ(guesses.size(), 1u);
  const Effect& next = *guesses[0].point.effects.back();
  EXPECT_NE(&next, bent->effect.get());
  EXPECT_EQ(FamilyOf(next), FamilyOf(*bent->effect));
}

// A mode of 766 Hz shows in rows at 1 kHz as one of 234 Hz.
TEST(Guesses, ACouplingBelowHalfTheRateIsAlsoTriedAsTheOneAboveIt) {
  test::HiddenOptions options = test::FittedAxis::Short({{"constant_torque", 0.3, 0.0, 0.0, 0.0}});
  options.two_inertia = false;
  const test::FittedAxis axis(options);
  std::vector<SharedEffect> effects;
  for (const SharedEffect& e : CatalogueEffects(axis.problem))
    if (e->kind == "compliance") effects.push_back(e);
  std::vector<Scored> scored;
  for (const SharedEffect& e : effects) {
    scored.emplace_back();
    scored.back().effect = e;
  }
  const auto seen =
      std::find_if(effects.begin(), effects.end(), [](const SharedEffect& e) { return e->order == 180.0; });
  ASSERT_NE(seen, effects.end());
  std::vector<Hypothesis> hypotheses(1);
  hypotheses[0].fit.point = axis.base.point;
  hypotheses[0].fit.point.effects.push_back(*seen);
  hypotheses[0].fit.point.amplitudes.push_back({0.4, 0.0, 0.0});
  const std::vector<InitialGuess> guesses = Mirrored(axis.problem, axis.base, scored, hypotheses);
  ASSERT_EQ(guesses.size(), 1u);
  const auto resonance_Hz = [&](const Point& point) {
    const AxisModel m = axis.problem.Build(point);
    return std::sqrt(m.stiffness * (1.0 / m.motor_inertia + 1.0 / m.load_inertia)) / (2.0 * std::numbers::pi);
  };
  EXPECT_NEAR(resonance_Hz(hypotheses[0].fit.point) + resonance_Hz(guesses[0].point),
              1.0 / axis.problem.log.period_s, 1.0);
  hypotheses[0].no_fault = true;
  EXPECT_TRUE(Mirrored(axis.problem, axis.base, scored, hypotheses).empty());
}

TEST_F(GuessesTest, AWaveOfAnotherOrderIsAnotherCause) {
  const std::vector<Scored> scored = ScoredOf("encoder_eccentricity");
  ASSERT_FALSE(scored.empty());
  std::vector<Hypothesis> hypotheses;
  hypotheses.push_back(At(scored[0], true));
  EXPECT_TRUE(OtherPlaces(axis_.problem, axis_.base, scored, hypotheses).empty());
}

}  // namespace
}  // namespace contour::diagnosis
