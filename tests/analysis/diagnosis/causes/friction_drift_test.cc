#include <gtest/gtest.h>

#include <cmath>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "friction_drift";
constexpr double kLog_s = 2.0;

/// Of the level at a row, over the one that is stated.
double Level(const AxisModel& m, std::size_t row) { return 1.0 + (*m.level)[row]; }

TEST(FrictionDrift, TheLinearOneIsToldAsTheChangeFromBeginningToEnd) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "linear");
  const AxisModel m = test::With(axis, e, {0.2});
  EXPECT_NEAR(Level(m, 0), 0.9, 1e-12);
  EXPECT_NEAR(Level(m, 1000), 1.0, 1e-12);
  EXPECT_NEAR(Level(m, 1999), 1.1, 2e-4);
  EXPECT_NEAR(test::Told(axis, e, {0.2}).at("change_rel"), 1.1 / 0.9 - 1.0, 1e-12);
}

TEST(FrictionDrift, TheExponentialOneIsToldWithItsTimeConstant) {
  const test::KnownAxis axis;
  for (const SharedEffect& e : test::GridOf(axis, kKind)) {
    if (e->order == 0.0) continue;
    const std::vector<double> a = {-0.3, std::log(1.5)};
    const AxisModel m = test::With(axis, e, a);
    const NamedValues told = test::Told(axis, e, a);
    EXPECT_NEAR(told.at("time_constant_s"), 1.5 * e->order * kLog_s, 1e-12);
    // One time constant on, 1 - 1/e of all that it would ever change is done.
    const auto row = static_cast<std::size_t>(told.at("time_constant_s") / test::KnownAxis::kPeriod_s);
    EXPECT_NEAR((Level(m, row) - Level(m, 0)) / -0.3, 1.0 - std::exp(-1.0), 2e-3) << e->label;
    // The end is one row beyond the last one.
    EXPECT_NEAR(told.at("change_rel"), Level(m, 1999) / Level(m, 0) - 1.0, 1e-3) << e->label;
  }
}

TEST(FrictionDrift, MovesTheLevelAndNotTheViscousTerm) {
  const test::KnownAxis axis;
  for (const SharedEffect& e : test::GridOf(axis, kKind)) {
    std::vector<double> a(e->steps.size(), 0.0);
    a[0] = 0.1;
    const AxisModel m = test::With(axis, e, a);
    EXPECT_TRUE(m.level);
    EXPECT_FALSE(m.viscous || m.load_force || m.motor_force);
  }
  EXPECT_EQ(*CauseNamed(kKind).extension, nullptr) << "it is over when the log is";
}

TEST(FrictionDrift, IsDecidedByTheSameStrokesWarmAndCold) {
  const test::KnownAxis axis;
  EXPECT_TRUE(std::holds_alternative<SequenceShape>(test::DecidingProgram(axis, kKind).shape));
}

TEST(FrictionDrift, TheTruthOfASpecimenIsWhatTheLogHasOfIt) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  const LogSpan span = {.begin_s = 10.0, .end_s = 60.0, .planned_end_s = 100.0};
  // A fifth in all: a tenth of it is done when the log begins, six tenths when it ends.
  EXPECT_NEAR((*s.truth)({.size = 0.2}, span).at("change_rel"), 1.12 / 1.02 - 1.0, 1e-12);
  const double first = 1.0 + 0.2 * (1.0 - std::exp(-0.5)), last = 1.0 + 0.2 * (1.0 - std::exp(-3.0));
  EXPECT_NEAR((*s.truth)({.size = 0.2, .second = 20.0}, span).at("change_rel"), last / first - 1.0, 1e-12);
  const test::Emulated emulated = test::EmulatedWith((*s.effect)(
      {.size = 0.2, .second = 20.0}, test::MachineToDrawFor(), {.begin_s = 10.0, .duration_s = 90.0}));
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_EQ(emulated.axis.effects.friction_drift->over_s, 100.0);
  EXPECT_EQ(emulated.axis.effects.friction_drift->time_constant_s, 20.0);
  EXPECT_EQ((*s.draw)(test::MachineToDrawFor(), 1.0, test::Numbers({0.2})).second, 0.0) << "half are linear";
  EXPECT_GT((*s.draw)(test::MachineToDrawFor(), 1.0, test::Numbers({0.7})).second, 0.0);
}

}  // namespace
}  // namespace contour::diagnosis
