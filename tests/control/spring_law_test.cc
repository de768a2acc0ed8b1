#include "control/spring_law.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/spring_loop.h"
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

/// With loops that know two inertias.
PerAxis<ControlledAxis> AxesWithLoops() {
  PerAxis<ControlledAxis> axes = test::NominalAxes(2);
  for (ControlledAxis& a : axes) {
    const LoopTuning tuning{.regulator_Hz = 12.0,
                            .windup_weight = 0.2,
                            .velocity_weight = 0.35,
                            .disturbance_Hz = 100.0,
                            .motor_force_Hz = 400.0,
                            .table_force_Hz = 60.0,
                            .notch_ratio = 0.7,
                            .notch_pole_damping = 0.7,
                            .notch_zero_damping = 0.2};
    a.loop = a.softer_loop =
        DesignLoop(ToTwoInertiaAxis(a.mechanics, 500.0, a.lag_s, 1), tuning, test::kPeriod_s, false);
  }
  return axes;
}

// A damping of its own excited the screw's mode through the observer of a catalogue's loop.
TEST(SpringLaw, OfALoopThatKnowsTwoInertiasIsThatLoopWeaker) {
  const PerAxis<ControlledAxis> axes = AxesWithLoops();
  ControllerConfig config;
  config.friction = FrictionKind::kLinear;
  ContourController controller(ControllerName::kFull, config, axes, test::kPeriod_s);
  ControlInput in = OneAxisSprung();
  for (ReferencePoint& p : in.reference[1]) p.extra_torque_Nm = 0.1;
  in.estimate[1].motion = {1e-5, 0.0, 1e-5, 0.0, 0.0};
  in.estimate[1].disturbance_N = 50.0;
  ControlOutput out;
  controller.Step(in, out);
  const TwoInertiaLoop spring = SpringLoop(*axes[1].loop, kSpring_N_m);
  const double positions_N_m = spring.regulator_motion[0] + spring.regulator_motion[2];
  EXPECT_NEAR(out.force_N[1], -positions_N_m * 1e-5, 1e-9) << "and no disturbance is answered";
  EXPECT_EQ(out.feedforward_N[1], 0.0);

  // What the experiment puts on is no deviation: commands that carry it are answered as those without.
  const double extra_N = 0.1 / axes[1].mechanics.radius_m_rad;
  for (int cycle = 0; cycle < 50; ++cycle) {
    in.previous_force_N[1] = out.force_N[1] + extra_N;
    in.estimate[1].motion[4] = in.previous_force_N[1];
    controller.Step(in, out);
  }
  EXPECT_NEAR(out.force_N[1], -kSpring_N_m * 1e-5, 0.02 * kSpring_N_m * 1e-5);
}

// Else the axis gives way under it by weight over stiffness when the spring takes over.
TEST(SpringLaw, AStatedWeightIsLed) {
  const PerAxis<ControlledAxis> axes = AxesWithLoops();
  ControlInput in = OneAxisSprung();
  for (AxisEstimate& e : in.estimate) e.predicted_position_m = e.predicted_velocity_m_s = 0.0;
  in.stated.resize(2);
  in.stated[1] = {-30.0, -170.0};
  for (const ControllerName name : {ControllerName::kPid, ControllerName::kMpc}) {
    ContourController controller(name, ControllerConfig{}, axes, test::kPeriod_s);
    ControlOutput out;
    controller.Step(in, out);
    EXPECT_NEAR(out.force_N[1], 200.0, 1e-9) << Name(name);
    EXPECT_EQ(out.feedforward_N[1], 200.0);
  }
  // Where the table stands at its reference, wound up against the weight, nothing is amiss.
  ControllerConfig config;
  config.friction = FrictionKind::kLinear;
  ContourController controller(ControllerName::kFull, config, axes, test::kPeriod_s);
  in.previous_force_N[1] = 200.0;
  in.estimate[1].motion = {170.0 / axes[1].mechanics.stiffness_N_m, 0.0, 0.0, 0.0, 200.0};
  for (int cycle = 0; cycle < 50; ++cycle) {
    ControlOutput out;
    controller.Step(in, out);
    EXPECT_NEAR(out.force_N[1], 200.0, 1e-6) << cycle;
    in.previous_force_N[1] = out.force_N[1];
  }
}

TEST(SpringLaw, ADriveThatClosesItsOwnLoopIsNotReplaced) {
  ContourController controller(ControllerName::kFull, ControllerConfig{}, test::NominalAxes(2), 1e-3, true);
  EXPECT_FALSE(controller.HoldsBySpring(OneAxisSprung(), 1));
}

}  // namespace
}  // namespace contour
