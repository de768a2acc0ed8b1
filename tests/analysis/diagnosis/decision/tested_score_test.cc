// What a joint fit lowers chi^2 by is believed as far as it comes from all over the log.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/decision/tested_score.h"
#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis {
namespace {

constexpr double kDrop = 150.0;  // weak enough for luck

test::HiddenOptions Short() {
  test::HiddenOptions o;
  o.duration_s = 20.0;
  o.parameter_spread = 0.0;
  return o;
}

class TestedScoreTest : public testing::Test {
 protected:
  TestedScoreTest() {
    const std::vector<SharedEffect> all = CatalogueEffects(problem_);
    effect_ =
        *std::find_if(all.begin(), all.end(), [](const auto& e) { return e->kind == "constant_torque"; });
    base_ = FitPoint(problem_, made_.point);
    Point with = base_.point;
    with.effects.push_back(effect_);
    with.amplitudes.emplace_back(effect_->steps.size(), 0.0);
    hypothesis_.fit = FitPoint(problem_, with);
    hypothesis_.score = kDrop - Penalty(*effect_);
  }

  /// Of the hypothesis, where a constant torque that lowers chi^2 by kDrop acts in rows `from` to `to`.
  double TestedWith(std::size_t from, std::size_t to) const {
    const Eigen::VectorXd column = hypothesis_.fit.jacobian.rightCols(1);
    const auto first = static_cast<Eigen::Index>(from), count = static_cast<Eigen::Index>(to - from);
    const double all = column.squaredNorm(), own = column.segment(first, count).squaredNorm();
    const double amplitude =
        std::sqrt(kDrop * ScoreEffects(problem_, base_, {effect_})[0].covariance(0, 0)) * all / own;
    Fit current = base_;
    for (std::size_t k = from; k < to; ++k)
      current.residual[k] += amplitude * column(static_cast<Eigen::Index>(k));
    return TestedScore(problem_, current, hypothesis_);
  }

