#include "analysis/diagnosis/decision/residual_trace.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "tests/analysis/support/fitted_axis.h"
#include "tests/analysis/support/known_axis.h"

namespace contour::diagnosis {
namespace {

constexpr std::size_t kPieces = 60;  // of time

/// Fits without base terms: what one amplitude does, its column and a residual.
class ConsistencyTest : public testing::Test {
 protected:
  ConsistencyTest() {
    std::mt19937_64 random(8);
    std::normal_distribution<double> normal;
    for (double& x : noise_) x = normal(random);
    auto effect = std::make_shared<Effect>();
    effect->kind = "constant_torque";
    effect->tested = 1;
    without_.jacobian = Eigen::MatrixXd(Size(), 0);
    without_.residual = noise_;
    with_.point.effects = {effect};
    with_.point.amplitudes = {{0.0}};
    with_.jacobian = Eigen::MatrixXd::Zero(Size(), 1);
    with_.residual = noise_;
  }

  Eigen::Index Size() const { return static_cast<Eigen::Index>(axis_.problem.data_size()); }
  std::size_t Rows() const { return axis_.problem.rows(); }
  std::size_t Begin(std::size_t piece) const { return Rows() * piece / kPieces; }

  test::KnownAxis axis_{{.scale = false}};
  std::vector<double> noise_ = std::vector<double>(test::KnownAxis::kRows);
  Fit without_, with_;
};

TEST_F(ConsistencyTest, IsTheRootOfThePiecesWhereAllOfThemLoseTheSame) {
  // As much in every piece: 60 equal differences over the root of the sum of their squares.
  without_.residual.assign(Rows(), 2.0);
  with_.residual.assign(Rows(), 1.0);
  EXPECT_NEAR(Consistency(axis_.problem, without_, with_, false), std::sqrt(60.0), 0.01);
}

TEST_F(ConsistencyTest, IsOneWhereASinglePieceCarriesIt) {
  for (std::size_t k = Begin(20); k < Begin(21); ++k) without_.residual[k] += 5.0;
  EXPECT_NEAR(Consistency(axis_.problem, without_, with_, false), 1.0, 1e-9);
}

TEST_F(ConsistencyTest, UnseenPiecesAreJudgedByWhatAllOthersSay) {
  // A column of ones; the residual of a fit has its mean taken out.
  with_.jacobian.setOnes();
  const double missing = 0.3;
  for (double& x : without_.residual) x += missing;
  const double mean =
      std::accumulate(without_.residual.begin(), without_.residual.end(), 0.0) / static_cast<double>(Rows());
  for (std::size_t k = 0; k < Rows(); ++k) with_.residual[k] = without_.residual[k] - mean;
  // Once more by hand: every piece with the mean of all the others.
  double sum = 0.0, squares = 0.0;
  for (std::size_t p = 0; p < kPieces; ++p) {
    double others = 0.0, before = 0.0, after = 0.0;
    for (std::size_t k = 0; k < Rows(); ++k)
      if (k < Begin(p) || k >= Begin(p + 1)) others += without_.residual[k];
    others /= static_cast<double>(Rows() - (Begin(p + 1) - Begin(p)));
    for (std::size_t k = Begin(p); k < Begin(p + 1); ++k) {
      before += std::pow(without_.residual[k], 2);
      after += std::pow(without_.residual[k] - others, 2);
    }
    sum += before - after;
    squares += std::pow(before - after, 2);
  }
  EXPECT_NEAR(Consistency(axis_.problem, without_, with_, true), sum / std::sqrt(squares), 1e-6);
  EXPECT_GT(sum / std::sqrt(squares), 3.0);
}

TEST_F(ConsistencyTest, WhatOnePieceAloneTellsIsNotConfirmedByTheOthers) {
  // The column is there in one piece only, and fitted to the noise of it.
  double product = 0.0, square = 0.0;
  for (std::size_t k = Begin(30); k < Begin(31); ++k) {
    with_.jacobian(static_cast<Eigen::Index>(k), 0) = 1.0;
    without_.residual[k] += 1.0;
    product += without_.residual[k];
    square += 1.0;
  }
  // The other pieces know next to nothing, and that wrong.
  with_.jacobian(0, 0) = 1e-3;
  for (std::size_t k = Begin(30); k < Begin(31); ++k)
    with_.residual[k] = without_.residual[k] - product / square;
  EXPECT_LT(Consistency(axis_.problem, without_, with_, true),
            Consistency(axis_.problem, without_, with_, false));
}

class TraceTest : public testing::Test {
 protected:
  double MeanInSlides(const Signal& x) const {
    double sum = 0.0, count = 0.0;
    for (std::size_t k = 1000; k + 1000 < x.size(); ++k) {
      if (std::fabs(axis_.problem.signals->sign[k]) < 0.9) continue;
      sum += x[k];
      count += 1.0;
    }
    return sum / count;
  }

