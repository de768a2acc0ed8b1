#include "estimator/stiffness_evidence.h"

#include <gtest/gtest.h>

namespace contour {
namespace {

constexpr double kLevel_N = 40.0;
constexpr double kSigma0_N_m = 5e6;
constexpr double kPeriod_s = 1e-3;

StiffnessEvidence::Tuning Axis() { return {kSigma0_N_m, 89.0, 0.05, 0.02, kPeriod_s}; }

/// The bristle goes from one level to the other at constant acceleration, with `log_sigma0` believed; the
/// periods in which it was said to show.
int Passage(StiffnessEvidence& evidence, double acceleration_m_s2, double log_sigma0,
            double torque_step_N = 0.0, double surprise = 0.0) {
  int shows = 0;
  StiffnessEvidence::Sample s;
  s.level_N = kLevel_N;
  s.acceleration_m_s2 = acceleration_m_s2;
  s.torque_step_N = torque_step_N;
  s.surprise = surprise;
  for (double t = 0.0; t < 0.2; t += kPeriod_s) {
    s.velocity_m_s = acceleration_m_s2 * t;
    s.travel_m = 0.5 * acceleration_m_s2 * t * t;
    s.bristle_N = kLevel_N * (1.0 - 2.0 * std::exp(-s.travel_m * kSigma0_N_m / kLevel_N));
    evidence.See(s, log_sigma0);
    shows += evidence.shows() ? 1 : 0;
  }
  return shows;
}

TEST(StiffnessEvidence, AReversalOfACircleTellsAndIsKept) {
  StiffnessEvidence evidence(Axis());
  EXPECT_GE(Passage(evidence, 0.25, 0.2), 3);
  EXPECT_DOUBLE_EQ(evidence.kept(), 0.2);
  evidence.Rest();
  EXPECT_FALSE(evidence.shows());
  EXPECT_DOUBLE_EQ(evidence.kept(), 0.2);
  evidence.Forget();
  EXPECT_DOUBLE_EQ(evidence.kept(), 0.0);
}

TEST(StiffnessEvidence, ACornerTellsNothing) {
  StiffnessEvidence evidence(Axis());
  EXPECT_EQ(Passage(evidence, 5.0, 1.0), 0) << "the inertial force is known to 22 N";
  EXPECT_EQ(Passage(evidence, 0.25, 1.0, 1000.0), 0) << "a torque that changes fast";
  EXPECT_EQ(Passage(evidence, 0.25, 1.0, 0.0, 5.0), 0) << "a model that contradicts itself";
  EXPECT_DOUBLE_EQ(evidence.kept(), 0.0);
}

TEST(StiffnessEvidence, NeitherDoesSlidingOrMovingTooFastToBeSeen) {
  StiffnessEvidence evidence(Axis());
  StiffnessEvidence::Sample s;
  s.level_N = kLevel_N;
  s.velocity_m_s = 1e-3;
  evidence.See(s, 0.0);
  // A level that is estimated too high looks like presliding; so much travel says that it is not.
  s.bristle_N = 0.5 * kLevel_N;
  s.travel_m = 1e-4;
  evidence.See(s, 1.0);
  EXPECT_FALSE(evidence.matters());
  s.travel_m = 1e-6;
  evidence.See(s, 1.0);
  EXPECT_TRUE(evidence.shows());
  s.velocity_m_s = 0.02;
  evidence.See(s, 1.0);
  EXPECT_FALSE(evidence.shows());
}

// The same in units of the axis's own: nothing depends on newtons.
TEST(StiffnessEvidence, IsTheSameOnAnAxisTenTimesAsStrong) {
  StiffnessEvidence::Tuning heavy = Axis();
  heavy.mass_kg *= 10.0;
  heavy.sigma0_N_m *= 10.0;
  StiffnessEvidence small(Axis()), large(heavy);
  StiffnessEvidence::Sample s;
  s.acceleration_m_s2 = 0.5;
  for (int k = 0; k < 30; ++k) {
    s.velocity_m_s = 0.5e-3 * k;
    s.travel_m = 0.25e-6 * k * k;
    s.bristle_N = kLevel_N * (1.0 - 2.0 * std::exp(-s.travel_m * kSigma0_N_m / kLevel_N));
    s.level_N = kLevel_N;
    StiffnessEvidence::Sample t = s;
    t.bristle_N *= 10.0;
    t.level_N *= 10.0;
    small.See(s, 0.1);
    large.See(t, 0.1);
    EXPECT_EQ(small.shows(), large.shows()) << k;
  }
}

}  // namespace
}  // namespace contour
