#include "analysis/diagnosis/decision/hypotheses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "analysis/diagnosis/decision/tested_score.h"
#include "analysis/diagnosis/tuning/screening_tuning.h"
#include "tests/analysis/support/fitted_axis.h"

namespace contour::diagnosis {
namespace {

TEST(Hypotheses, OutsideTheCatalogueSaysItsName) {
  EXPECT_TRUE(Outside("outside:force of time"));
  EXPECT_FALSE(Outside("constant_torque"));
}

class HypothesesTest : public testing::Test {
 protected:
  std::vector<Scored> ScoredOf(const std::vector<std::string>& kinds) const {
    std::vector<SharedEffect> effects;
    for (const std::string& kind : kinds) effects.push_back(axis_.Of(kind));
    std::vector<Scored> scored = ScoreEffects(axis_.problem, axis_.base, effects);
    std::stable_sort(scored.begin(), scored.end(),
                     [](const Scored& a, const Scored& b) { return a.drop > b.drop; });
    return scored;
  }

  // A torque of 0.3 Fc that the model does not have.
  test::FittedAxis axis_{{{"constant_torque", 0.3, 0.0, 0.0, 0.0}}};
  ScoreThreshold threshold_{.flips = 20.0, .calibrated = 20.0};
  std::vector<std::string> tried_;
};

TEST_F(HypothesesTest, TheOneThatIsThereComesFirstWithItsSize) {
  const std::vector<Scored> scored = ScoredOf({"constant_torque", "friction_drift", "cable_spring"});
  const std::vector<Hypothesis> found = FitHypotheses(axis_.problem, axis_.base, scored, threshold_, tried_);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].effect().kind, "constant_torque");
  const double Fc = axis_.made.axis.stated.friction.Fc_plus;
  EXPECT_NEAR(found[0].fit.point.amplitudes.back()[0], 0.3 * Fc, 0.03 * Fc);
  EXPECT_NEAR(found[0].score, axis_.base.cost - found[0].fit.cost - Penalty(found[0].effect()), 1.0);
  for (std::size_t i = 1; i < found.size(); ++i)
    if (!found[i].given_up) {
      EXPECT_LE(found[i].score, found[i - 1].score);
    }
  EXPECT_TRUE(MayHold(axis_.problem, found, threshold_));
}

TEST_F(HypothesesTest, WhatSlidingDoesNotTellFromTheBestIsFittedWithIt) {
  std::vector<Scored> scored = ScoredOf({"constant_torque", "asymmetric_coulomb", "cable_spring"});
  ASSERT_EQ(scored[0].effect->kind, "constant_torque");
  // So little is promised of the others that they would have no turn, and more than is asked.
  threshold_.flips = threshold_.calibrated = 1.0;
  for (std::size_t i = 1; i < scored.size(); ++i) {
    scored[i].drop = 0.9 * kScreening.little_share * scored[0].drop;
    scored[i].overdispersion = scored[i].within_blocks = 1.0;
    ASSERT_TRUE(Promising(axis_.problem, scored[i], threshold_));
  }
  const std::vector<Hypothesis> found = FitHypotheses(axis_.problem, axis_.base, scored, threshold_, tried_);
  const auto fitted = [&](const char* kind) {
    return std::any_of(found.begin(), found.end(),
                       [&](const Hypothesis& h) { return h.effect().kind == kind; });
  };
  EXPECT_TRUE(fitted("constant_torque"));
  EXPECT_TRUE(fitted("asymmetric_coulomb"));
  EXPECT_FALSE(fitted("cable_spring"));
}

TEST_F(HypothesesTest, WhatHasBeenTriedIsNotFittedAgain) {
  const std::vector<Scored> scored = ScoredOf({"constant_torque"});
  EXPECT_TRUE(MorePromised(axis_.problem, scored, threshold_, tried_));
  ASSERT_EQ(FitHypotheses(axis_.problem, axis_.base, scored, threshold_, tried_).size(), 1u);
  EXPECT_FALSE(tried_.empty());
  EXPECT_FALSE(MorePromised(axis_.problem, scored, threshold_, tried_));
  EXPECT_TRUE(FitHypotheses(axis_.problem, axis_.base, scored, threshold_, tried_).empty());
}

TEST_F(HypothesesTest, NothingIsFittedWhereNothingIsPromised) {
  threshold_.flips = threshold_.calibrated = 1e9;
  const std::vector<Scored> scored = ScoredOf({"constant_torque", "cable_spring"});
  EXPECT_FALSE(MorePromised(axis_.problem, scored, threshold_, tried_));
  EXPECT_TRUE(FitHypotheses(axis_.problem, axis_.base, scored, threshold_, tried_).empty());
}

TEST_F(HypothesesTest, WhatIsFarBelowItsThresholdWillNotHold) {
  const std::vector<Scored> scored = ScoredOf({"constant_torque"});
  std::vector<Hypothesis> found = FitHypotheses(axis_.problem, axis_.base, scored, threshold_, tried_);
  ASSERT_FALSE(found.empty());
  threshold_.flips = threshold_.calibrated = 1e9;
  EXPECT_FALSE(MayHold(axis_.problem, found, threshold_));
  threshold_.flips = threshold_.calibrated = 20.0;
  found[0].given_up = true;
  EXPECT_FALSE(MayHold(axis_.problem, found, threshold_));
}

