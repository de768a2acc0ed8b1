#include <gtest/gtest.h>

#include <cmath>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/waves.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "friction_ripple";

TEST(FrictionRipple, IsAWaveOfTheLevelAWholeNumberOfTimesPerTurn) {
  const test::KnownAxis axis;
  const SharedEffect e = WaveEffect(axis.problem, Wave::kFrictionOfAngle, 3.0, 40.0);
  EXPECT_EQ(e->kind, kKind);
  const std::vector<double> a = {0.1 * std::cos(2.5), 0.1 * std::sin(2.5)};
  const AxisModel m = test::With(axis, e, a);
  EXPECT_FALSE(m.motor_force);
  for (const std::size_t row : {20u, 555u, 1300u})
    EXPECT_NEAR(test::MeanOverRow(m.level, row), test::MeanOfWave(axis, row, 0.1, 3.0, 2.5), 1e-6);
  const NamedValues told = test::Told(axis, e, a);
  EXPECT_NEAR(told.at("amplitude_rel"), 0.1, 1e-12);
  EXPECT_EQ(told.at("order_per_rev"), 3.0);
  EXPECT_NEAR(told.at("phase_rad"), 2.5, 1e-12);
}

TEST(FrictionRipple, OfALevelThatHasAWaveAlreadyIsInProportionToIt) {
  const test::KnownAxis axis;
  AxisModel m = axis.problem.nominal;
  m.level = std::make_shared<const Signal>(test::KnownAxis::kRows, 0.5);
  WaveEffect(axis.problem, Wave::kFrictionOfAngle, 3.0, 40.0)->apply({0.1, 0.0}, m);
  EXPECT_NEAR(test::MeanOverRow(m.level, 555), 1.5 * (1.0 + test::MeanOfWave(axis, 555, 0.1, 3.0, 0.0)) - 1.0,
              1e-6);
}

TEST(FrictionRipple, OfAModelIsReadBackAndSimulated) {
  const auto wave = [](double amplitude, double order) {
    return test::CauseWith(kKind,
                           {{"amplitude_rel", amplitude}, {"order_per_rev", order}, {"phase_rad", 0.3}});
  };
  const ExtensionsConfig e = test::ExtendedBy({wave(0.1, 2.0), wave(0.05, 2.0), wave(0.02, 4.0)});
  const auto [read, errors] = test::ThroughYaml(e);
  EXPECT_TRUE(errors.empty());
  EXPECT_NEAR(read.friction_ripple->amplitude_rel, 0.15, 1e-12) << "the same order in the same phase";
  ASSERT_EQ(read.friction_ripple->further.size(), 1u);
  EXPECT_FALSE(read.ball_ripple);
  const test::Emulated emulated = test::SimulatedWith(kKind, e);
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_NEAR(emulated.axis.effects.friction_ripple->amplitude_rel, 0.15, 1e-12);
  EXPECT_EQ(emulated.axis.effects.friction_ripple->further.at(0).order_per_rev, 4.0);
  EXPECT_FALSE(test::ThroughYaml(test::ExtendedBy({wave(0.96, 2.0)})).errors.empty());
}

TEST(FrictionRipple, IsDecidedByThreeSpeeds) {
  const test::KnownAxis axis;
  EXPECT_EQ(std::get<CreepShape>(test::DecidingProgram(axis, kKind).shape).velocities_mm_s.size(), 3u);
}

TEST(FrictionRipple, ASpecimenIsDrawnAtAWholeOrder) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  for (const double u : {0.0, 0.6, 0.999}) {
    const Drawn drawn = (*s.draw)(test::MachineToDrawFor(), 1.0, test::Numbers({u}));
    EXPECT_TRUE(IsWholeOrder(drawn.order) && drawn.order >= 1.0) << drawn.order;
    const test::Emulated emulated = test::EmulatedWith((*s.effect)(drawn, test::MachineToDrawFor(), {}));
    EXPECT_TRUE(emulated.errors.empty());
    EXPECT_EQ(emulated.axis.effects.friction_ripple->order_per_rev, drawn.order);
  }
}

}  // namespace
}  // namespace contour::diagnosis
