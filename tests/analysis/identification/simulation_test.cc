#include "analysis/identification/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/analysis/identification/generated_axis.h"

namespace contour::test {
namespace {

using identify::Measured;
using identify::TableAxis;

double Rms_m(const std::vector<double>& errors) {
  double sum = 0.0;
  for (const double e : errors) sum += e * e;
  return std::sqrt(sum / static_cast<double>(errors.size()));
}

TEST(SimulationTest, TheTrueModelForeseesAnIndependentAxisToItsNoise) {
  // A reading's noise: quantisation and 0.3 counts, 1.9 nm. The prediction adds its own.
  const TableAxis truth = Exactly(PlainAxis());
  const auto gain = identify::MakeFollowGain(truth, 1e-3, 60.0);
  const double rms = Rms_m(identify::PredictionErrors_m(truth, Everything(), gain));
  EXPECT_LT(rms, 4.5e-9);
  EXPECT_GT(rms, 1.5e-9);
}

TEST(SimulationTest, RowsOfTheRunUpAreSimulatedAndNotCompared) {
  const TableAxis truth = Exactly(PlainAxis());
  const auto gain = identify::MakeFollowGain(truth, 1e-3, 60.0);
  Measured record = Everything();
  const std::vector<double> all = identify::PredictionErrors_m(truth, record, gain);
  record.run_up = 3000;
  const std::vector<double> behind = identify::PredictionErrors_m(truth, record, gain);
  EXPECT_EQ(behind, std::vector<double>(all.begin() + 3000, all.end()));
  // Of two records, each its own.
  const auto both = identify::PredictionErrors_m({{truth, gain}}, {record, Everything()}, 1);
  ASSERT_EQ(static_cast<std::size_t>(both.rows()), behind.size() + all.size());
  EXPECT_EQ(both(0), behind.front());
  EXPECT_EQ(both(static_cast<Eigen::Index>(behind.size()) + 1000), all[1000]);
}

TEST(SimulationTest, EveryPartOfTheModelMatters) {
  const TableAxis truth = Exactly(PlainAxis());
  const auto gain = identify::MakeFollowGain(truth, 1e-3, 60.0);
  const double best = Rms_m(identify::PredictionErrors_m(truth, Everything(), gain));
  const std::vector<std::function<void(TableAxis&)>> wrongs = {
      [](TableAxis& a) { a.motor_inertia *= 1.05; },
      [](TableAxis& a) { a.load_inertia *= 1.2; },
      [](TableAxis& a) { a.stiffness *= 1.1; },
      [](TableAxis& a) { a.friction.Fc_plus *= 1.05; },
      [](TableAxis& a) { a.friction.Fs_minus *= 1.05; },
      [](TableAxis& a) { a.friction.vs *= 1.3; },
      [](TableAxis& a) { a.friction.s0 *= 1.1; },
      [](TableAxis& a) { a.friction.s1 *= 1.5; },
      [](TableAxis& a) { a.friction.s2 *= 1.1; },
      [](TableAxis& a) { a.delay_s += 0.1e-3; },
      [](TableAxis& a) { a.offset += 1.0; },
  };
  for (std::size_t i = 0; i < wrongs.size(); ++i) {
    TableAxis wrong = truth;
    wrongs[i](wrong);
    EXPECT_GT(Rms_m(identify::PredictionErrors_m(wrong, Everything(), gain)), 1.1 * best) << "number " << i;
  }
}

TEST(SimulationTest, ForeseesCoggingFrictionOnTheMotorAndASwingingPart) {
  const auto record = [](const plant::AxisParameters& p) {
    const std::vector<double> speeds = {1e-3, 10e-3, 50e-3};
    const GeneratedAxis axis{p};
    return axis.Drive(StrokesDuration_s(5e-3, speeds), Strokes(5e-3, speeds),
                      [](double t) { return 30.0 * std::sin(700.0 * t); });
  };
  const auto error_m = [](const Measured& data, const TableAxis& model) {
    return Rms_m(identify::PredictionErrors_m(model, data, identify::MakeFollowGain(model, 1e-3, 60.0)));
  };
  plant::AxisParameters cogging = PlainAxis(), motor = PlainAxis(), side = PlainAxis();
  cogging.effects.cogging = CoggingEffect{};
  cogging.effects.cogging->amplitude_Nm = 6e-3;
  cogging.effects.cogging->phase_rad = 0.5;
  motor.motor_friction_share = 0.3;
  const double omega = 2.0 * 3.14159265358979 * 180.0;
  side.side_modes = {{2.0, 2.0 * omega * omega, 0.04 * 2.0 * omega}};
  TableAxis with_cogging = Exactly(cogging), with_motor = Exactly(motor), with_side = Exactly(side);
  const double force_N = 6e-3 / cogging.radius_m_rad;
  with_cogging.cogging[0] = {12.0, force_N * std::sin(0.5), force_N * std::cos(0.5)};
  with_motor.motor_friction_share = 0.3;
  with_side.side = {0.2, 180.0, 0.02};
  for (const auto& [truth, model] :
       {std::pair{cogging, with_cogging}, std::pair{motor, with_motor}, std::pair{side, with_side}}) {
    const Measured data = record(truth);
    EXPECT_LT(error_m(data, model), 6e-9);
    EXPECT_GT(error_m(data, Exactly(truth)), 2.0 * error_m(data, model));
  }
}

TEST(SimulationTest, MissingRowsLeaveAGapAndNothingElse) {
  Measured record = Everything();
  for (std::size_t k = 5000; k < 5040; ++k) {
    record.present[k] = 0;
    record.position_m[k] = std::nan("");
  }
  const TableAxis truth = Exactly(PlainAxis());
  const auto errors =
      identify::PredictionErrors_m(truth, record, identify::MakeFollowGain(truth, 1e-3, 60.0));
  for (std::size_t k = 5000; k < 5040; ++k) EXPECT_EQ(errors[k], 0.0);
  EXPECT_LT(Rms_m(errors), 6e-9);
}

// One mass without friction under a constant force: x = F t^2 / 2 m from the first command on.
TEST(SimulationTest, AFreeMassMovesAsByHand) {
  TableAxis axis;
  axis.motor_inertia = 20.0;
  axis.friction = {1e-6, 1e-6, 1e-6, 1e-6, 1e-3, 1.0, 1.0, 0.0, 1e-3, 0.0};
  axis.delay_s = 1e-3;
  Measured d;
  d.period_s = 1e-3;
  for (int k = 0; k < 300; ++k) {
    d.force_N.push_back(k >= 100 ? 40.0 : 0.0);
    d.present.push_back(1);
    const double t = std::max(0, k - 101) * 1e-3;
    d.position_m.push_back(0.5 * 2.0 * t * t);
  }
  const auto errors = identify::PredictionErrors_m(axis, d, identify::MakeFollowGain(axis, d.period_s, 60.0));
  // The lag of 5 us that every axis has, and friction of a micronewton, are left.
  for (std::size_t k = 0; k < errors.size(); ++k) EXPECT_NEAR(errors[k], 0.0, 2e-8) << k;
}

/// The first seconds of Everything(), with a hole, and axes that differ in all that an axis may have.
Measured ShortRecord() {
  Measured d = Everything();
  d.force_N.resize(4000);
  d.position_m.resize(4000);
  d.present.resize(4000);
  for (std::size_t k = 1500; k < 1520; ++k) d.present[k] = 0;
  return d;
}
std::vector<identify::Followed> ManyAxes(const Measured& record) {
  const std::vector<std::function<void(TableAxis&)>> changes = {
      [](TableAxis&) {},
      [](TableAxis& a) { a.stiffness *= 1.1; },
      [](TableAxis& a) { a.delay_s += 0.13e-3; },
      [](TableAxis& a) { a.motor_friction_share = 0.3; },
      [](TableAxis& a) {
        a.side = {0.2, 180.0, 0.02};
      },
      [](TableAxis& a) {
        a.cogging[0] = {12.0, 1.0, -2.0};
      },
      [](TableAxis& a) { a.friction_on_load = false; },
      [](TableAxis& a) { a.friction.exponent = 2.0; },
      [](TableAxis& a) {
        a.variation.turn_plus = {0.1, 0.02, 0.03, 0.0};
      },
      [](TableAxis& a) { a.friction.s1 = 0.0; },
      [](TableAxis& a) { a.friction.vs *= 1.3; },
      [](TableAxis& a) { a.offset = 2.0; },
  };
  std::vector<identify::Followed> axes;
  for (const auto& change : changes) {
    TableAxis axis = Exactly(PlainAxis());
    change(axis);
    axes.push_back({axis, identify::FollowGainFor(axis, record)});
  }
  return axes;
}

TEST(SimulationTest, AnAxisIsTheSameWhateverRunsBesideIt) {
  const Measured record = ShortRecord();
  const auto axes = ManyAxes(record);
  const Eigen::MatrixXd together = identify::PredictionErrors_m(axes, {record, record}, 2);
  ASSERT_EQ(together.rows(), 8000);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const std::vector<double> alone = identify::PredictionErrors_m(axes[i].axis, record, axes[i].gain);
    const auto column = together.col(static_cast<Eigen::Index>(i));
    for (Eigen::Index k = 0; k < 4000; ++k) {
      ASSERT_EQ(column(k), alone[static_cast<std::size_t>(k)]) << "axis " << i << " row " << k;
      ASSERT_EQ(column(4000 + k), column(k)) << "axis " << i << " row " << k;
    }
  }
}

TEST(SimulationTest, WhatDivergesIsNoPerfectPrediction) {
  const Measured record = ShortRecord();
  TableAxis axis = Exactly(PlainAxis());
  axis.damping = -1e6;
  const std::vector<double> errors =
      identify::PredictionErrors_m(axis, record, identify::FollowGainFor(Exactly(PlainAxis()), record));
  EXPECT_FALSE(std::isfinite(errors.back()));
}

TEST(SimulationTest, LevelsVaryWithPlaceAndTurnAsStated) {
  TableAxis axis;
  axis.turn_m = 5e-3;
  axis.variation.low_m = 0.0;
  axis.variation.high_m = 0.1;
  axis.variation.place = {0.2, 0.0, 0.0};
  axis.variation.turn_plus = {0.1, 0.0, 0.0, 0.0};
  EXPECT_NEAR(identify::LevelFactor(axis, 0.0, 0.05, true), 1.1, 1e-12);
  EXPECT_NEAR(identify::LevelFactor(axis, 0.0, 0.05, false), 1.0, 1e-12);
  EXPECT_NEAR(identify::LevelFactor(axis, 2.5e-3, 0.1, true), 1.2 * 0.9, 1e-12);
  EXPECT_NEAR(identify::LevelFactor(axis, 0.0, 5.0, false), 1.2, 1e-12);
}

}  // namespace
}  // namespace contour::test
