#include <gtest/gtest.h>

#include <cmath>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/waves.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "ball_ripple";

TEST(BallRipple, IsAWaveOfTheLevelAtAnOrderThatIsNotWhole) {
  const test::KnownAxis axis;
  const SharedEffect e = WaveEffect(axis.problem, Wave::kFrictionOfAngle, 2.4, 100.0);
  EXPECT_EQ(e->kind, kKind);
  EXPECT_EQ(WaveEffect(axis.problem, Wave::kFrictionOfAngle, 2.0, 100.0)->kind, "friction_ripple");
  // 0.1 sin(2.4 theta + 0.6), its order as scanned.
  const std::vector<double> a = {0.1 * std::cos(0.6), 0.1 * std::sin(0.6), 0.0};
  const AxisModel m = test::With(axis, e, a);
  for (const std::size_t row : {150u, 700u, 1600u}) {
    const double phase = 0.6;
    EXPECT_NEAR(test::MeanOverRow(m.level, row), test::MeanOfWave(axis, row, 0.1, 2.4, phase), 1e-6);
  }
  const NamedValues told = test::Told(axis, e, a);
  EXPECT_NEAR(told.at("amplitude_rel"), 0.1, 1e-12);
  EXPECT_NEAR(told.at("order_per_rev"), 2.4, 1e-12);
  EXPECT_NEAR(told.at("phase_rad"), 0.6, 1e-12);
}

TEST(BallRipple, ItsOrderIsFittedAndThePhaseToldIsThatAtAngleZero) {
  const test::KnownAxis axis;
  const SharedEffect e = WaveEffect(axis.problem, Wave::kFrictionOfAngle, 2.4, 100.0);
  const std::vector<double> a = {0.1 * std::cos(0.6), 0.1 * std::sin(0.6), 0.02};
  const AxisModel m = test::With(axis, e, a);
  const NamedValues told = test::Told(axis, e, a);
  EXPECT_NEAR(told.at("order_per_rev"), 2.42, 1e-12);
  for (const std::size_t row : {150u, 700u, 1600u})
    EXPECT_NEAR(test::MeanOverRow(m.level, row),
                test::MeanOfWave(axis, row, 0.1, told.at("order_per_rev"), told.at("phase_rad")), 1e-6);
}

TEST(BallRipple, OfAModelIsAddedWaveByWave) {
  const auto wave = [](double amplitude, double order, double phase) {
    return test::CauseWith(kKind,
                           {{"amplitude_rel", amplitude}, {"order_per_rev", order}, {"phase_rad", phase}});
  };
  const ExtensionsConfig e = test::ExtendedBy({wave(0.1, 0.4, 0.2), wave(0.05, 1.35, -1.0)});
  const auto [read, errors] = test::ThroughYaml(e);
  EXPECT_TRUE(errors.empty());
  EXPECT_EQ(read.ball_ripple->amplitude_rel, 0.1);
  ASSERT_EQ(read.ball_ripple->further.size(), 1u);
  EXPECT_EQ(read.ball_ripple->further[0].order_per_rev, 1.35);
  EXPECT_FALSE(read.friction_ripple);
  const test::Emulated emulated = test::SimulatedWith(kKind, e);
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_EQ(emulated.axis.effects.ball_ripple->phase_rad, 0.2);
  EXPECT_EQ(emulated.axis.effects.ball_ripple->further.at(0).amplitude_rel, 0.05);
  EXPECT_FALSE(test::ThroughYaml(test::ExtendedBy({wave(0.99, 0.4, 0.0)})).errors.empty());
}

TEST(BallRipple, ASpecimenIsDrawnBetweenTheWholeOrders) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  for (const double u : {0.0, 0.4, 0.99}) {
    const Drawn drawn = (*s.draw)(test::MachineToDrawFor(), 1.0, test::Numbers({u}));
    EXPECT_FALSE(IsWholeOrder(drawn.order)) << drawn.order;
    const test::Emulated emulated = test::EmulatedWith((*s.effect)(drawn, test::MachineToDrawFor(), {}));
    EXPECT_TRUE(emulated.errors.empty());
    EXPECT_EQ(emulated.axis.effects.ball_ripple->order_per_rev, (*s.truth)(drawn, {}).at("order_per_rev"));
  }
}

TEST(BallRipple, IsDecidedByTheSameStretchAtThreeSpeeds) {
  const test::KnownAxis axis;
  const auto creep = std::get<CreepShape>(test::DecidingProgram(axis, kKind).shape);
  EXPECT_EQ(creep.stroke_mm, 100.0);
  ASSERT_EQ(creep.velocities_mm_s.size(), 3u);
  EXPECT_LE(creep.velocities_mm_s[2], 1e3 * test::KnownAxis::kTopSpeed_m_s);
}

}  // namespace
}  // namespace contour::diagnosis
