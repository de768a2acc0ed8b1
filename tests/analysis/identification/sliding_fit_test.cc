#include "analysis/identification/sliding_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/analysis/identification/generated_axis.h"

namespace contour::test {
namespace {

using identify::Measured;
using identify::TableAxis;

double Nothing(double) { return 0.0; }

TEST(SlidingFitTest, FindsMassLevelsStribeckVelocityAndViscousFriction) {
  const TableAxis truth = Exactly(PlainAxis());
  const auto fit = identify::FitSliding(identify::Kinematics(SlidingRecord(), 1e-3, 0.2e-3, 4, 4), 1.0,
                                        truth.radius_m_rad);
  ASSERT_TRUE(fit.found) << fit.why_not;
  EXPECT_NEAR(fit.mass_kg / truth.mass_kg(), 1.0, 0.03);
  EXPECT_NEAR(fit.Fc_plus_N / truth.friction.Fc_plus, 1.0, 0.03);
  EXPECT_NEAR(fit.Fc_minus_N / truth.friction.Fc_minus, 1.0, 0.03);
  EXPECT_NEAR(fit.Fs_plus_N / truth.friction.Fs_plus, 1.0, 0.05);
  EXPECT_NEAR(fit.Fs_minus_N / truth.friction.Fs_minus, 1.0, 0.05);
  EXPECT_NEAR(fit.sigma2_Ns_m / truth.friction.s2, 1.0, 0.05);
  EXPECT_NEAR(fit.vs_m_s / truth.friction.vs, 1.0, 0.25);
}

/// A weight larger than friction: down it goes by itself.
TEST(SlidingFitTest, AWeightIsNoFriction) {
  const TableAxis truth = Exactly(PlainAxis());
  const double weight_N = 1.3 * truth.friction.Fc_minus;
  auto instants = identify::Kinematics(SlidingRecord(), 1e-3, 0.2e-3, 4, 4);
  for (identify::Instant& i : instants) i.force_N += weight_N;
  const auto fit = identify::FitSliding(instants, 1.0, truth.radius_m_rad);
  ASSERT_TRUE(fit.found) << fit.why_not;
  const double mean_N = 0.5 * (truth.friction.Fc_plus + truth.friction.Fc_minus);
  EXPECT_NEAR(fit.Fc_plus_N / mean_N, 1.0, 0.03);
  EXPECT_NEAR(fit.Fc_minus_N / mean_N, 1.0, 0.03);
  const double half_N = 0.5 * (truth.friction.Fc_plus - truth.friction.Fc_minus);
  EXPECT_NEAR(fit.offset_N / -(weight_N + half_N), 1.0, 0.03);
}

TEST(SlidingFitTest, OneDirectionOnlyIsRefusedWithTheReason) {
  GeneratedAxis axis{PlainAxis()};
  const Measured record = axis.Drive(
      4.0, [](double t) { return 1e-3 * t * t; }, Nothing);
  const auto fit = identify::FitSliding(identify::Kinematics(record, 1e-3, 0.2e-3, 4, 4), 1.0, 8e-4);
  EXPECT_FALSE(fit.found);
  EXPECT_NE(fit.why_not.find("both directions"), std::string::npos) << fit.why_not;
}

TEST(StribeckPointsTest, LieOnTheCurveOfTheAxis) {
  const TableAxis truth = Exactly(PlainAxis());
  const auto points =
      identify::StribeckPoints(identify::Kinematics(SlidingRecord(), 1e-3, 0.2e-3, 4, 4), truth);
  ASSERT_GE(points.size(), 10U);
  for (const identify::StribeckPoint& p : points) {
    const bool up = p.velocity_m_s > 0.0;
    const double fc = up ? truth.friction.Fc_plus : truth.friction.Fc_minus;
    const double fs = up ? truth.friction.Fs_plus : truth.friction.Fs_minus;
    const double speed = std::fabs(p.velocity_m_s);
    const double expected = fc + (fs - fc) * std::exp(-speed / 2e-3) + 500.0 * speed;
    EXPECT_NEAR(std::fabs(p.friction_N), expected, 0.02 * expected) << "at " << p.velocity_m_s;
  }
}

}  // namespace
}  // namespace contour::test
