#include "analysis/prediction_error/signals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace contour::diagnosis {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kPeriod_s = 1e-3;

/// A sine of 1 rad and 2 Hz.
AxisLog Sine(std::size_t rows = 2000) {
  AxisLog log;
  log.period_s = kPeriod_s;
  for (std::size_t k = 0; k < rows; ++k) {
    log.position.push_back(std::sin(4.0 * std::numbers::pi * kPeriod_s * static_cast<double>(k)));
    log.command.push_back(0.0);
    log.present.push_back(1);
  }
  log.rows = rows;
  return log;
}

StatedAxis Stated() {
  StatedAxis s;
  s.motor_inertia = 5e-5;
  s.table_per_q = 1e-3;
  s.lead_m = 2e-3 * std::numbers::pi;
  s.friction.Fc_plus = 0.03;
  s.friction.Fc_minus = 0.05;
  s.position_step = 1e-6;
  return s;
}

TEST(Smooth, KeepsAStraightLineAndItsDerivativeIsTheSlope) {
  Signal line;
  for (int k = 0; k < 200; ++k) line.push_back(3.0 + 0.25 * k);
  const Signal smooth = Smooth(line, 4.0), slope = Derivative(line, 4.0, 0.5);
  for (std::size_t k = 20; k < 180; ++k) {
    EXPECT_NEAR(smooth[k], line[k], 1e-10);
    EXPECT_NEAR(slope[k], 0.5, 1e-10);
  }
}

TEST(Smooth, APulseKeepsItsAreaAndItsPlace) {
  Signal pulse(101, 0.0);
  pulse[50] = 2.0;
  const Signal smooth = Smooth(pulse, 3.0);
  double area = 0.0, moment = 0.0;
  for (std::size_t k = 0; k < smooth.size(); ++k) {
    area += smooth[k];
    moment += smooth[k] * static_cast<double>(k);
  }
  EXPECT_NEAR(area, 2.0, 1e-12);
  EXPECT_NEAR(moment / area, 50.0, 1e-9);
}

TEST(MakeSignals, DerivativesOfASine) {
  const AxisLog log = Sine();
  const Signals s = MakeSignals(log, Stated());
  const double w = 4.0 * std::numbers::pi;
  for (std::size_t k = 100; k < 1900; ++k) {
    const double phase = w * kPeriod_s * static_cast<double>(k);
    EXPECT_NEAR(s.velocity[k], w * std::cos(phase), 0.002 * w);
    EXPECT_NEAR(s.acceleration[k], -w * w * std::sin(phase), 0.005 * w * w);
  }
  EXPECT_NEAR(s.half_stroke_m, 1e-3, 1e-8);
  EXPECT_NEAR(s.middle_m, 0.0, 1e-8);
  EXPECT_NEAR(s.angle_per_q, 1.0, 1e-12);
  EXPECT_DOUBLE_EQ(s.coulomb, 0.04);
}

TEST(MakeSignals, GapsAreBridgedByStraightLines) {
  AxisLog log = Sine();
  const double before = log.position[99], after = log.position[110];
  for (std::size_t k = 100; k < 110; ++k) log.position[k] = kNone;
  const Signals s = MakeSignals(log, Stated());
  EXPECT_NEAR(s.position[105], before + (after - before) * 6.0 / 11.0, 1e-12);
}

// Before: cables of a voice coil without friction were compared with a thousandth of what moves it, and not
// looked for.
TEST(MakeSignals, ForcesAreMeasuredByFrictionOrByWhatMovesTheAxis) {
  AxisLog log;
  log.period_s = 1e-3;
  for (int k = 0; k < 2000; ++k) {
    log.position.push_back(1e-3 * std::sin(0.01 * k));
    log.command.push_back(2.0 * std::sin(0.01 * k));
    log.present.push_back(1);
  }
  StatedAxis stated;
  stated.friction.Fc_plus = stated.friction.Fc_minus = 1.5;
  EXPECT_DOUBLE_EQ(MakeSignals(log, stated).ForceScale(), 1.5);
  stated.friction.Fc_plus = stated.friction.Fc_minus = 2e-3;
  EXPECT_NEAR(MakeSignals(log, stated).ForceScale(), 0.1 * std::sqrt(2.0), 0.01);
}

TEST(UpdateFromTrace, TorqueOfTheMotionAndWhatAccelerates) {
  Signals s = MakeSignals(Sine(), Stated());
  AxisModel m = ModelOf(Stated());
  m.friction.s2 = 1e-3;
  m.offset = 0.01;
  FilterRun trace;
  trace.friction.assign(2000, 0.02);
  UpdateFromTrace(m, trace, std::vector<double>(2000, 0.1), s);
  EXPECT_NEAR(s.sign[500], 0.5, 1e-12);
  const double friction = 0.02 + 1e-3 * s.velocity[500];
  EXPECT_NEAR(s.model_torque[500], 5e-5 * s.acceleration[500] + friction, 1e-15);
  EXPECT_NEAR(s.net_force[500], 0.1 + 0.01 - friction, 1e-15);
}

TEST(ValidRows, MissingAndStaleReadingsAreNone) {
  AxisLog log = Sine();
  log.position[300] = kNone;
  log.present[301] = 0;
  log.position[1000] = log.position[999];  // at full speed
  log.missing = 2;
  DataQuality quality;
  const auto valid = ValidRows(log, MakeSignals(log, Stated()), Stated(), quality);
  EXPECT_EQ(valid[300], 0);
  EXPECT_EQ(valid[301], 0);
  EXPECT_EQ(valid[1000], 0);
  EXPECT_EQ(valid[1001], 1);
  EXPECT_EQ(quality.stale, 1U);
  EXPECT_EQ(quality.missing, 2U);
}

TEST(ValidRows, AnAxisAtRestIsNotStale) {
  AxisLog log = Sine();
  for (double& x : log.position) x = 1.0;
  DataQuality quality;
  ValidRows(log, MakeSignals(log, Stated()), Stated(), quality);
  EXPECT_EQ(quality.stale, 0U);
}

TEST(MarkOutliers, AWrongReadingIsOneAndAShockIsNot) {
  std::vector<double> innovation(2000);
  for (std::size_t k = 0; k < innovation.size(); ++k) innovation[k] = k % 2 == 0 ? 1e-6 : -1e-6;
  innovation[700] = 1e-3;
  for (std::size_t k = 1200; k < 1210; ++k) innovation[k] = 1e-3;
  std::vector<std::uint8_t> valid(2000, 1);
  DataQuality quality;
  MarkOutliers(innovation, 1e-6, valid, quality);
  EXPECT_EQ(quality.outliers, 1U);
  EXPECT_EQ(valid[700], 0);
  EXPECT_EQ(valid[1205], 1);
}

}  // namespace
}  // namespace contour::diagnosis