  test::LearntProblem made_{test::MakeHiddenAxis(Short())};
  const Problem& problem_ = made_.problem;
  SharedEffect effect_;
  Fit base_;
  Hypothesis hypothesis_;
};

TEST_F(TestedScoreTest, IsTheJointFitsWhereTheEffectIsThereAllTheTime) {
  EXPECT_GT(TestedWith(0, problem_.rows()), 0.5 * hypothesis_.score);
}

TEST_F(TestedScoreTest, IsLittleWhereOneEventMakesIt) {
  const std::size_t block = problem_.rows() / static_cast<std::size_t>(kBlocks);
  EXPECT_LT(TestedWith(20 * block, 21 * block), 0.1 * hypothesis_.score);
}

// Before: where friction sticks hard and the cost is rough, a factor on all forces, which moves nothing, was
// named for a base that lay elsewhere without it.
TEST_F(TestedScoreTest, AFactorOnAllForcesIsWorthWhatTheStatedNumbersSayOfIt) {
  const std::vector<SharedEffect> all = CatalogueEffects(problem_);
  const auto factor = *std::find_if(all.begin(), all.end(), [](const auto& e) { return e->common_factor; });
  Point with = base_.point;
  with.effects.push_back(factor);
  with.amplitudes.emplace_back(factor->steps.size(), 0.0);
  Hypothesis h{.fit = FitPoint(problem_, with)};
  h.score = kDrop;
  h.fit.point = with;
  EXPECT_LT(TestedScore(problem_, base_, h), 10.0);
  // All stated numbers are off by the same factor then.
  h.fit.point.amplitudes.back()[0] = 2.0;
  EXPECT_GT(TestedScore(problem_, base_, h), 20.0);
  // A bristle that is softer in series with a coupling takes nothing from that.
  h.score = 1e9;
  const auto with_bristle = [&](double deviations) {
    for (std::size_t i = 0; i < problem_.terms.size(); ++i)
      if (problem_.terms[i].name == "s0" || problem_.terms[i].name == "s1")
        h.fit.point.base[i] = deviations * problem_.terms[i].sigma;
    return TestedScore(problem_, base_, h);
  };
  const double as_stated = with_bristle(0.0);
  EXPECT_LT(as_stated, 1e8);
  EXPECT_EQ(with_bristle(-6.0), as_stated);
  EXPECT_NE(with_bristle(6.0), as_stated);
}

TEST_F(TestedScoreTest, AFitIsJudgedByWhatItLowersTheCostBy) {
  Hypothesis h{.fit = hypothesis_.fit};
  h.fit.cost = base_.cost - 40.0;
  Judge(problem_, base_, h);
  EXPECT_NEAR(h.score, 40.0 - Penalty(*effect_), 1e-6);
  EXPECT_FALSE(h.no_fault);
  // Where it ended nowhere it has no score at all.
  h.fit.cost = std::nan("");
  Judge(problem_, base_, h);
  EXPECT_LT(h.score, -1e100);
}

TEST_F(TestedScoreTest, ACouplingThatEveryScrewHasIsNoFault) {
  const std::vector<SharedEffect> all = CatalogueEffects(problem_);
  const auto coupling = std::find_if(
      all.begin(), all.end(), [](const auto& e) { return e->kind == "compliance" && e->order > 900.0; });
  ASSERT_NE(coupling, all.end());
  Hypothesis h{.fit = base_};
  h.fit.point.effects.push_back(*coupling);
  h.fit.point.amplitudes.push_back({0.3, 0.0, 0.0});
  EXPECT_TRUE(AddsCoupling(problem_, h));
  EXPECT_FALSE(AddsCoupling(problem_, hypothesis_));
  Judge(problem_, base_, h);
  EXPECT_TRUE(h.no_fault);
  h.fit.point.amplitudes.back()[1] = std::log(0.2);  // 200 Hz
  Judge(problem_, base_, h);
  EXPECT_FALSE(h.no_fault);
  h.fit.point.amplitudes.back() = {0.001, 0.0, 0.0};  // with nothing behind it
  Judge(problem_, base_, h);
  EXPECT_LT(h.score, -1e100);
}

// A bristle in series with a coupling that nobody stated is softer and less damped, whatever the torque is.
TEST_F(TestedScoreTest, ABristleBehindACouplingLeavesTheTorqueConstantPlausible) {
  const std::vector<SharedEffect> all = CatalogueEffects(problem_);
  Hypothesis h{.fit = base_};
  h.fit.point.effects.push_back(
      *std::find_if(all.begin(), all.end(), [](const auto& e) { return e->kind == "torque_constant"; }));
  h.fit.point.amplitudes.push_back({0.1});
  const auto plausible_with = [&](const std::vector<std::string>& names, double deviations) {
    h.fit.point.base.assign(problem_.terms.size(), 0.0);
    for (std::size_t i = 0; i < problem_.terms.size(); ++i)
      if (std::find(names.begin(), names.end(), problem_.terms[i].name) != names.end())
        h.fit.point.base[i] = deviations * problem_.terms[i].sigma;
    Judge(problem_, base_, h);
    return !h.implausible;
  };
  EXPECT_TRUE(plausible_with({"s0", "s1"}, -6.0));
  EXPECT_FALSE(plausible_with({"s0", "s1"}, 6.0));
  EXPECT_FALSE(plausible_with({"inertia"}, -6.0));
}

TEST_F(TestedScoreTest, ANumberOfTheBaseIsOffAsFarAsItIsFromWhatIsStated) {
  const std::vector<SharedEffect> all = CatalogueEffects(problem_);
  const auto lag =
      *std::find_if(all.begin(), all.end(), [](const auto& e) { return e->kind == "current_lag"; });
  Point with = base_.point;
  with.effects.push_back(lag);
  with.amplitudes.emplace_back(lag->steps.size(), 0.0);
  // The axis is as stated; a base in another place would make the drop large.
  Hypothesis h{.fit = FitPoint(problem_, with)};
  h.score = kDrop - Penalty(*lag);
  EXPECT_LT(TestedScore(problem_, base_, h), 10.0);
  // Ten stated deviations are no chance.
  h.fit.point.amplitudes.back()[0] += 10.0 * problem_.terms[FreedTerms(problem_, "current_lag")[0]].sigma;
  EXPECT_GT(TestedScore(problem_, base_, h), 20.0);
}

TEST_F(TestedScoreTest, ScatterOfItsOwnKeepsNothingFromBeingFitted) {
  Scored s = ScoreEffects(problem_, base_, {effect_})[0];
  ScoreThreshold threshold;
  threshold.flips = threshold.calibrated = 20.0;
  s.drop = 60.0;
  s.overdispersion = s.within_blocks = 50.0;
  EXPECT_TRUE(Promising(problem_, s, threshold));
}

TEST_F(TestedScoreTest, OfWhatChanceExplainsNothingIsPromised) {
  const Scored s = ScoreEffects(problem_, base_, {effect_})[0];
  ScoreThreshold threshold;
  threshold.flips = threshold.calibrated = 20.0;
  EXPECT_FALSE(Promising(problem_, s, threshold));
  Scored much = s;
  much.drop = 1e4;
  EXPECT_TRUE(Promising(problem_, much, threshold));
}

}  // namespace
}  // namespace contour::diagnosis
