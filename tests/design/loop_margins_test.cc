#include "design/loop_margins.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/design/family_axes.h"

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;

/// The same axis, moved more by the same force.
LoopMember WithGain(LoopMember m, double gain) {
  for (double* v : {&m.axis.motor_mass_kg, &m.axis.table_mass_kg, &m.axis.stiffness_N_m, &m.axis.damping_Ns_m,
                    &m.axis.viscous_Ns_m, &m.bristle.stiffness_N_m, &m.bristle.damping_Ns_m})
    *v /= gain;
  return m;
}

class Margins : public testing::TestWithParam<const char*> {
 protected:
  LoopAxis axis_ = AxisOf(GetParam());
  TwoInertiaLoop loop_ = DesignLoop(axis_.axis, kTuning, kPeriod_s, false);
};

TEST_P(Margins, GainMayRiseAndFallAsFarAsTheySay) {
  for (const LoopMember& member : {SlidingMember(axis_), RestingMember(axis_)}) {
    const LoopMargins m = MarginsOn(member, loop_, kPeriod_s);
    ASSERT_TRUE(m.stable);
    const auto stable_at = [&](double gain) {
      return MarginsOn(WithGain(member, gain), loop_, kPeriod_s).stable;
    };
    ASSERT_LT(m.growth_per_cycle, 0.9999) << "nothing in it that never moves";
    EXPECT_TRUE(stable_at(0.99 * m.gain_up));
    EXPECT_FALSE(stable_at(1.01 * m.gain_up));
    if (m.gain_down == 0.0) continue;
    EXPECT_TRUE(stable_at(1.01 * m.gain_down));
    EXPECT_FALSE(stable_at(0.99 * m.gain_down));
  }
}

TEST_P(Margins, DeadTimeUsesUpThePhaseMarginAtTheLatest) {
  const LoopMember sliding = SlidingMember(axis_);
  const LoopMargins m = MarginsOn(sliding, loop_, kPeriod_s);
  ASSERT_GT(m.bandwidth_Hz, 0.0);
  LoopMember late = sliding;
  late.axis.dead_time_s = 1.1 * m.phase_deg / 360.0 / m.bandwidth_Hz;
  EXPECT_FALSE(MarginsOn(late, loop_, kPeriod_s).stable);
}

TEST_P(Margins, PeakIsAtLeastWhatGainAndPhaseSay) {
  const LoopMargins m = MarginsOn(SlidingMember(axis_), loop_, kPeriod_s);
  EXPECT_GE(m.peak * 1.001, 1.0 / (1.0 - 1.0 / m.gain_up));
  EXPECT_GE(m.peak * 1.01, 1.0 / (2.0 * std::sin(0.5 * m.phase_deg * std::numbers::pi / 180.0)));
}

TEST_P(Margins, SearchSeesThePeaksOfTheReport) {
  const LoopJudge judge(axis_, kPeriod_s);
  const LoopVerdict v = judge.Judge(loop_);
  double worst = 0.0;
  for (const LoopMember& m : UncertaintySet(axis_))
    if (m.kind == MemberKind::kAsStated) worst = std::max(worst, MarginsOn(m, loop_, kPeriod_s).peak);
  EXPECT_NEAR(v.worst[0].peak, worst, 0.03 * worst);
}

INSTANTIATE_TEST_SUITE_P(Family, Margins, testing::Values("base", "t20", "m300"),
                         [](const auto& at) { return std::string(at.param); });

TEST_P(Margins, BandwidthIsWhereTheLoopGainHasFallenToOne) {
  const LoopMember sliding = SlidingMember(axis_);
  const double bandwidth_Hz = MarginsOn(sliding, loop_, kPeriod_s).bandwidth_Hz;
  EXPECT_LT(MarginsOn(WithGain(sliding, 0.8), loop_, kPeriod_s).bandwidth_Hz, bandwidth_Hz);
  EXPECT_GT(MarginsOn(WithGain(sliding, 1.2), loop_, kPeriod_s).bandwidth_Hz, bandwidth_Hz);
}

TEST(UnderForceStep, GrowsWithTheForceAndIsMadeUpFor) {
  const LoopAxis axis = AxisOf("base");
  const TwoInertiaLoop loop = DesignLoop(axis.axis, kTuning, kPeriod_s, false);
  const LoopMember sliding = SlidingMember(axis);
  const ForceStep one = UnderForceStep(sliding, loop, kPeriod_s, 40.0);
  const ForceStep two = UnderForceStep(sliding, loop, kPeriod_s, 80.0);
  EXPECT_NEAR(two.peak_m, 2.0 * one.peak_m, 1e-9 * two.peak_m);
  EXPECT_GT(one.peak_m, 40.0 / axis.axis.stiffness_N_m) << "no less than the screw gives way";
  EXPECT_LT(one.mean_m, 0.5 * one.peak_m);
}

