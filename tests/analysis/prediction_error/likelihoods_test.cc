#include "analysis/prediction_error/likelihoods.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "analysis/prediction_error/simd/lane_likelihood.h"
#include "analysis/prediction_error/simd/lane_loops.h"
#include "tests/analysis/support/noise_moved.h"

namespace contour::diagnosis {
namespace {

NoiseVariances Noise(double slow_over_white) {
  const double white = 4e-6;
  return {white, test::ReadingVariance(), slow_over_white * white, 0.95};
}

// After a gap all of them begin anew, and what is no reading corrects nothing.
TEST(AddLikelihoods, GivesEachNoiseWhatAPassOfItsOwnDoes) {
  LinearModel model = *test::MovedBy(Noise(2.0));
  model.begins = {model.rows / 3};
  model.valid[model.rows / 2] = 0;
  const Problem& problem = test::SlidingAndStuck().problem;
  const PassRows rows{model, problem.counted, problem.log.period_s, 0, model.rows};
  for (const bool slow : {false, true}) {
    std::vector<NoiseVariances> noises;
    for (int i = 0; i < 5; ++i) {
      noises.push_back(Noise(slow && i > 0 ? std::ldexp(0.1, i) : 0.0));
      noises.back().torque *= std::ldexp(0.2, i);
      noises.back().keep = 0.9 - 0.1 * i;
    }
    std::vector<LikelihoodSums> sums(noises.size());
    // What was there before is added to.
    AddLikelihoods(rows, noises, sums);
    AddLikelihoods(rows, noises, sums);
    for (std::size_t i = 0; i < noises.size(); ++i) {
      LikelihoodSums alone;
      KalmanPass(rows, noises[i], alone, nullptr);
      KalmanPass(rows, noises[i], alone, nullptr);
      EXPECT_EQ(sums[i].count, alone.count);
      EXPECT_NEAR(sums[i].squares, alone.squares, 1e-9 * alone.squares) << slow << i;
      EXPECT_NEAR(sums[i].logs, alone.logs, 1e-9 * std::fabs(alone.logs)) << slow << i;
    }
  }
}

TEST(AddLikelihoods, EveryInstructionSetAgrees) {
  const auto model = test::MovedBy(Noise(2.0));
  const Problem& problem = test::SlidingAndStuck().problem;
  LaneLikelihood asked;
  asked.to = model->rows / 4;
  asked.stride = model->stride;
  asked.states = model->states;
  asked.slow = true;
  asked.most_square = kMostSquare;
  asked.start_w = 1e-6;
  asked.step = model->step.data();
  asked.valid = model->valid.data();
  asked.counted = problem.counted.data();
  asked.innovation = model->innovation.data();
  asked.lanes = 7;
  asked.reading = test::ReadingVariance();
  for (std::size_t i = 0; i < asked.lanes; ++i) {
    asked.torque[i] = 1e-6 * static_cast<double>(1 + i);
    asked.slow_torque[i] = 2e-6;
    asked.keep[i] = 0.9;
  }
  LaneLikelihood baseline = asked;
  kBaselineLoops.likelihood(baseline);
  EXPECT_GT(baseline.count, 0.0);
  std::vector<const LaneLoops*> others;
  if (HasAvx2()) others.push_back(&kAvx2Loops);
  if (HasAvx512()) others.push_back(&kAvx512Loops);
  for (const LaneLoops* loops : others) {
    LaneLikelihood m = asked;
    loops->likelihood(m);
    EXPECT_EQ(m.count, baseline.count);
    for (std::size_t i = 0; i < asked.lanes; ++i) {
      EXPECT_NEAR(m.squares[i], baseline.squares[i], 1e-9 * baseline.squares[i]) << i;
      EXPECT_NEAR(m.logs[i], baseline.logs[i], 1e-9 * std::fabs(baseline.logs[i])) << i;
    }
  }
}

}  // namespace
}  // namespace contour::diagnosis