TEST_F(HypothesesTest, WhatWasPassedOverBehindOneThatWasRefusedHasAnotherTurn) {
  const std::vector<std::string> kinds = {"constant_torque", "friction_drift", "cable_spring", "cogging"};
  std::vector<Hypothesis> hypotheses;
  for (const std::string& kind : kinds) {
    Hypothesis& h = hypotheses.emplace_back(Hypothesis{.fit = axis_.base, .score = 50.0});
    auto effect = std::make_shared<Effect>();
    effect->kind = kind;
    h.fit.point.effects = {effect};
    tried_.push_back(kind);
  }
  hypotheses[0].refused = hypotheses[1].refused = true;
  hypotheses[2].given_up = true;
  hypotheses[3].score = 10.0;
  GiveAnotherTurn(axis_.problem, hypotheses, threshold_, tried_);
  EXPECT_EQ(tried_, (std::vector<std::string>{"constant_torque", "friction_drift", "cogging"}))
      << "refused, or below what is asked";
}

// It once came first, was refused, and came first again, for ever.
TEST_F(HypothesesTest, WhatLiesOutsideTheCatalogueAndWasRefusedDoesNotComeAgain) {
  std::vector<Scored> scored = ScoredOf({"outside:force of time", "constant_torque"});
  for (Scored& s : scored) s.drop = s.effect->kind == "constant_torque" ? 100.0 : 1000.0;
  std::stable_sort(scored.begin(), scored.end(),
                   [](const Scored& a, const Scored& b) { return a.drop > b.drop; });
  std::vector<Hypothesis> found = FitHypotheses(axis_.problem, axis_.base, scored, threshold_, tried_);
  const auto outside = [](const Hypothesis& h) { return Outside(h.effect().kind); };
  ASSERT_TRUE(std::any_of(found.begin(), found.end(), outside));
  std::stable_partition(found.begin(), found.end(), outside);
  found[0].refused = true;
  GiveAnotherTurn(axis_.problem, found, threshold_, tried_);
  const std::vector<Hypothesis> next = FitHypotheses(axis_.problem, axis_.base, scored, threshold_, tried_);
  ASSERT_FALSE(next.empty()) << "the other one has its turn";
  EXPECT_TRUE(std::none_of(next.begin(), next.end(), outside));
}

TEST_F(HypothesesTest, UnderNewNoiseTheyAreFittedAnewAndEachKindIsThereOnce) {
  const std::vector<Scored> scored = ScoredOf({"constant_torque", "cable_spring"});
  std::vector<Hypothesis> found = FitHypotheses(axis_.problem, axis_.base, scored, threshold_, tried_);
  ASSERT_FALSE(found.empty());
  axis_.made.problem.LearnNoise(found[0].fit.point);
  Fit current = axis_.base;
  FitAgain(axis_.problem, current, found);
  EXPECT_EQ(found[0].effect().kind, "constant_torque");
  EXPECT_NEAR(found[0].score, current.cost - found[0].fit.cost - Penalty(found[0].effect()), 1.0);
  double counted = 0.0;
  for (std::size_t k = 0; k < axis_.problem.rows(); ++k) counted += axis_.problem.counted[k];
  EXPECT_NEAR(found[0].fit.cost / counted, 1.0, 0.15) << "white under the noise that it leaves";
  EXPECT_EQ(std::count_if(found.begin(), found.end(),
                          [](const Hypothesis& h) { return h.effect().kind == "cable_spring"; }),
            static_cast<std::ptrdiff_t>(found.size()) - 1);
  EXPECT_LE(found.size(), 2u);
}

// What least squares said of a cause stays true of a fit of it that begins elsewhere.
TEST(Hypotheses, WhatIsFittedAnewStaysGross) {
  test::FittedAxis axis({{"constant_torque", 0.5}, {"cable_spring", 0.5}});
  const auto with = [&](const std::string& kind, bool gross) {
    Hypothesis h{axis.With(axis.Of(kind))};
    Judge(axis.problem, axis.base, h);
    h.gross = gross;
    return h;
  };
  std::vector<Hypothesis> both;
  both.push_back(with("constant_torque", false));
  both.push_back(with("cable_spring", true));
  both[1].score = -both[1].score;  // as where its fit ended elsewhere
  both[1].given_up = true;
  Fit current = axis.base;
  FitAgain(axis.problem, current, both);
  ASSERT_EQ(both.size(), 2u);
  const auto anew = std::find_if(both.begin(), both.end(),
                                 [](const Hypothesis& h) { return h.effect().kind == "cable_spring"; });
  ASSERT_NE(anew, both.end());
  EXPECT_FALSE(anew->given_up) << "begun anew";
  EXPECT_TRUE(anew->gross);
}

}  // namespace
}  // namespace contour::diagnosis
