#include "analysis/identification/own_force.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analysis/identification/shaken_screw.h"
#include "tests/analysis/identification/generated_axis.h"

namespace contour::test {
namespace {

using identify::Measured;
using identify::TableAxis;

constexpr double kTwoPi = 2.0 * std::numbers::pi;

TEST(OwnForceTest, TheMeanOfAQuickForceIsNotThatOfItsEnds) {
  Measured data;
  data.period_s = 1e-3;
  for (int k = 0; k < 200; ++k) {
    data.offset_N.push_back(0.0);
    data.reported_N.push_back(10.0 * std::sin(kTwoPi * 0.3 * k));
    data.force_N.push_back(0.0);
  }
  const identify::OwnForce own = identify::OwnForceOf(TableAxis{}, data);
  for (int k = 20; k < 180; ++k) {
    const double mean =
        10.0 * (std::cos(kTwoPi * 0.3 * k) - std::cos(kTwoPi * 0.3 * (k + 1))) / (kTwoPi * 0.3);
    EXPECT_NEAR(own.mean_N[static_cast<std::size_t>(k)], mean, 0.25) << k;
  }
}

TEST(OwnForceTest, TheOffsetIsTakenOutBehindItsDelayAndLag) {
  TableAxis axis;
  axis.delay_s = 1.2e-3;
  axis.lag_s = 0.4e-3;
  Measured data;
  data.period_s = 1e-3;
  for (int k = 0; k < 20; ++k) {
    data.offset_N.push_back(k >= 10 ? 8.0 : 0.0);
    data.force_N.push_back(0.0);
    // Row 10's offset acts from 0.2 ms behind row 11 on.
    data.reported_N.push_back(3.0 + (k >= 12 ? 8.0 * (1.0 - std::exp(-((k - 11) - 0.2) / 0.4)) : 0.0));
  }
  const identify::OwnForce own = identify::OwnForceOf(axis, data);
  for (const double force_N : own.at_N) EXPECT_NEAR(force_N, 3.0, 1e-9);
  axis.answer.step = {0.01, 0.05, -0.02, 0.0};
  const identify::OwnForce answering = identify::OwnForceOf(axis, data);
  EXPECT_NEAR(answering.mean_N[10] - 3.0, 0.08, 1e-9);
  EXPECT_NEAR(answering.mean_N[11] - 3.0, 0.40, 1e-9);
  EXPECT_NEAR(answering.mean_N[12] - 3.0, -0.16, 1e-9);
}

// Half a ramp per period against a step of 8 N, from 0.3 of a period behind it on: the reports say where it
// is, the mean between them has the bend.
TEST(OwnForceTest, TheAnswerToAStepBeginsWithinAPeriod) {
  TableAxis axis;
  axis.delay_s = 1e-3;
  axis.lag_s = 0.0;
  axis.answer.gain = 0.5;
  axis.answer.delay_s = 0.3e-3;
  Measured data;
  data.period_s = 1e-3;
  for (int k = 0; k < 40; ++k) {
    data.offset_N.push_back(k >= 10 ? 8.0 : 0.0);
    data.force_N.push_back(0.0);
    // Row 10's offset acts from row 11 on.
    data.reported_N.push_back((k >= 12 ? 8.0 : 0.0) - 4.0 * std::max(0.0, k - 11.3));
  }
  data.reported_N[11] = 0.0;
  const identify::OwnForce own = identify::OwnForceOf(axis, data);
  const auto ramp = [](double t) { return -2.0 * std::pow(std::max(0.0, t - 11.3), 2); };
  for (std::size_t k = 8; k < 30; ++k)
    EXPECT_NEAR(own.mean_N[k], ramp(static_cast<double>(k) + 1.0) - ramp(static_cast<double>(k)), 0.04) << k;
}

TEST(OwnForceTest, PartsOfAPeriodHaveItsMean) {
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) sum += 0.25 * identify::PartOfPeriod_N(2.0, 6.0, 5.0, 0.25 * i, 0.25 * (i + 1));
  EXPECT_NEAR(sum, 5.0, 1e-12);
  EXPECT_NEAR(identify::PartOfPeriod_N(2.0, 6.0, 4.0, 0.0, 0.5), 3.0, 1e-12);
}

// What the drive's own loop does between two reports is as quick as the chirp: taken as the mean of its ends
// it gave a motor some percent too light, stated to a tenth of that.
TEST(OwnForceTest, AnAxisThatItsDriveLeadsIsFoundLikeAnother) {
  const plant::AxisParameters truth = PlainAxis();
  const GeneratedAxis axis{truth};
  const Measured data = axis.LedByDrive(
      4.0, [](double t) { return 5e-3 * (t < 2.0 ? t : 4.0 - t); },
      [](double t) {
        const double s = std::fmod(t, 0.5);
        return 60.0 * std::sin(kTwoPi * (100.0 * s + 0.5 * 760.0 * s * s));
      });
  TableAxis start = Exactly(truth);
  start.load_inertia *= 1.3;
  start.motor_inertia *= 0.95;
  start.stiffness = 25e6;
  start.variation.high_m = 15e-3;
  const auto found = identify::FitShakenScrew(start, {data});
  ASSERT_EQ(found.verdict, identify::ShakenScrew::Verdict::kFound);
  EXPECT_EQ(found.axis.side.share, 0.0);
  const TableAxis is = Exactly(truth);
  const auto holds = [&](const char* key, double value, double true_value) {
    const double error = std::log(value / true_value);
    EXPECT_LT(std::fabs(error), 0.06) << key;
    EXPECT_LT(std::fabs(error), 2.5 * identify::Sigma(found.parameters, key)) << key << " " << error;
  };
  holds("motor_inertia_kgm2", found.axis.motor_inertia, is.motor_inertia);
  holds("table_mass_kg", found.axis.load_inertia, is.load_inertia);
  holds("screw_stiffness_N_um", found.axis.stiffness, is.stiffness);
}

}  // namespace
}  // namespace contour::test
