#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/waves.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "cogging";

Cause Wave12(double amplitude_Nm, double order, double phase_rad) {
  return test::CauseWith(
      kKind, {{"amplitude_Nm", amplitude_Nm}, {"order_per_rev", order}, {"phase_rad", phase_rad}});
}

TEST(Cogging, IsATorqueOnTheMotorThatRepeatsWithItsAngle) {
  const test::KnownAxis axis({.two_inertia = true});
  const SharedEffect e = WaveEffect(axis.problem, Wave::kTorqueOfAngle, 12.0, 144.0);
  EXPECT_EQ(e->kind, kKind);
  const std::vector<double> a = {0.004 * std::cos(-2.0), 0.004 * std::sin(-2.0)};
  const AxisModel m = test::With(axis, e, a);
  EXPECT_FALSE(m.load_force);
  // At speed it turns by a radian and more in a row: the mean over the row is less than its peak.
  for (const std::size_t row : {3u, 480u, 900u, 1777u})
    EXPECT_NEAR(test::MeanOverRow(m.motor_force, row), test::MeanOfWave(axis, row, 0.004, 12.0, -2.0), 2e-8)
        << row;
  const NamedValues told = test::Told(axis, e, a);
  EXPECT_NEAR(told.at("amplitude_Nm"), 0.004, 1e-12);
  EXPECT_NEAR(told.at("order_per_rev"), 12.0, 1e-12);
  EXPECT_NEAR(told.at("phase_rad"), -2.0, 1e-12);
}

TEST(Cogging, WavesOfOneOrderAddAsPhasors) {
  const double opposite = 0.7 + std::numbers::pi;
  const ExtensionsConfig e =
      test::ExtendedBy({Wave12(0.005, 12, 0.7), Wave12(0.002, 12, opposite), Wave12(0.001, 24, 0.0)});
  const auto [read, errors] = test::ThroughYaml(e);
  EXPECT_TRUE(errors.empty());
  EXPECT_NEAR(read.cogging->amplitude_Nm, 0.003, 1e-12);
  EXPECT_NEAR(read.cogging->phase_rad, 0.7, 1e-9);
  ASSERT_EQ(read.cogging->further.size(), 1u);
  EXPECT_EQ(read.cogging->further[0].order_per_rev, 24.0);
  const test::Emulated emulated = test::SimulatedWith(kKind, e);
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_NEAR(emulated.axis.effects.cogging->amplitude_Nm, 0.003, 1e-12);
  EXPECT_EQ(emulated.axis.effects.cogging->further.at(0).amplitude_Nm, 0.001);
}

TEST(Cogging, AnOrderThatIsNotPositiveIsRefused) {
  EXPECT_FALSE(test::ThroughYaml(test::ExtendedBy({Wave12(0.005, -1.0, 0.0)})).errors.empty());
}

TEST(Cogging, IsDecidedByThreeSpeedsAndSoIsWhatDependsOnTheAngle) {
  const test::KnownAxis axis;
  EXPECT_EQ(std::get<CreepShape>(test::DecidingProgram(axis, kKind).shape).velocities_mm_s.size(), 3u);
  EXPECT_EQ(*CauseNamed(kKind).shows_more_of, Quantity::kAngle);
}

TEST(Cogging, ASpecimenHasAnOrderThatMotorsHave) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  for (const double u : {0.0, 0.5, 0.999}) {
    Drawn drawn = (*s.draw)(test::MachineToDrawFor(), 1.0, test::Numbers({u}));
    EXPECT_TRUE(IsWholeOrder(drawn.order));
    drawn.size = -drawn.size;  // half a turn of the phase
    const test::Emulated emulated = test::EmulatedWith((*s.effect)(drawn, test::MachineToDrawFor(), {}));
    EXPECT_TRUE(emulated.errors.empty());
    EXPECT_EQ(emulated.axis.effects.cogging->order_per_rev, drawn.order);
    EXPECT_EQ((*s.truth)(drawn, {}).at("amplitude_Nm"), -emulated.axis.effects.cogging->amplitude_Nm);
  }
}

}  // namespace
}  // namespace contour::diagnosis
