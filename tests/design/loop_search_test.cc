#include "design/loop_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/design/family_axes.h"
#include "tests/design/short_search.h"

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;

class EveryBallScrew : public testing::TestWithParam<FamilyAxis> {};

TEST_P(EveryBallScrew, HasALoopThatKeepsItsLimits) {
  for (const bool scale : {false, true}) {
    const LoopAxis axis = AxisOf(GetParam(), scale);
    const FoundLoop found = SearchLoop(axis, kPeriod_s, kShort);
    EXPECT_TRUE(Acceptable(found.verdict, 0.05)) << Binding(found.verdict).name;
    // What encoder and scale are apart by is followed within a period.
    if (scale) {
      EXPECT_LT(1.0, 2.0 * std::numbers::pi * found.tuning.bias_Hz * kPeriod_s);
    }
    const double deflection_m = axis.limits.force_step * axis.rated_force_N / axis.axis.stiffness_N_m;
    EXPECT_LT(found.verdict.step.peak_m, 60.0 * deflection_m);
  }
}

INSTANTIATE_TEST_SUITE_P(Family, EveryBallScrew, testing::ValuesIn(kFamily.begin(), kFamily.end() - 1),
                         [](const auto& at) { return at.param.name; });

TEST(SearchLoop, FindsNoneForABeltFromTheMotorAloneAndSaysWhy) {
  const FoundLoop found = SearchLoop(AxisOf("belt"), kPeriod_s, kShort);
  EXPECT_FALSE(Acceptable(found.verdict));
  EXPECT_NE(Binding(found.verdict).name.find("Stribeck"), std::string::npos) << Binding(found.verdict).name;
}

TEST(SearchLoop, IsTheSameEveryTime) {
  LoopSearchOptions one = kShort;
  one.threads = 1;
  const FoundLoop a = SearchLoop(AxisOf("base"), kPeriod_s, one);
  const FoundLoop b = SearchLoop(AxisOf("base"), kPeriod_s, kShort);
  EXPECT_EQ(a.cost, b.cost);
  EXPECT_EQ(a.tuning.regulator_Hz, b.tuning.regulator_Hz);
}

TEST(SearchLoop, FollowsTheScaleOfTheAxis) {
  // Eight times everything that is a force is the same axis, to the last bit.
  LoopAxis heavy = AxisOf("base");
  for (double* v : {&heavy.axis.motor_mass_kg, &heavy.axis.table_mass_kg, &heavy.axis.stiffness_N_m,
                    &heavy.axis.damping_Ns_m, &heavy.axis.viscous_Ns_m, &heavy.friction.Fs_plus_N,
                    &heavy.friction.Fs_minus_N, &heavy.friction.Fc_plus_N, &heavy.friction.Fc_minus_N,
                    &heavy.friction.sigma0_N_m, &heavy.friction.sigma1_Ns_m, &heavy.friction.sigma2_Ns_m,
                    &heavy.rated_force_N})
    *v *= 8.0;
  LoopSearchOptions tiny = kShort;
  tiny.evaluations_per_run = tiny.evaluations_per_refinement = 40;
  const FoundLoop a = SearchLoop(AxisOf("base"), kPeriod_s, tiny);
  const FoundLoop b = SearchLoop(heavy, kPeriod_s, tiny);
  EXPECT_NEAR(a.cost, b.cost, 1e-3);
}

TEST(SearchLoop, DoesNotRefineWhatIsHopeless) {
  LoopSearchOptions options = kShort;
  const int all = SearchLoop(AxisOf("belt"), kPeriod_s, options).evaluations;
  options.hopeless_excess = 0.5;
  EXPECT_LT(SearchLoop(AxisOf("belt"), kPeriod_s, options).evaluations, all);
  EXPECT_EQ(SearchLoop(AxisOf("base"), kPeriod_s, options).cost,
            SearchLoop(AxisOf("base"), kPeriod_s, kShort).cost);
}

TEST(LoopCost, ChargesALittleForTheSlopeOfAnAxisThatCreeps) {
  LoopVerdict v;
  for (WorstMember& w : v.worst) w = {"one", true, 1.9, 0.9, 2.0};
  v.step = {10e-6, 1e-6, 1e-6};
  v.noise_limit = 0.01;
  const double within = LoopCost(v, 8.0);
  WorstMember& creeping = v.worst[static_cast<std::size_t>(MemberKind::kCreeping)];
  creeping.peak = 4.0;
  const double beyond = LoopCost(v, 8.0);
  EXPECT_GT(beyond, within);
  creeping.stable = false;
  creeping.growth_per_cycle = 1.01;
  EXPECT_GT(LoopCost(v, 8.0), beyond);
  EXPECT_LT(LoopCost(v, 8.0), within + 1.0);
}

TEST(LoopCost, ChargesWhatIsBeyondALimitAndNothingWithin) {
  LoopVerdict v;
  for (WorstMember& w : v.worst) w = {"one", true, 1.9, 0.9, 2.0};
  v.step = v.step_astray = v.step_of_motor = {10e-6, 1e-6, 1e-6};
  v.noise_limit = 0.01;
  const double within = LoopCost(v, 8.0);
  EXPECT_NEAR(within, std::log(12.0), 1e-12);
  v.worst[1].peak = 2.2;
  EXPECT_NEAR(LoopCost(v, 8.0), within + 0.8, 1e-12);
  v.worst[1].stable = false;
  v.worst[1].growth_per_cycle = 1.001;
  EXPECT_GT(LoopCost(v, 8.0), within + 8.0);
}

}  // namespace
}  // namespace contour
