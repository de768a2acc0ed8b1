#include "control/contour_controller.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/control/support/contour_loop.h"
#include "tests/support/allocation_guard.h"

namespace contour {
namespace {

using test::Circle;
using test::ContourLoop;
using test::NominalAxes;

// 10 mm at 50 mm/s.
test::Path FastCircle() { return Circle(0.01, 0.05 / (2.0 * std::numbers::pi * 0.01)); }
test::Path SmallCircle() { return Circle(1e-4, 0.785); }

void MakeRigid(ContourLoop& loop) {
  for (test::ScrewAxis& plant : loop.plants) plant.rigid = true;
}

TEST(Mpc, FollowsASmoothPathExactlyWhenItsModelIsExact) {
  for (const double viscous : {0.0, 500.0}) {
    for (const auto& path : {FastCircle(), SmallCircle()}) {
      PerAxis<ControlledAxis> axes = NominalAxes(2);
      for (ControlledAxis& axis : axes) axis.viscous_Ns_m = viscous;
      ContourLoop loop(ControllerName::kMpc, ControllerConfig{}, axes, path);
      MakeRigid(loop);
      EXPECT_LT(loop.Run(2.0), 1e-9) << "viscous friction " << viscous;
    }
  }
}

TEST(Mpc, FullFollowsExactlyWithAKnownViscousFriction) {
  PerAxis<ControlledAxis> axes = NominalAxes(2);
  for (ControlledAxis& axis : axes) {
    axis.viscous_Ns_m = 500.0;
    axis.mechanics.stiffness_N_m = 1e15;  // no wind-up in a rigid plant
  }
  ContourLoop loop(ControllerName::kFull, ControllerConfig{}, axes, FastCircle());
  MakeRigid(loop);
  loop.friction = [](std::size_t, const ReferencePoint& a, const ReferencePoint& b) {
    return FrictionAhead{500.0 * a.velocity_m_s, 250.0 * (a.velocity_m_s + b.velocity_m_s)};
  };
  EXPECT_LT(loop.Run(2.0), 1e-9);
}

TEST(Full, PutsTheTableOnThePathThroughACompliantScrew) {
  PerAxis<ControlledAxis> axes = NominalAxes(2);
  for (ControlledAxis& axis : axes) axis.viscous_Ns_m = 500.0;
  const auto viscous = [](std::size_t, const ReferencePoint& a, const ReferencePoint& b) {
    return FrictionAhead{500.0 * a.velocity_m_s, 250.0 * (a.velocity_m_s + b.velocity_m_s)};
  };
  ContourLoop full(ControllerName::kFull, ControllerConfig{}, axes, FastCircle());
  full.friction = viscous;
  ContourLoop without_windup(ControllerName::kMpcSrukf7, ControllerConfig{}, axes, FastCircle());
  without_windup.friction = viscous;
  const double with = full.Run(2.0, true);
  const double without = without_windup.Run(2.0, true);
  EXPECT_LT(with, 0.03e-6);
  EXPECT_GT(without, 0.5e-6);  // 25 N of viscous friction on 40 N/um
}

TEST(Mpc, WithoutCompensationFrictionLeavesAnError) {
  // Fc / (mass weight-gain): what the missing integral action leaves.
  ContourLoop loop(ControllerName::kMpc, ControllerConfig{}, NominalAxes(2), SmallCircle());
  for (test::ScrewAxis& plant : loop.plants) {
    plant.coulomb_N = 40.0;
    plant.stiction_N = 50.0;
  }
  loop.Run(1.0);
  const double worst = loop.Run(2.0);
  EXPECT_GT(worst, 1e-6);
  EXPECT_LT(worst, 60e-6);
}

class EveryTorqueController : public ::testing::TestWithParam<ControllerName> {};

TEST_P(EveryTorqueController, ComesBackFromAKick) {
  ContourLoop loop(GetParam(), ControllerConfig{}, NominalAxes(2), Circle(0.0, 1.0));
  loop.plants[0].motor_m = loop.plants[0].table_m = 50e-6;
  loop.plants[1].motor_m_s = loop.plants[1].table_m_s = -2e-3;
  loop.Run(0.5);
  EXPECT_LT(loop.Run(0.1), 0.05e-6);
}

TEST_P(EveryTorqueController, FollowsACircle) {
  ContourLoop loop(GetParam(), ControllerConfig{}, NominalAxes(2), FastCircle());
  EXPECT_LT(loop.Run(2.0), 2e-6);
}

TEST_P(EveryTorqueController, StaysStableWithTwiceTheLoopGain) {
  ContourLoop loop(GetParam(), ControllerConfig{}, NominalAxes(2), FastCircle());
  for (test::ScrewAxis& plant : loop.plants) plant.gain = 2.0;
  loop.Run(1.0);
  const double early = loop.Run(1.0);
  const double late = loop.Run(1.0);
  EXPECT_LT(late, 1.05 * early);
  EXPECT_LT(late, 300e-6);  // the feed-forward is twice what it should be, too
}

TEST_P(EveryTorqueController, DoesNotWindUpAtTheTorqueLimit) {
  // The whole reference jumps by 5 mm, far more than the torque can do at once.
  ContourLoop loop(GetParam(), ControllerConfig{}, NominalAxes(2), [](std::size_t axis, double time_s) {
    return ReferencePoint{time_s > 0.1 && axis == 0 ? 5e-3 : 0.0, 0.0, 0.0};
  });
  bool limited = false;
  double highest = 0.0;
  const double limit = test::NominalAxis().limits.force_N;
  for (int n = 0; n < 500; ++n) {
    loop.Step();
    EXPECT_LE(std::abs(loop.output.force_N[0]), limit);
    limited = limited || loop.output.limit[0] == Reason::kTorqueLimit;
    highest = std::max(highest, loop.plants[0].motor_m);
  }
  EXPECT_TRUE(limited);
  EXPECT_LT(highest, 7e-3);  // a wound-up integral would overshoot by the jump itself
  EXPECT_LT(loop.Run(0.2), 2e-6);
}

TEST_P(EveryTorqueController, KeepsTheRateLimit) {
  PerAxis<ControlledAxis> axes = NominalAxes(2);
  for (ControlledAxis& axis : axes) axis.limits.force_rate_N_s = 40000.0;
  // The MPC plans within the rate; a PID that meets it on a large jump swings for good, like any linear law.
  const double jump = GetParam() == ControllerName::kPid ? 2e-6 : 5e-4;
  ContourLoop loop(GetParam(), ControllerConfig{}, axes, [jump](std::size_t axis, double time_s) {
    return ReferencePoint{time_s > 0.1 && axis == 0 ? jump : 0.0, 0.0, 0.0};
  });
  bool limited = false;
  double before = 0.0;
  for (int n = 0; n < 700; ++n) {
    loop.Step();
    EXPECT_LE(std::abs(loop.output.force_N[0] - before), 40.0 * (1.0 + 1e-9));
    before = loop.output.force_N[0];
    limited = limited || loop.output.limit[0] == Reason::kTorqueRateLimit;
  }
  EXPECT_TRUE(limited);
  EXPECT_LT(loop.Run(0.2), 2e-6);
}

TEST_P(EveryTorqueController, TreatsItsAxesAlike) {
  ContourLoop loop(GetParam(), ControllerConfig{}, NominalAxes(2), FastCircle());
  ContourLoop swapped(GetParam(), ControllerConfig{}, NominalAxes(2),
                      [path = FastCircle()](std::size_t axis, double t) { return path(1 - axis, t); });
  loop.plants[0].motor_m = loop.plants[0].table_m = 30e-6;
  swapped.plants[1].motor_m = swapped.plants[1].table_m = 30e-6;
  for (int n = 0; n < 500; ++n) {
    loop.Step();
    swapped.Step();
    ASSERT_NEAR(loop.output.force_N[0], swapped.output.force_N[1], 1e-6);
    ASSERT_NEAR(loop.output.force_N[1], swapped.output.force_N[0], 1e-6);
  }
}

TEST_P(EveryTorqueController, RunsAnyNumberOfAxes) {
  for (std::size_t axes = 1; axes <= kMaxAxes; ++axes) {
    ContourLoop loop(GetParam(), ControllerConfig{}, NominalAxes(axes), FastCircle());
    EXPECT_LT(loop.Run(0.3), 5e-6) << axes << " axes";
    EXPECT_EQ(loop.output.force_N.size(), axes);
  }
}

TEST_P(EveryTorqueController, DoesNotTouchTheHeap) {
  if (!test::AllocationGuard::kAvailable) GTEST_SKIP() << "the sanitizer owns the heap";
  PerAxis<ControlledAxis> axes = NominalAxes(3);
  for (ControlledAxis& axis : axes) axis.limits.force_rate_N_s = 40000.0;
  ContourLoop loop(GetParam(), ControllerConfig{}, axes, FastCircle());
  loop.plants[0].motor_m = loop.plants[0].table_m = 1e-3;
  loop.Run(0.05);
  ContourController controller(GetParam(), ControllerConfig{}, axes, test::kPeriod_s);
  ControlOutput output;
  const test::AllocationGuard guard;
  controller.Reset();
  for (int n = 0; n < 5; ++n) {
    controller.Plan(loop.input, true);
    controller.Step(loop.input, output);
  }
  EXPECT_EQ(guard.calls(), 0u);
}

TEST_P(EveryTorqueController, PassesOnWhatIsNoNumberForTheGuardToSee) {
  ContourLoop loop(GetParam(), ControllerConfig{}, NominalAxes(2), FastCircle());
  loop.Run(0.1);
  loop.plants[0].motor_m = std::numeric_limits<double>::quiet_NaN();
  loop.Step();
  EXPECT_FALSE(std::isfinite(loop.output.force_N[0]));
}

TEST_P(EveryTorqueController, ForgetsEverythingOnReset) {
  ContourLoop loop(GetParam(), ControllerConfig{}, NominalAxes(2), FastCircle());
  loop.plants[0].motor_m = 1e-3;
  loop.Run(0.2);
  ContourController used(GetParam(), ControllerConfig{}, NominalAxes(2), test::kPeriod_s);
  ContourController fresh(GetParam(), ControllerConfig{}, NominalAxes(2), test::kPeriod_s);
  ControlOutput a, b;
  for (int n = 0; n < 20; ++n) used.Step(loop.input, a);
  used.Reset();
  used.Step(loop.input, a);
  fresh.Step(loop.input, b);
  EXPECT_EQ(a.force_N[0], b.force_N[0]);
  EXPECT_EQ(a.force_N[1], b.force_N[1]);
}

TEST_P(EveryTorqueController, RestsWithoutForceAndGoesOnAsAfterAReset) {
  ContourLoop loop(GetParam(), ControllerConfig{}, NominalAxes(2), FastCircle());
  loop.plants[0].motor_m = 1e-3;
  loop.Run(0.2);
  ContourController used(GetParam(), ControllerConfig{}, NominalAxes(2), test::kPeriod_s);
  ContourController fresh(GetParam(), ControllerConfig{}, NominalAxes(2), test::kPeriod_s);
  ControlOutput a, b;
  for (int n = 0; n < 20; ++n) used.Step(loop.input, a);
  ASSERT_NE(a.force_N[0], 0.0);
  used.Rest(a);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(a.force_N[i], 0.0);
    EXPECT_EQ(a.feedforward_N[i], 0.0);
    EXPECT_EQ(a.limit[i], Reason::kNone);
  }
  EXPECT_EQ(a.iterations, 0);
  used.Step(loop.input, a);
  fresh.Step(loop.input, b);
  EXPECT_EQ(a.force_N[0], b.force_N[0]);
  EXPECT_EQ(a.force_N[1], b.force_N[1]);
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryTorqueController,
                         ::testing::Values(ControllerName::kPid, ControllerName::kMpc, ControllerName::kFull),
                         [](const auto& name) { return std::string(Name(name.param)); });

TEST(Csp, TargetsAreTheReferenceOfTheNextGridPoint) {
  const PerAxis<ControlledAxis> axes = NominalAxes(2);
  ContourLoop loop(ControllerName::kCsp, ControllerConfig{}, axes, FastCircle());
  for (int n = 0; n < 900; ++n) loop.Step();
  const double start_of_next =
      loop.time_s + test::kPeriod_s;  // the Step computed for [time_s, time_s + period)
  EXPECT_DOUBLE_EQ(loop.output.target_position_m[0], FastCircle()(0, start_of_next).position_m);
  EXPECT_EQ(loop.output.force_N[0], 0.0);
  EXPECT_NEAR(loop.output.feedforward_N[0],
              axes[0].mechanics.mass_kg * FastCircle()(0, loop.time_s + 0.5e-3).acceleration_m_s2, 0.01);
}

TEST(Csp, SendsTheFeedforwardAsTorqueOffsetWhenAsked) {
  ControllerConfig config;
  config.csp.torque_offset = true;
  ContourLoop loop(ControllerName::kCsp, config, NominalAxes(2), FastCircle());
  for (int n = 0; n < 900; ++n) loop.Step();
  EXPECT_NE(loop.output.force_N[0], 0.0);
  EXPECT_EQ(loop.output.force_N[0], loop.output.feedforward_N[0]);
}

TEST(Mpc, ContourErrorIsWeighedMoreThanLag) {
  // A straight path along x; the same kick across and along.
  const auto line = [](std::size_t axis, double t) {
    return ReferencePoint{axis == 0 ? 0.05 * t : 0.0, axis == 0 ? 0.05 : 0.0, 0.0};
  };
  ContourLoop along(ControllerName::kMpc, ControllerConfig{}, NominalAxes(2), line);
  ContourLoop across(ControllerName::kMpc, ControllerConfig{}, NominalAxes(2), line);
  for (ContourLoop* loop : {&along, &across}) {
    for (test::ScrewAxis& plant : loop->plants) plant.rigid = true;
    loop->plants[0].motor_m_s = loop->plants[0].table_m_s = 0.05;
  }
  along.plants[0].motor_m = along.plants[0].table_m = 20e-6;
  across.plants[1].motor_m = across.plants[1].table_m = 20e-6;
  along.Run(0.008);
  across.Run(0.008);
  EXPECT_LT(across.TrackingError(), 0.7 * along.TrackingError());
}

// There and back along x: the turn asks for more force than there is.
ReferencePoint Turn(std::size_t axis, double t) {
  const double along = 0.05 * (t - 0.2);
  const bool before = t < 0.2;
  if (axis == 0) return ReferencePoint{before ? along : -along, before ? 0.05 : -0.05, 0.0};
  return ReferencePoint{0.0, 0.0, 0.0};
}

void StartOnTurn(ContourLoop& loop) {
  loop.plants[0].motor_m = loop.plants[0].table_m = -0.01;
  loop.plants[0].motor_m_s = loop.plants[0].table_m_s = 0.05;
}

TEST(Full, WithoutAPlanWhatCannotBeDoneIsNotMadeUpForLater) {
  ControllerConfig config;
  config.planner.enabled = false;
  ContourLoop loop(ControllerName::kFull, config, NominalAxes(2), Turn);
  StartOnTurn(loop);
  EXPECT_LT(loop.Run(0.15), 0.1e-6);
  EXPECT_LT(loop.Run(0.06), 250e-6);
  // Ten milliseconds after the corner nothing is left of it in the force but the way back to the path.
  double before = loop.output.force_N[0];
  for (int n = 0; n < 30; ++n) {
    loop.Step();
    EXPECT_LT(std::abs(loop.output.force_N[0] - before), 100.0);
    before = loop.output.force_N[0];
  }
  EXPECT_LT(loop.Run(0.1), 3e-6);
}

TEST(Full, PlansCornersWithinTheTorqueAndKeepsToThePath) {
  // A right-angled corner at 50 mm/s, along x and then along y.
  const auto corner = [](std::size_t axis, double t) {
    const double along = 0.05 * (t - 0.2);
    const bool moves = (along < 0.0) == (axis == 0);
    return ReferencePoint{moves ? along : 0.0, moves ? 0.05 : 0.0, 0.0};
  };
  ControllerConfig config;
  double peak[2] = {0.0, 0.0};
  for (const bool plans : {false, true}) {
    config.planner.enabled = plans;
    ContourLoop loop(ControllerName::kFull, config, NominalAxes(2), corner);
    StartOnTurn(loop);
    for (int n = 0; n < 350; ++n) {
      loop.Step();
      const double x = loop.plants[0].table_m, y = loop.plants[1].table_m;
      // The path is the negative x axis and the positive y axis.
      const double distance = std::min(std::hypot(std::max(x, 0.0), y), std::hypot(x, std::min(y, 0.0)));
      peak[plans ? 1 : 0] = std::max(peak[plans ? 1 : 0], distance);
      if (plans) {
        EXPECT_NE(loop.output.limit[0], Reason::kTorqueLimit) << n;
      }
    }
    EXPECT_LT(loop.Run(0.1), 1e-6);
  }
  EXPECT_LT(peak[1], 4e-6);
  EXPECT_GT(peak[0], 30e-6);
}

TEST(Mpc, RefusesWhatCannotWork) {
  ControllerConfig config;
  config.full.horizon = 41;
  EXPECT_THROW(ContourController(ControllerName::kFull, config, NominalAxes(2), 1e-3), std::invalid_argument);
  config = ControllerConfig{};
  EXPECT_THROW(ContourController(ControllerName::kFull, config, PerAxis<ControlledAxis>{}, 1e-3),
               std::invalid_argument);
  PerAxis<ControlledAxis> axes = NominalAxes(2);
  axes[1].limits.force_N = 0.0;
  EXPECT_THROW(ContourController(ControllerName::kFull, config, axes, 1e-3), std::invalid_argument);
  axes = NominalAxes(2);
  axes[0].mechanics.stiffness_N_m = 0.0;
  EXPECT_THROW(ContourController(ControllerName::kFull, config, axes, 1e-3), std::invalid_argument);
  EXPECT_NO_THROW(ContourController(ControllerName::kMpc, config, axes, 1e-3));
}

}  // namespace
}  // namespace contour
