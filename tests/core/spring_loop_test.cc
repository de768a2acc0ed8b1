#include "core/spring_loop.h"

#include <gtest/gtest.h>

#include <cmath>

namespace contour {
namespace {

constexpr TwoInertiaAxis kAxis{.motor_mass_kg = 174.0,
                               .table_mass_kg = 64.0,
                               .stiffness_N_m = 117e6,
                               .damping_Ns_m = 7637.0,
                               .viscous_Ns_m = 1170.0,
                               .lag_s = 0.3e-3};
constexpr LoopTuning kTuning{.regulator_Hz = 12.6,
                             .windup_weight = 0.0897,
                             .velocity_weight = 0.0683,
                             .disturbance_Hz = 82.5,
                             .motor_force_Hz = 2070.0,
                             .table_force_Hz = 218.0,
                             .notch_ratio = 0.5,
                             .notch_pole_damping = 1.28,
                             .notch_zero_damping = 0.458};

class SpringLoopTest : public testing::TestWithParam<std::size_t> {
 protected:
  static TwoInertiaLoop Loop() {
    TwoInertiaAxis axis = kAxis;
    axis.delay_cycles = static_cast<int>(GetParam());
    return DesignLoop(axis, kTuning, 1e-3, false);
  }
};

// A command that stays: u = -(gains of positions) x - (gains of forces) u.
TEST_P(SpringLoopTest, HoldsAsStifflyAsItIsAskedTo) {
  const TwoInertiaLoop loop = Loop();
  const double stiffest_N_m = StiffestSpring_N_m(loop);
  EXPECT_NEAR(stiffest_N_m, 0.5 * HoldingStiffness_N_m(loop), 1e-9 * stiffest_N_m);
  for (const double share : {1.0, 0.5, 0.01}) {
    const TwoInertiaLoop spring = SpringLoop(loop, share * stiffest_N_m);
    EXPECT_NEAR(HoldingStiffness_N_m(spring), share * stiffest_N_m, 1e-9 * stiffest_N_m);
    EXPECT_EQ(spring.disturbance_to_command, 0.0) << "it answers nothing";
    EXPECT_EQ(spring.gain, loop.gain);
    EXPECT_EQ(spring.filter.b0, loop.filter.b0);
  }
}

TEST_P(SpringLoopTest, IsNeverStifferThanHalfOfTheLoopAndKeepsItsDampingRatio) {
  const TwoInertiaLoop loop = Loop();
  const SpringShares most = SharesOfSpring(loop, StiffestSpring_N_m(loop));
  EXPECT_LT(most.position, 1.0);
  EXPECT_EQ(SharesOfSpring(loop, 100.0 * StiffestSpring_N_m(loop)).position, most.position);
  const SpringShares weak = SharesOfSpring(loop, 0.05 * StiffestSpring_N_m(loop));
  EXPECT_LT(weak.position, most.position);
  EXPECT_NEAR(weak.position, weak.velocity * weak.velocity, 1e-12);
  EXPECT_EQ(SharesOfSpring(loop, 0.0).velocity, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Delays, SpringLoopTest, testing::Values(std::size_t{1}, std::size_t{3}));

}  // namespace
}  // namespace contour
