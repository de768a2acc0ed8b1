#include "control/spring_law.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/control/support/contour_loop.h"

namespace contour {
namespace {

constexpr double kSpring_N_m = 2e5;

/// Two axes off their reference; the second is to be held by a spring.
ControlInput OneAxisSprung() {
  ControlInput in;
  in.estimate.resize(2);
  in.reference.resize(2);
  in.friction.resize(2);
  in.previous_force_N.resize(2);
  for (std::size_t i = 0; i < 2; ++i) {
    in.estimate[i].predicted_position_m = 1e-5;
    in.estimate[i].predicted_velocity_m_s = 2e-3;
    in.reference[i].resize(kMaxHorizonPoints);
    in.friction[i].resize(kMaxHorizonPoints);
  }
  for (ReferencePoint& p : in.reference[1]) p.spring_N_m = kSpring_N_m;
  return in;
}

TEST(SpringLaw, ADampedSpringHoldsTheAxisThatAnExperimentAsksFor) {
  const PerAxis<ControlledAxis> axes = test::NominalAxes(2);
  const ControlInput in = OneAxisSprung();
  for (const ControllerName name : {ControllerName::kPid, ControllerName::kMpc, ControllerName::kFull}) {
    ContourController controller(name, ControllerConfig{}, axes, 1e-3);
    EXPECT_FALSE(controller.HoldsBySpring(in, 0));
    EXPECT_TRUE(controller.HoldsBySpring(in, 1));
    ControlOutput out;
    controller.Step(in, out);
    const double damping_Ns_m = 1.4 * std::sqrt(kSpring_N_m * axes[1].mechanics.mass_kg);
    EXPECT_NEAR(out.force_N[1], -kSpring_N_m * 1e-5 - damping_Ns_m * 2e-3, 1e-9);
    EXPECT_EQ(out.feedforward_N[1], 0.0);
    EXPECT_GT(std::abs(out.force_N[0] - out.force_N[1]), 0.1) << "the law holds the other";
  }
}

TEST(SpringLaw, ADriveThatClosesItsOwnLoopIsNotReplaced) {
  ContourController controller(ControllerName::kFull, ControllerConfig{}, test::NominalAxes(2), 1e-3, true);
  EXPECT_FALSE(controller.HoldsBySpring(OneAxisSprung(), 1));
}

}  // namespace
}  // namespace contour
