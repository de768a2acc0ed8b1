#include "estimator/friction_learner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "tests/support/allocation_guard.h"

namespace contour {
namespace {

constexpr double kLevel_N = 45.0;

std::array<double, kLoopTaps> Response() {
  std::array<double, kLoopTaps> h{};
  for (std::size_t i = 1; i < kLoopTaps; ++i) h[i] = 0.25 * std::pow(0.75, static_cast<double>(i - 1));
  return h;
}

FrictionLearner::Setup SetupFor(double level_N) {
  FrictionLearner::Setup s;
  s.parameters[friction_term::kDahl + 2] = level_N;
  for (std::size_t i = 0; i < friction_term::kMass; ++i) s.std[i] = 0.15 * level_N;
  s.level_std = 0.2;
  s.response = Response();
  s.level_N = level_N;
  s.vs_m_s = 2e-3;
  return s;
}

/// A circle of 100 um at pi/4 Hz, its terms, and what an observer of that response finds of them.
class Bench {
 public:
  explicit Bench(double level_N) : level_N_(level_N), basis_({level_N, 9e-6, 2e-3, 2e-3, 5e-3, 0.0, 0.2}) {}

  /// Returns what is left unexplained. `truth`: parameters; `outside_N`: beside them.
  double Step(FrictionLearner& learner, const FrictionTerms& truth, double outside_N, bool may = true,
              double noise_N2 = 0.0) {
    const double w = 2 * std::numbers::pi * std::numbers::pi / 4, t = 1e-3 * static_cast<double>(++cycle_);
    const double position_m = 1e-4 * std::sin(w * t), velocity_m_s = 1e-4 * w * std::cos(w * t);
    FrictionTerms terms{};
    basis_.Follow(position_m - before_m_, position_m, velocity_m_s, 0.0, memory_, terms);
    before_m_ = position_m;
    const double used_N = Sum(terms, learner.parameters());
    found_N_ += 0.25 * (Sum(terms, truth) - used_N + outside_N - found_N_);
    return learner.Learn(terms, used_N, found_N_, std::abs(velocity_m_s), may, noise_N2);
  }