  // A torque of 0.3 Fc that the model does not have.
  test::FittedAxis axis_{{{"constant_torque", 0.3, 0.0, 0.0, 0.0}}};
  double torque_Nm_ = 0.3 * axis_.made.axis.stated.friction.Fc_plus;
  Fit with_ = axis_.With(axis_.Of("constant_torque"));
};

TEST_F(TraceTest, TheTorqueResidualIsWhatTheCommandHasTooMuch) {
  // What pushes without being commanded has to be put on the command: taken off, it is negative.
  EXPECT_NEAR(MeanInSlides(TorqueResidual(axis_.problem, axis_.made.point)), -torque_Nm_, 0.2 * torque_Nm_);
  EXPECT_NEAR(MeanInSlides(TorqueResidual(axis_.problem, with_.point)), 0.0, 0.1 * torque_Nm_);
}

TEST_F(TraceTest, RowsThatDoNotCountHaveNone) {
  Problem& problem = axis_.made.problem;
  problem.counted.assign(problem.rows(), 0);
  for (const double r : TorqueResidual(problem, axis_.made.point)) ASSERT_EQ(r, 0.0);
}

TEST_F(TraceTest, WhatIsThereGainsOnBlocksThatTheFitHasNotSeen) {
  Cause cause;
  std::vector<BlockGain> blocks;
  Fit stated = axis_.base;
  HeldOutGain(axis_.problem, stated, with_, false, cause, blocks);
  EXPECT_GT(cause.heldout_gain, 0.0);
  EXPECT_LE(cause.heldout_gain_low, cause.heldout_gain);
  EXPECT_GE(cause.heldout_gain_high, cause.heldout_gain);
  EXPECT_NEAR(cause.heldout_gain, 1.0 - cause.heldout_rms_after / cause.heldout_rms_before, 1e-9);
  EXPECT_EQ(cause.unit, "Nm");
  ASSERT_GT(blocks.size(), 1u);
  EXPECT_EQ(blocks.front().start_s, 0.0);
  EXPECT_NEAR(blocks.back().end_s, 8.0, 1e-9);
  for (std::size_t b = 1; b < blocks.size(); ++b) EXPECT_NEAR(blocks[b].start_s, blocks[b - 1].end_s, 1e-12);
}

TEST_F(TraceTest, TheSameModelGainsNothing) {
  Cause cause;
  std::vector<BlockGain> blocks;
  HeldOutGain(axis_.problem, with_, with_, false, cause, blocks);
  EXPECT_EQ(cause.heldout_gain, 0.0);
  EXPECT_EQ(cause.heldout_gain_low, 0.0);
  for (const BlockGain& b : blocks) EXPECT_EQ(b.gain, 0.0);
}

TEST_F(TraceTest, TracesAreMeasuredLessResidual) {
  const Traces t = MakeTraces(axis_.problem, axis_.base.point, with_.point);
  const std::size_t n = axis_.problem.rows();
  ASSERT_EQ(t.time_s.size(), n);
  EXPECT_NEAR(t.time_s[4321], 4.321, 1e-9);
  for (const std::size_t k : {10u, 2000u, 7000u}) {
    EXPECT_NEAR(t.simulated_before[k], t.measured[k] - t.residual_before[k], 1e-12);
    EXPECT_NEAR(t.simulated_after[k], t.measured[k] - t.residual_after[k], 1e-12);
    EXPECT_EQ(t.position[k], axis_.problem.signals->position[k]);
  }
  EXPECT_EQ(t.residual_after, TorqueResidual(axis_.problem, with_.point));
  EXPECT_TRUE(t.scale_before.empty() && t.temperature_degC.empty())
      << "there is neither scale nor thermometer";
}

}  // namespace
}  // namespace contour::diagnosis
