#include "analysis/identification/presliding_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/analysis/identification/generated_axis.h"

namespace contour::test {
namespace {

using identify::Measured;
using identify::TableAxis;

constexpr double kTwoPi = 2.0 * std::numbers::pi;

TEST(PreslidingFitTest, FindsTheBristleFromAStartThatIsFarOff) {
  TableAxis axis = Exactly(PlainAxis());
  GeneratedAxis generated{PlainAxis()};
  const auto loops = [](double t) {
    const double amplitude = t < 3.0 ? 5e-6 : t < 6.0 ? 15e-6 : 60e-6;
    return amplitude * std::sin(kTwoPi * t);
  };
  const Measured record = generated.Drive(9.0, loops, [](double) { return 0.0; });
  const auto instants = identify::Kinematics(record, axis.delay_s, axis.lag_s, 4, 1);
  for (const double wrong : {0.5, 1.5}) {
    axis.friction.s0 = 5e6 * wrong;
    identify::PreslidingFit fit;
    for (int pass = 0; pass < 4; ++pass) {
      fit = identify::FitPresliding(instants, axis);
      ASSERT_TRUE(fit.found);
      axis.friction.s0 = fit.sigma0_N_m;
    }
    EXPECT_NEAR(fit.sigma0_N_m / 5e6, 1.0, 0.25) << "started at " << wrong;
  }
}

TEST(BreakAwayTest, IsTheLargestForceBeforeTheBristleIsLeftBehind) {
  GeneratedAxis generated{PlainAxis()};
  const Measured record = generated.Drive(
      8.0, [](double t) { return 0.5e-3 * std::sin(kTwoPi * 0.25 * t); }, [](double) { return 0.0; });
  const TableAxis axis = Exactly(PlainAxis());
  const auto levels =
      identify::BreakAways(identify::Kinematics(record, axis.delay_s, axis.lag_s, 4, 1), axis);
  ASSERT_GE(levels.size(), 2U);
  for (const identify::BreakAway& b : levels) {
    const double level = b.force_N > 0.0 ? axis.friction.Fs_plus : axis.friction.Fs_minus;
    EXPECT_NEAR(std::fabs(b.force_N), level, 0.15 * level);
  }
}

TEST(PreslidingLoopTest, StrokesThatAreLargerAreNone) {
  GeneratedAxis generated{PlainAxis()};
  const Measured record = generated.Drive(
      4.0, [](double t) { return (t < 2.0 ? 8e-6 : 0.5e-3) * std::sin(kTwoPi * t); },
      [](double) { return 0.0; });
  const TableAxis axis = Exactly(PlainAxis());
  const auto instants = identify::Kinematics(record, axis.delay_s, axis.lag_s, 4, 1);
  const auto loops = identify::PreslidingLoops(instants, axis, 60e-6);
  ASSERT_FALSE(loops.empty());
  for (const identify::LoopPoint& p : loops) EXPECT_LT(p.time_s, 2.3);
}

}  // namespace
}  // namespace contour::test
