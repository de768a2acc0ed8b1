// Waves that the scans propose, and the pulse response that they are matched with.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "analysis/diagnosis/screening/score.h"
#include "tests/analysis/support/fitted_axis.h"

namespace contour::diagnosis {
namespace {

/// Long enough for the stroke in both directions, which tells a torque from a friction.
test::FittedAxis With(std::vector<test::HiddenEffect> effects) {
  test::HiddenOptions o = test::FittedAxis::Short(std::move(effects));
  o.duration_s = 14.0;
  return test::FittedAxis(o);
}

/// Orders proposed of a kind, the best first.
std::vector<double> Proposed(const test::FittedAxis& axis, const std::string& kind) {
  std::vector<double> out;
  for (const SharedEffect& e : ScanWaves(axis.problem, axis.base))
    if (e->kind == kind) out.push_back(e->order);
  return out;
}

TEST(ScanWaves, FindsTheOrderOfATorqueAndOfAFriction) {
  const test::FittedAxis axis =
      With({{"cogging", 0.2, 12.0, 0.4, 0.0}, {"friction_ripple", 0.2, 3.0, 1.0, 0.0}});
  const std::vector<double> torque = Proposed(axis, "cogging"), friction = Proposed(axis, "friction_ripple");
  ASSERT_FALSE(torque.empty() || friction.empty());
  EXPECT_EQ(torque[0], 12.0);
  EXPECT_EQ(friction[0], 3.0);
}

TEST(ScanWaves, FindsAFrequencyAndTheLinesOfAnEncoder) {
  const test::FittedAxis axis(
      {{"periodic_force", 0.3, 23.0, 0.4, 0.0}, {"encoder_subdivision", 0.3, 64.0, 1.0, 0.0}});
  ASSERT_FALSE(Proposed(axis, "periodic_force").empty());
  EXPECT_NEAR(Proposed(axis, "periodic_force")[0], 23.0, 1.0 / 8.0) << "as the log of 8 s resolves it";
  ASSERT_FALSE(Proposed(axis, "encoder_subdivision").empty());
  EXPECT_EQ(Proposed(axis, "encoder_subdivision")[0], 64.0);
}

TEST(ScanWaves, OrdersOfOneKindAreApart) {
  const test::FittedAxis axis;
  for (const char* kind : {"cogging", "friction_ripple", "ball_ripple", "periodic_force"}) {
    const std::vector<double> orders = Proposed(axis, kind);
    EXPECT_LE(orders.size(), 2u) << kind;
    if (orders.size() == 2) {
      EXPECT_GT(std::fabs(orders[0] - orders[1]), 1e-3) << kind;
    }
  }
}

TEST(PulseResponse, IsThatOfARunOfTheModelInAnotherSlideToo) {
  const test::FittedAxis axis;
  const Problem& problem = axis.problem;
  const Signals& s = *problem.signals;
  // The middle of a slide of 60 rows before and after.
  std::size_t row = 0, since = 0;
  for (std::size_t k = 1; k < problem.rows() && row == 0; ++k) {
    if (problem.counted[k] == 0 || std::fabs(s.velocity[k]) < 0.2 * s.max_speed) since = k;
    if (k - since == 120) row = k - 60;
  }
  ASSERT_GT(row, 0u);
  const double torque = 0.01 * s.coulomb;
  AxisModel pulsed = problem.Build(axis.base.point);
  // Constant over the row: two elements per row.
  auto pulse = std::make_shared<Signal>(2 * problem.rows(), 0.0);
  (*pulse)[row] = (*pulse)[problem.rows() + row] = torque;
  pulsed.motor_force = pulse;
  const AxisModel models[] = {pulsed};
  const std::vector<double> white =
      problem.White(problem.Raw(std::span<const AxisModel>(models), Extent::kWhole))[0];
  const std::vector<double> response = PulseResponse(problem, false);
  double products = 0.0, own = 0.0, other = 0.0;
  for (std::size_t i = 0; i < 40; ++i) {
    // A torque over this row shows in the next reading.
    const std::size_t k = row + 1 + i;
    const double weight = problem.root_weight[k];
    if (weight <= 0.0) continue;
    const double run = (white[k] - axis.base.residual[k]) / (torque * weight);
    products += run * response[i];
    own += run * run;
    other += response[i] * response[i];
  }
  EXPECT_GT(products / std::sqrt(own * other), 0.9) << "the same shape";
  EXPECT_NEAR(products / other, 1.0, 0.2) << "and the same size";
}

TEST(PulseResponse, OfAReadingBeginsAtOnceAndIsOverSoon) {
  const test::FittedAxis axis;
  const std::vector<double> h = PulseResponse(axis.problem, true);
  ASSERT_GT(h.size(), 100u);
  double first = 0.0, rest = 0.0;
  for (std::size_t k = 0; k < h.size(); ++k) (k < 30 ? first : rest) += h[k] * h[k];
  EXPECT_GT(h[0] * h[0], 0.1 * first);
  EXPECT_LT(rest, 0.05 * first);
}

}  // namespace
}  // namespace contour::diagnosis