 private:
  double level_N_;
  LinearFriction basis_;
  FrictionTermsState memory_;
  double before_m_ = 0.0, found_N_ = 0.0;
  long cycle_ = 0;
};

TEST(FrictionLearner, LearnsWhatCommissioningWasWrongBy) {
  for (const double level_N : {4.5, 45.0, 900.0}) {
    const auto learner = std::make_unique<FrictionLearner>(SetupFor(level_N));
    Bench bench(level_N);
    FrictionTerms truth = learner->parameters();
    truth[friction_term::kDahl + 2] *= 0.7;
    truth[friction_term::kDahl + 3] = 0.4 * level_N;
    truth[friction_term::kConstant] = 0.1 * level_N;
    double first = 0.0, last = 0.0;
    for (int k = 0; k < 6000; ++k) {
      const double left = bench.Step(*learner, truth, 0.0);
      if (k < 1200) first += left * left;
      if (k >= 4800) last += left * left;
    }
    EXPECT_LT(last, 0.08 * first) << level_N;
    // So short a travel hardly tells friction over the turn from its level.
    EXPECT_NEAR(learner->Level_N(true), 1.2 * level_N, 0.3 * level_N);
    EXPECT_NEAR(learner->Level_N(false), 1.0 * level_N, 0.3 * level_N);
    EXPECT_EQ(learner->brought_back(), 0);
  }
}

// What was found a moment ago and is known by now must not be learnt again while the observer still shows it.
TEST(FrictionLearner, WhatIsLeftIsWhatThePresentParametersWouldLeave) {
  const auto learner = std::make_unique<FrictionLearner>(SetupFor(kLevel_N));
  const auto settled = std::make_unique<FrictionLearner>(SetupFor(kLevel_N));
  Bench bench(kLevel_N);
  FrictionTerms truth = learner->parameters();
  truth[friction_term::kConstant] = 0.3 * kLevel_N;
  double left_N = 0.0;
  for (int k = 0; k < 60; ++k) left_N = bench.Step(*learner, truth, 0.0);
  // The same motion under a force that is off by what they lack at the end, all along.
  FrictionTerms lacks = settled->parameters();
  for (std::size_t i = 0; i < kFrictionTerms; ++i) lacks[i] += truth[i] - learner->parameters()[i];
  Bench other(kLevel_N);
  double expected_N = 0.0;
  for (int k = 0; k < 60; ++k) expected_N = other.Step(*settled, lacks, 0.0, false);
  EXPECT_NE(learner->parameters(), settled->parameters());
  EXPECT_NEAR(left_N, expected_N, 1e-3 * kLevel_N);
}

// Forces of twice the level to and fro, as a drive reports them that answers each count of a coarse encoder:
// the friction that is known stays, and none of it is taken for a force from outside.
TEST(FrictionLearner, NoiseThatIsKnownIsNotLearnt) {
  FrictionLearner::Setup setup = SetupFor(kLevel_N);
  setup.together = 3.0;
  const auto learner = std::make_unique<FrictionLearner>(setup);
  const FrictionTerms truth = learner->parameters();
  Bench bench(kLevel_N);
  std::mt19937_64 bits(1);
  double furthest_N = 0.0;
  int disturbed = 0;
  for (int k = 0; k < 6000; ++k) {
    const double outside_N = bits() % 2 == 0 ? 4.0 * kLevel_N : -4.0 * kLevel_N;
    // Of it the observer shows 0.25 / (2 - 0.25) of the variance.
    bench.Step(*learner, truth, outside_N, true, 16.0 * kLevel_N * kLevel_N / 7.0);
    furthest_N = std::max(furthest_N, std::abs(learner->Level_N(true) - kLevel_N));
    disturbed += learner->disturbed() ? 1 : 0;
  }
  EXPECT_LT(furthest_N, 0.1 * kLevel_N);
  EXPECT_LT(disturbed, 3000);
}

TEST(FrictionLearner, ABlowTeachesNothing) {
  const auto learner = std::make_unique<FrictionLearner>(SetupFor(kLevel_N));
  Bench bench(kLevel_N);
  const FrictionTerms truth = learner->parameters();
  for (int k = 0; k < 1000; ++k) bench.Step(*learner, truth, 0.0);
  for (int k = 0; k < 300; ++k) bench.Step(*learner, truth, 2.0 * kLevel_N);
  EXPECT_TRUE(learner->disturbed());
  EXPECT_NEAR(learner->Level_N(true), kLevel_N, 0.1 * kLevel_N);
  EXPECT_NEAR(learner->Level_N(false), kLevel_N, 0.1 * kLevel_N);
  for (int k = 0; k < 300; ++k) bench.Step(*learner, truth, 0.0);
  EXPECT_FALSE(learner->disturbed());
}

// Otherwise friction that was stated far too low would count as an outside force for good.
TEST(FrictionLearner, WhatLastsIsLearntAfterAll) {
  const auto learner = std::make_unique<FrictionLearner>(SetupFor(kLevel_N));
  Bench bench(kLevel_N);
  FrictionTerms truth = learner->parameters();
  for (double& p : truth) p *= 2.0;
  double first = 0.0, last = 0.0;
  for (int k = 0; k < 8000; ++k) {
    const double left = bench.Step(*learner, truth, 0.0);
    if (k < 1200) first += left * left;
    if (k >= 6800) last += left * left;
  }
  EXPECT_LT(last, 0.1 * first);
}

/// So short a travel does not tell a weight from a force over the turn.
FrictionLearner::Setup SetupWithWeight(double weight_N) {
  FrictionLearner::Setup s = SetupFor(kLevel_N);
  s.weight_N = weight_N;
  for (std::size_t i = friction_term::kTurn; i <= friction_term::kStroke; ++i) s.std[i] = 0.0;
  return s;
}

// A vertical axis whose weight nobody has stated: more than the directions of friction differ by.
TEST(FrictionLearner, AWeightIsLearntAndIsNoFriction) {
  for (const double weight : {1.0, -1.0, 2.0}) {
    const auto learner = std::make_unique<FrictionLearner>(SetupWithWeight(3.0 * kLevel_N));
    Bench bench(kLevel_N);
    FrictionTerms truth = learner->parameters();
    truth[friction_term::kConstant] = weight * kLevel_N;
    double first = 0.0, last = 0.0;
    for (int k = 0; k < 8000; ++k) {
      const double left = bench.Step(*learner, truth, 0.0);
      if (k < 1200) first += left * left;
      if (k >= 6800) last += left * left;
    }
    EXPECT_LT(last, 0.02 * first) << weight;
    EXPECT_FALSE(learner->bounded()) << weight;
    EXPECT_NEAR(learner->parameters()[friction_term::kConstant], weight * kLevel_N,
                0.1 * std::abs(weight) * kLevel_N);
    const FrictionTerms learnt = learner->parameters();
    learner->Rest();
    EXPECT_EQ(learner->parameters(), learnt) << "no level has left its range";
    for (const bool forward : {true, false}) EXPECT_GT(learner->Level_N(forward), 0.2 * kLevel_N) << weight;
  }
}

TEST(FrictionLearner, AWeightIsKeptAtRestThoughFrictionIsLessThanCommissioned) {
  const auto learner = std::make_unique<FrictionLearner>(SetupWithWeight(3.0 * kLevel_N));
  Bench bench(kLevel_N);
  FrictionTerms truth = learner->parameters();
  for (std::size_t i = friction_term::kDahl; i < friction_term::kConstant; ++i) truth[i] *= 0.8;
  truth[friction_term::kConstant] = kLevel_N;
  for (int k = 0; k < 8000; ++k) bench.Step(*learner, truth, 0.0);
  ASSERT_GT(learner->Weight_N(), 0.2 * kLevel_N);
  const FrictionTerms learnt = learner->parameters();
  learner->Rest();
  EXPECT_EQ(learner->parameters(), learnt);
}

TEST(FrictionLearner, NoWeightIsBeyondWhatMayPush) {
  const auto learner = std::make_unique<FrictionLearner>(SetupWithWeight(0.5 * kLevel_N));
  Bench bench(kLevel_N);
  FrictionTerms truth = learner->parameters();
  truth[friction_term::kConstant] = 5.0 * kLevel_N;
  for (int k = 0; k < 8000; ++k) bench.Step(*learner, truth, 0.0);
  EXPECT_TRUE(learner->bounded());
  EXPECT_GT(learner->Weight_N(), 0.2 * kLevel_N);
  EXPECT_LE(learner->Weight_N(), 0.5 * kLevel_N);
}

TEST(FrictionLearner, StandsStillWhereItMayNotLearn) {
  const auto learner = std::make_unique<FrictionLearner>(SetupFor(kLevel_N));
  Bench bench(kLevel_N);
  const FrictionTerms commissioned = learner->parameters();
  FrictionTerms truth = commissioned;
  truth[friction_term::kConstant] = 10.0;
  for (int k = 0; k < 2000; ++k) bench.Step(*learner, truth, 0.0, false);
  EXPECT_EQ(learner->parameters(), commissioned);
}

TEST(FrictionLearner, ParametersThatRanAwayComeBackAtRest) {
  FrictionLearner::Setup setup = SetupFor(kLevel_N);
  setup.level_range = 1.05;
  const auto learner = std::make_unique<FrictionLearner>(setup);
  const FrictionTerms commissioned = learner->parameters();
  Bench bench(kLevel_N);
  FrictionTerms doubled = commissioned;
  for (double& p : doubled) p *= 2.3;
  for (int k = 0; k < 20000; ++k) bench.Step(*learner, doubled, 0.0);
  EXPECT_GT(learner->Level_N(true), 1.6 * kLevel_N);
  learner->Rest();
  EXPECT_EQ(learner->parameters(), commissioned);
  EXPECT_EQ(learner->brought_back(), 1);
}

TEST(FrictionLearner, WhatWasLearntWellStaysAtRest) {
  const auto learner = std::make_unique<FrictionLearner>(SetupFor(kLevel_N));
  Bench bench(kLevel_N);
  FrictionTerms truth = learner->parameters();
  truth[friction_term::kDahl + 2] *= 1.4;
  for (int k = 0; k < 6000; ++k) bench.Step(*learner, truth, 0.0);
  const FrictionTerms learnt = learner->parameters();
  for (int k = 0; k < 1000; ++k) learner->Rest();
  EXPECT_EQ(learner->parameters(), learnt);
}

TEST(FrictionLearner, TakesNoMemory) {
  const auto learner = std::make_unique<FrictionLearner>(SetupFor(kLevel_N));
  Bench bench(kLevel_N);
  const FrictionTerms truth{};
  if (!test::AllocationGuard::kAvailable) GTEST_SKIP() << "the sanitizer owns the heap";
  test::AllocationGuard guard;
  for (int k = 0; k < 100; ++k) bench.Step(*learner, truth, 0.0);
  learner->Rest();
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace
}  // namespace contour
