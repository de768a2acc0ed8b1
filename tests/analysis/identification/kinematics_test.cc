#include "analysis/identification/kinematics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/analysis/identification/generated_axis.h"

namespace contour::test {
namespace {

using identify::Measured;
using identify::TableAxis;

TEST(KinematicsTest, ForceIsMassTimesAccelerationForWhatIsHeld) {
  // A free mass under a held, delayed force, solved by hand: x_{k+1} = x_k + v_k T + a_k T^2 / 2.
  Measured d;
  d.period_s = 1e-3;
  double x = 0.0;
  double v = 0.0;
  constexpr double kMass = 40.0;
  for (int k = 0; k < 400; ++k) {
    d.force_N.push_back(30.0 * std::sin(0.3 * k) + 0.1 * k);
    d.position_m.push_back(x);
    d.present.push_back(k == 200 ? 0 : 1);
    const double a = k > 0 ? d.force_N[static_cast<std::size_t>(k) - 1] / kMass : 0.0;
    x += v * 1e-3 + 0.5 * a * 1e-6;
    v += a * 1e-3;
  }
  const auto instants = identify::Kinematics(d, 1e-3, 0.0, 3, 1);
  ASSERT_GT(instants.size(), 300U);
  for (const identify::Instant& i : instants) {
    if (i.row < 10) continue;
    EXPECT_NEAR(i.force_N, kMass * i.acceleration_m_s2, 1e-6);
    EXPECT_GT(std::abs(static_cast<int>(i.row) - 200), 3) << "a row next to the missing one was used";
  }
}

TEST(KinematicsTest, DelayAndLagShiftTheForce) {
  Measured d;
  d.period_s = 1e-3;
  for (int k = 0; k < 100; ++k) {
    d.force_N.push_back(static_cast<double>(k));
    d.position_m.push_back(1e-3 * k);
    d.present.push_back(1);
  }
  // A ramp of 1 N per period: force of the periods before and after row k, 1.3 periods earlier.
  for (const identify::Instant& i : identify::Kinematics(d, 1.1e-3, 0.2e-3, 2, 1)) {
    if (i.row < 10) continue;
    EXPECT_NEAR(i.force_N, static_cast<double>(i.row) - 0.5 - 1.3, 1e-9);
    EXPECT_NEAR(i.velocity_m_s, 1.0, 1e-9);
    EXPECT_NEAR(i.acceleration_m_s2, 0.0, 1e-6);
  }
}

TEST(KinematicsTest, WayCountsFromTheLastTurn) {
  Measured d;
  d.period_s = 1e-3;
  for (int k = 0; k < 200; ++k) {
    d.force_N.push_back(0.0);
    d.position_m.push_back(1e-3 * (k < 100 ? k : 200 - k));
    d.present.push_back(1);
  }
  const auto instants = identify::Kinematics(d, 0.0, 0.0, 2, 1);
  EXPECT_NEAR(instants.back().since_reversal_m, 1e-3 * static_cast<double>(instants.back().row - 100), 3e-3);
  EXPECT_LT(instants.back().velocity_m_s, 0.0);
}

}  // namespace
}  // namespace contour::test
