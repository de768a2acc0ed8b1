// An experiment's spring is judged on what the axis's loop is judged on.
#include <gtest/gtest.h>

#include "core/spring_loop.h"
#include "design/find_loop.h"
#include "design/loop_margins.h"
#include "design/start_set.h"
#include "tests/design/family_axes.h"

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;

/// A vertical axis of 80 kg as its catalogue has it, and the loop that `contour tune --catalogue` found.
LoopAxis Vertical() {
  LoopAxis a;
  a.axis = {.motor_mass_kg = 174.0,
            .table_mass_kg = 64.0,
            .stiffness_N_m = 117e6,
            .damping_Ns_m = 7637.0,
            .viscous_Ns_m = 1170.0,
            .lag_s = 0.3e-3,
            .delay_cycles = 1};
  a.friction = {.Fs_plus_N = 126,
                .Fs_minus_N = 126,
                .Fc_plus_N = 98,
                .Fc_minus_N = 98,
                .vs_m_s = 2.6e-3,
                .stribeck_exponent = 1.0,
                .sigma0_N_m = 3e7,
                .sigma1_Ns_m = 6300.0,
                .sigma1_decay_m_s = 2e-3,
                .sigma2_Ns_m = 1170.0};
  a.rated_force_N = 3016.0;
  a.encoder_step_m = 10e-3 / 65536.0;
  a.stiffness_std = a.motor_mass_std = a.table_mass_std = a.limits.uncertainty;
  return a;
}
constexpr LoopTuning kVertical{.regulator_Hz = 12.6,
                               .windup_weight = 0.0897,
                               .velocity_weight = 0.0683,
                               .disturbance_Hz = 82.5,
                               .motor_force_Hz = 2070.0,
                               .table_force_Hz = 218.0,
                               .notch_ratio = 0.5,
                               .notch_pole_damping = 1.28,
                               .notch_zero_damping = 0.458};

std::vector<LoopMember> AllOf(const LoopAxis& axis) {
  std::vector<LoopMember> set = UncertaintySet(axis);
  for (LoopMember& m : StartSet(axis, {})) set.push_back(std::move(m));
  // Friction's falling slope makes any weak spring stick and slip: that is what the experiment is for.
  std::erase_if(set, [](const LoopMember& m) { return m.bristle.decay_1_s > 0.0; });
  return set;
}

/// As springs were: a stiffness and 0.7 of critical damping on what the observer foretells of the motor.
TwoInertiaLoop DampedSpring(const LoopAxis& axis, TwoInertiaLoop loop, double spring_N_m) {
  const double mass_kg = axis.axis.motor_mass_kg + axis.axis.table_mass_kg;
  const double damping_Ns_m = 1.4 * std::sqrt(spring_N_m * mass_kg);
  const auto force_N = [&](double position, double velocity) {
    return spring_N_m * position + damping_Ns_m * velocity;
  };
  for (std::size_t i = 0; i < kLoopMotion; ++i)
    loop.regulator_motion[i] = force_N(loop.motion_from_motion[0][i], loop.motion_from_motion[1][i]);
  loop.regulator_queue = {};
  loop.regulator_queue[0] = force_N(loop.motion_from_input[0][0], loop.motion_from_input[0][1]);
  loop.disturbance_to_command = -force_N(loop.motion_from_disturbance[0], loop.motion_from_disturbance[1]);
  loop.filter = {};
  return loop;
}

TEST(SpringMargins, OfACatalogueAxisIsStableWhereverItsLoopIs) {
  const LoopAxis axis = Vertical();
  const TwoInertiaLoop loop = DesignLoop(axis.axis, kVertical, kPeriod_s, false);
  int old_unstable = 0;
  for (const LoopMember& member : AllOf(axis)) {
    ASSERT_LT(GrowthOn(member, loop, kPeriod_s), 1.0) << member.name;
    for (const double share : {1.0, 0.5, 0.2, 0.05}) {
      const TwoInertiaLoop spring = SpringLoop(loop, share * StiffestSpring_N_m(loop));
      EXPECT_LT(GrowthOn(member, spring, kPeriod_s), 1.0) << member.name << " at " << share;
    }
    const TwoInertiaLoop old = DampedSpring(axis, loop, 7.6e5);
    old_unstable += GrowthOn(member, old, kPeriod_s) >= 1.0 ? 1 : 0;
  }
  EXPECT_GT(old_unstable, 0) << "what this is about";
}

TEST(SpringMargins, NeedNoMoreThanTheLateLimitOnTheCatalogueAxis) {
  const LoopAxis axis = Vertical();
  const TwoInertiaLoop loop = DesignLoop(axis.axis, kVertical, kPeriod_s, false);
  const LoopJudge judge(axis, kPeriod_s, AllOf(axis));
  const LoopVerdict own = judge.Judge(loop);
  for (const double share : {1.0, 0.5, 0.2, 0.05}) {
    const LoopVerdict v = judge.Judge(SpringLoop(loop, share * StiffestSpring_N_m(loop)));
    for (std::size_t kind = 0; kind < kMemberKinds; ++kind)
      EXPECT_LE(v.worst[kind].peak, std::max(own.worst[kind].peak, axis.limits.peak_late)) << share;
  }
}

}  // namespace
}  // namespace contour
