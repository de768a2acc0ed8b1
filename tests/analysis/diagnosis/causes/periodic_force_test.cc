#include <gtest/gtest.h>

#include <cmath>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/waves.h"
#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr const char* kKind = "periodic_force";
constexpr double kTwoPi = 6.283185307179586;

/// Mean over a row of amplitude sin(2 pi f t + phase).
double MeanOfForce(std::size_t row, double amplitude, double f_Hz, double phase_rad) {
  const double from = kTwoPi * f_Hz * 1e-3 * static_cast<double>(row) + phase_rad,
               turn = kTwoPi * f_Hz * 1e-3;
  return amplitude * (std::cos(from) - std::cos(from + turn)) / turn;
}

TEST(PeriodicForce, IsASineOfTimeOnTheLoad) {
  const test::KnownAxis axis({.two_inertia = true});
  const SharedEffect e = WaveEffect(axis.problem, Wave::kForceOfTime, 37.0, 1000.0);
  EXPECT_EQ(e->kind, kKind);
  const std::vector<double> a = {0.01 * std::cos(1.1), 0.01 * std::sin(1.1), 0.0};
  const AxisModel m = test::With(axis, e, a);
  EXPECT_FALSE(m.motor_force);
  for (const std::size_t row : {1u, 777u, 1950u})
    EXPECT_NEAR(test::MeanOverRow(m.load_force, row), MeanOfForce(row, 0.01, 37.0, 1.1), 1e-8);
  const NamedValues told = test::Told(axis, e, a);
  EXPECT_NEAR(told.at("amplitude_Nm"), 0.01, 1e-12);
  EXPECT_EQ(told.at("frequency_Hz"), 37.0);
  EXPECT_NEAR(told.at("phase_rad"), 1.1, 1e-9);
}

TEST(PeriodicForce, ItsFrequencyIsFittedAndThePhaseToldIsThatOfTheFirstRow) {
  const test::KnownAxis axis;
  const SharedEffect e = WaveEffect(axis.problem, Wave::kForceOfTime, 37.0, 1000.0);
  const std::vector<double> a = {0.01, 0.0, 0.13};
  const AxisModel m = test::With(axis, e, a);
  const NamedValues told = test::Told(axis, e, a);
  EXPECT_NEAR(told.at("frequency_Hz"), 37.13, 1e-9);
  for (const std::size_t row : {1u, 777u, 1950u})
    EXPECT_NEAR(test::MeanOverRow(m.load_force, row), MeanOfForce(row, 0.01, 37.13, told.at("phase_rad")),
                1e-8);
  // The log of 2 s tells frequencies apart that differ by half a hertz: that far it may go, and not to
  // others.
  EXPECT_LT(e->high[2], 1.0);
  EXPECT_GT(e->high[2], 0.1);
}

TEST(PeriodicForce, NoModelIsExtendedByItAndThreeSpeedsDecide) {
  EXPECT_EQ(*CauseNamed(kKind).extension, nullptr);
  const test::KnownAxis axis;
  EXPECT_EQ(std::get<CreepShape>(test::DecidingProgram(axis, kKind).shape).velocities_mm_s.size(), 3u);
}

TEST(PeriodicForce, ASpecimenIsDrawnEvenlyInTheLogarithmOfFrequency) {
  const Specimen& s = **CauseNamed(kKind).specimen;
  const double low = (*s.draw)(test::MachineToDrawFor(), 1.0, test::Numbers({0.0})).order,
               middle = (*s.draw)(test::MachineToDrawFor(), 1.0, test::Numbers({0.5})).order,
               high = (*s.draw)(test::MachineToDrawFor(), 1.0, test::Numbers({1.0})).order;
  EXPECT_NEAR(middle, std::sqrt(low * high), 1e-9);
  const Drawn drawn{.size = 0.0025, .order = 20.0, .phase_rad = 0.4};
  const test::Emulated emulated = test::EmulatedWith((*s.effect)(drawn, test::MachineToDrawFor(), {}));
  EXPECT_TRUE(emulated.errors.empty());
  EXPECT_EQ(emulated.axis.effects.periodic_force->frequency_Hz, 20.0);
  EXPECT_EQ((*s.truth)(drawn, {}), (NamedValues{{"amplitude_Nm", 0.0025}, {"frequency_Hz", 20.0}}));
}

}  // namespace
}  // namespace contour::diagnosis
