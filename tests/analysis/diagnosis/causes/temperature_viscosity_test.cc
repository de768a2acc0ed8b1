#include <gtest/gtest.h>

#include <cmath>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "temperature_viscosity";

TEST(TemperatureViscosity, IsAFactorOnTheViscousTermAboutTheMean) {
  const test::KnownAxis axis;  // warms up evenly by 2 K
  const SharedEffect e = test::OnGrid(axis, kKind, "and level");
  const AxisModel m = test::With(axis, e, {-0.02, 0.005});
  for (const std::size_t row : {0u, 1000u, 1900u}) {
    const double warmer_K = 1e-3 * static_cast<double>(row) - 1.0;
    EXPECT_NEAR((*m.viscous)[row], -0.02 * warmer_K, 1e-12);
    EXPECT_NEAR((*m.level)[row], 0.005 * warmer_K, 1e-12);
  }
  ASSERT_TRUE(e->shorter);
  const AxisModel alone = test::With(axis, e->shorter, {-0.02});
  EXPECT_EQ(*alone.viscous, *m.viscous);
  EXPECT_FALSE(alone.level);
}

TEST(TemperatureViscosity, TheRateIsToldOfTheFirstTemperature) {
  const test::KnownAxis axis;
  const SharedEffect e = test::OnGrid(axis, kKind, "and level");
  const double rate_1_K = test::Told(axis, e, {-0.1, 0.0}).at("rate_1_K");
  // About the mean of 25 degC it is 1.1 at 24 degC and 0.9 at 26 degC.
  EXPECT_NEAR(1.0 + rate_1_K * 2.0, 0.9 / 1.1, 1e-12);
}

TEST(TemperatureViscosity, AThermometerThatStandsStillTellsNothing) {
  EXPECT_TRUE(test::GridOf(test::KnownAxis({.temperature = false}), kKind).empty());
  test::KnownAxis axis;
  axis.problem.signals->temperature_K.assign(test::KnownAxis::kRows, 0.0);
  EXPECT_TRUE(test::GridOf(axis, kKind).empty());
}

TEST(TemperatureViscosity, TwoRatesAboutTwoTemperaturesAreOne) {
  ExtensionsConfig e;
  const auto add = *(*CauseNamed(kKind).extension)->add;
  add(test::CauseWith(kKind, {{"rate_1_K", -0.01}}), 20.0, e);
  add(test::CauseWith(kKind, {{"rate_1_K", -0.03}}), 30.0, e);
  const auto [read, errors] = test::ThroughYaml(e);
  EXPECT_TRUE(errors.empty());
  for (const double T : {10.0, 20.0, 45.0})
    EXPECT_NEAR(read.temperature_viscosity->rate_1_K * (T - read.temperature_viscosity->reference_degC),
                -0.01 * (T - 20.0) - 0.03 * (T - 30.0), 1e-12);
  const test::Emulated emulated = test::SimulatedWith(kKind, e);
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_NEAR(emulated.axis.effects.temperature_viscosity->rate_1_K, -0.04, 1e-12);
  EXPECT_NEAR(emulated.axis.temperature.reference_degC, 27.5, 1e-9);
}

TEST(TemperatureViscosity, RatesThatCancelLeaveATemperatureThatCanBeRead) {
  ExtensionsConfig e;
  const auto add = *(*CauseNamed(kKind).extension)->add;
  add(test::CauseWith(kKind, {{"rate_1_K", -0.01}}), 20.0, e);
  add(test::CauseWith(kKind, {{"rate_1_K", 0.01}}), 30.0, e);
  EXPECT_TRUE(test::ThroughYaml(e).errors.empty());
  add(test::CauseWith(kKind, {{"rate_1_K", 1e-5}}), 300.0, e);
  EXPECT_TRUE(test::ThroughYaml(e).errors.empty());
  ExtensionsConfig far;
  add(test::CauseWith(kKind, {{"rate_1_K", 0.5}}), 20.0, far);
  EXPECT_FALSE(test::ThroughYaml(far).errors.empty());
}

TEST(TemperatureViscosity, IsDecidedByTheSameStrokesWarmAndCold) {
  const test::KnownAxis axis;
  EXPECT_TRUE(std::holds_alternative<SequenceShape>(test::DecidingProgram(axis, kKind).shape));
  EXPECT_EQ(*CauseNamed(kKind).shows_more_of, Quantity::kTemperature);
}

TEST(TemperatureViscosity, ASpecimenGetsThinnerWhenItIsWarm) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  EXPECT_TRUE((*s.needs).temperature);
  const Drawn drawn = (*s.draw)(test::MachineToDrawFor(), 1.0, test::Numbers({0.5}));
  EXPECT_LT(drawn.size, 0.0);
  const test::Emulated emulated = test::EmulatedWith((*s.effect)(drawn, test::MachineToDrawFor(), {}));
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_EQ(emulated.axis.effects.temperature_viscosity->rate_1_K, drawn.size);
  EXPECT_TRUE(test::EmulatedWith((*s.effect)({.size = -*s.largest_size}, {}, {})).errors.empty());
}

}  // namespace
}  // namespace contour::diagnosis