TEST(Acceptable, HasNoLimitForWhatCreepsAndNamesIt) {
  LoopVerdict v;
  for (WorstMember& w : v.worst) w = {"one", true, 1.9, 0.9, 2.0};
  v.noise_limit = 0.01;
  v.worst[static_cast<std::size_t>(MemberKind::kCreeping)] = {"on the slope", false, 9.0, 1.01, 4.0};
  EXPECT_TRUE(Acceptable(v));
  EXPECT_EQ(Binding(v).name, "on the slope");
  v.worst[static_cast<std::size_t>(MemberKind::kHeld)].peak = 2.1;
  EXPECT_FALSE(Acceptable(v));
}

TEST(LoopJudge, NamesWhatIsUnstable) {
  // One more cycle, and twice as fast as this axis can be held.
  const LoopAxis axis = AxisOf("t50");
  LoopTuning fast = kTuning;
  fast.regulator_Hz = 60.0;
  const LoopVerdict v = LoopJudge(axis, kPeriod_s).Judge(DesignLoop(axis.axis, fast, kPeriod_s, false));
  EXPECT_FALSE(Acceptable(v));
  EXPECT_FALSE(Binding(v).stable);
  EXPECT_FALSE(Binding(v).name.empty());
}

// A bias that follows slowly looks best on the axis as stated; a screw of another stiffness leaves the table
// beside its path for as long as it takes.
TEST(LoopJudge, AScaleLoopIsJudgedOnOtherScrewsToo) {
  LoopAxis axis = AxisOf({"stiff screw", 361.0, 496.0, 944.0, 145.0, 6105.0}, true);
  axis.axis.lag_s = 0.15e-3;
  constexpr double kLong_s = 2e-3;
  const LoopTuning tuning{15.7, 0.457, 0.236, 89.1, 313.0, 92.8, 0.97, 0.301, 0.205, 0.93, 0.5};
  const LoopJudge judge(axis, kLong_s);
  const auto judged = [&](double bias_Hz) {
    LoopTuning t = tuning;
    t.bias_Hz = bias_Hz;
    return judge.Judge(DesignLoop(axis.axis, t, kLong_s, true));
  };
  const LoopVerdict slow = judged(0.5), quick = judged(100.0);
  EXPECT_LT(slow.step.mean_m, quick.step.mean_m);
  EXPECT_GT(slow.step_astray.mean_m, 2.0 * quick.step_astray.mean_m);
  EXPECT_GT(StepError_m(slow), StepError_m(quick));
  axis.scale_step_m.reset();
  const LoopVerdict alone = LoopJudge(axis, kLong_s).Judge(DesignLoop(axis.axis, tuning, kLong_s, false));
  EXPECT_EQ(alone.step_astray.peak_m, alone.step.peak_m);
}

// A bias that is quick beside what the motor's equation is believed leaves an observer that hears of a force
// on the motor only by what it does to the table: twice the error that a loop without a scale leaves of it.
TEST(LoopJudge, AScaleLoopIsJudgedByAForceOnTheMotorToo) {
  LoopAxis axis = AxisOf({"heavy motor", 120.0, 710.0, 289.0, 76.5, 6620.0}, true);
  axis.axis.lag_s = 0.277e-3;
  axis.axis.delay_cycles = 2;
  const LoopTuning deaf{16.4, 0.129, 0.122, 342.0, 1410.0, 20.5, 0.815, 0.617, 0.02, 50.0, 1300.0};
  const LoopTuning hears{20.0, 0.0463, 0.104, 149.0, 25.9, 1250.0, 0.611, 0.123, 0.55, 50.0, 338.0};
  const LoopTuning motor_alone{20.0, 0.022, 0.0931, 213.0, 327.0, 2000.0, 0.608, 0.1, 0.47, 1.0, 5.0};
  const LoopJudge judge(axis, kPeriod_s);
  const auto judged = [&](const LoopTuning& t) {
    return judge.Judge(DesignLoop(axis.axis, t, kPeriod_s, true));
  };
  const LoopVerdict late = judged(deaf), early = judged(hears);
  EXPECT_LT(late.step.peak_m, early.step.peak_m);
  EXPECT_GT(StepError_m(late), StepError_m(early));
  axis.scale_step_m.reset();
  const LoopVerdict alone =
      LoopJudge(axis, kPeriod_s).Judge(DesignLoop(axis.axis, motor_alone, kPeriod_s, false));
  EXPECT_EQ(alone.step_of_motor.peak_m, alone.step.peak_m);
  EXPECT_EQ(StepError_m(alone), alone.step.peak_m + 2.0 * alone.step.mean_m);
  EXPECT_GT(late.step_of_motor.peak_m, 1.5 * alone.step.peak_m);
  EXPECT_LT(early.step_of_motor.peak_m, 1.1 * alone.step.peak_m);
}

TEST(LoopJudge, CoarseEncodersMakeTorqueNoise) {
  LoopAxis axis = AxisOf("base");
  const TwoInertiaLoop loop = DesignLoop(axis.axis, kTuning, kPeriod_s, false);
  const double fine = LoopJudge(axis, kPeriod_s).Judge(loop).torque_noise;
  axis.encoder_step_m *= 100.0;
  const LoopVerdict coarse = LoopJudge(axis, kPeriod_s).Judge(loop);
  EXPECT_NEAR(coarse.torque_noise, 100.0 * fine, 1e-6 * coarse.torque_noise);
}

}  // namespace
}  // namespace contour
