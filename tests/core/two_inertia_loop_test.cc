#include "core/two_inertia_loop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

namespace contour {
namespace {

constexpr TwoInertiaAxis kBase{.motor_mass_kg = 79.0,
                               .table_mass_kg = 10.0,
                               .stiffness_N_m = 40e6,
                               .damping_Ns_m = 1100.0,
                               .viscous_Ns_m = 500.0,
                               .lag_s = 0.2e-3};
constexpr TwoInertiaAxis kSoft{.motor_mass_kg = 79.0,
                               .table_mass_kg = 60.0,
                               .stiffness_N_m = 15e6,
                               .damping_Ns_m = 1400.0,
                               .viscous_Ns_m = 900.0,
                               .lag_s = 0.2e-3,
                               .dead_time_s = 60e-6};
constexpr LoopTuning kTuning{.regulator_Hz = 18.0,
                             .windup_weight = 0.4,
                             .velocity_weight = 0.15,
                             .disturbance_Hz = 200.0,
                             .motor_force_Hz = 400.0,
                             .table_force_Hz = 80.0,
                             .notch_ratio = 0.77,
                             .notch_pole_damping = 0.7,
                             .notch_zero_damping = 0.2,
                             .scale_noise_ratio = 1.5,
                             .bias_Hz = 5.0};

void ExpectClose(double found, double expected) {
  EXPECT_NEAR(found, expected, 1e-6 * std::abs(expected) + 1e-9);
}

struct Gains {
  std::vector<std::array<double, 2>> observer;  // rows as scipy has them, without b where there is no scale
  std::vector<double> regulator;
};

void ExpectGains(const TwoInertiaLoop& loop, const Gains& expected) {
  for (std::size_t i = 0; i < kLoopMotion; ++i) {
    for (std::size_t j = 0; j < 2; ++j) ExpectClose(loop.gain[i][j], expected.observer[i][j]);
    ExpectClose(loop.regulator_motion[i], expected.regulator[i]);
  }
  for (std::size_t j = 0; j < 2; ++j) {
    if (loop.scale) ExpectClose(loop.gain[kObserverBias][j], expected.observer[5][j]);
    ExpectClose(loop.gain[kObserverDisturbance][j], expected.observer.back()[j]);
  }
  ASSERT_EQ(loop.queued + kLoopMotion, expected.regulator.size());
  for (std::size_t i = 0; i < loop.queued; ++i)
    ExpectClose(loop.regulator_queue[i], expected.regulator[kLoopMotion + i]);
}

// Numbers of tests/core/loop_by_scipy.py (scipy 1.10).
TEST(DesignLoop, HasTheGainsThatScipyFinds) {
  ExpectGains(DesignLoop(kBase, kTuning, 1e-3, false),
              {{{0.9721583454388275, 0},
                {1331.9873651160556, 0},
                {1.3461333047986976, 0},
                {519.4150120071115, 0},
                {0, 0},
                {-29469116.73266882, 0}},
               {1217653.1431990708, 12435.583879534672, -166976.2664843552, 2002.4462355585913,
                0.031020906551461936, 0.15252713105760374}});
}

TEST(DesignLoop, HasThemWithAScaleAndADeadTimeOfPartOfAPeriod) {
  ExpectGains(DesignLoop(kSoft, kTuning, 1e-3, true),
              {{{0.9492585507953519, 0.0038716907920956084},
                {1230.3324811687348, 44.22225495452996},
                {0.008052968978597919, 0.93501087304554},
                {72.19359027800509, 1087.4404214716058},
                {0, 0},
                {0.006594037666248407, -0.0002925934682743155},
                {2640080.1283567655, -46808032.467420496}},
               {-850800.1414583931, 14637.341827073322, 2458689.2503921194, 7882.666010797803,
                0.037436041752897525, 0.011247481275713391, 0.18983217388662563}});
}

TEST(DesignLoop, HasThemAtAnotherPeriod) {
  ExpectGains(DesignLoop(kBase, kTuning, 0.5e-3, false),
              {{{0.8513508355346098, 0},
                {1496.5618841238072, 0},
                {1.432211613022756, 0},
                {319.34566214951315, 0},
                {0, 0},
                {-34046371.938226104, 0}},
               {-147801.72820906356, 12472.137289900096, 1241055.2494836939, 1801.1471463726677,
                0.03164489105829387, 0.07919544110436963}});
}

/// The loop closed on its own model, under a force on the table from the first period on.
struct ForceRun {
  std::vector<double> table_m, found_N;
};
ForceRun RunUnderForce(const TwoInertiaLoop& loop, double force_N, std::size_t samples, bool closed = true) {
  ForceRun run;
  LoopMotion truth{}, x{};
  double bias = 0.0, d = 0.0;
  std::vector<double> queue(loop.queued, 0.0);
  double x1 = 0.0, x2 = 0.0, y1 = 0.0, y2 = 0.0;
  const auto advance = [&](const LoopMotion& m, const std::vector<double>& input, double disturbance_N) {
    LoopMotion next{};
    for (std::size_t i = 0; i < kLoopMotion; ++i) {
      next[i] = loop.motion_from_disturbance[i] * disturbance_N;
      for (std::size_t k = 0; k < kLoopMotion; ++k) next[i] += loop.motion_from_motion[i][k] * m[k];
      for (std::size_t k = 0; k < 2 && k < input.size(); ++k)
        next[i] += loop.motion_from_input[k][i] * input[k];
    }
    return next;
  };
  for (std::size_t j = 0; j < samples; ++j) {
    const double encoder = truth[0] - x[0] - bias, scale = truth[2] - x[2];
    const auto share = [&](std::size_t i) { return loop.gain[i][0] * encoder + loop.gain[i][1] * scale; };
    for (std::size_t i = 0; i < kLoopMotion; ++i) x[i] += share(i);
    bias += share(kObserverBias);
    d += share(kObserverDisturbance);
    double wanted = loop.disturbance_to_command * d;
    for (std::size_t i = 0; i < kLoopMotion; ++i) wanted -= loop.regulator_motion[i] * x[i];
    for (std::size_t i = 0; i < loop.queued; ++i) wanted -= loop.regulator_queue[i] * queue[i];
    if (!closed) wanted = 0.0;
    const Biquad& f = loop.filter;
    const double command = f.b0 * wanted + f.b1 * x1 + f.b2 * x2 - f.a1 * y1 - f.a2 * y2;
    x2 = x1, x1 = wanted, y2 = y1, y1 = command;
    std::vector<double> input = queue;
    input.push_back(command);
    run.table_m.push_back(truth[2]);
    run.found_N.push_back(d);
    truth = advance(truth, input, force_N);
    x = advance(x, input, d);
    for (std::size_t i = 0; i < loop.queued; ++i) queue[i] = input[i + 1];
  }
  return run;
}

TEST(DesignLoop, HoldsTheTableUnderAForce) {
  for (const bool scale : {false, true}) {
    for (const TwoInertiaAxis& axis : {kBase, kSoft}) {
      const ForceRun run = RunUnderForce(DesignLoop(axis, kTuning, 1e-3, scale), 80.0, 1000);
      EXPECT_GT(std::abs(run.table_m[20]), 1e-6);
      EXPECT_LT(std::abs(run.table_m.back()), 1e-9);
      EXPECT_NEAR(run.found_N.back(), 80.0, 1e-3);
    }
  }
}

TEST(DesignLoop, StatesHowTheForceThatIsFoundFollowsTheTrueOne) {
  for (const bool scale : {false, true}) {
    const TwoInertiaLoop loop = DesignLoop(kSoft, kTuning, 1e-3, scale);
    for (const bool closed : {false, true}) {
      const ForceRun run = RunUnderForce(loop, 1.0, kLoopTaps, closed);
      double sum = 0.0;
      for (std::size_t j = 0; j < kLoopTaps; ++j) {
        sum += loop.disturbance_response[j];
        EXPECT_NEAR(run.found_N[j], sum, 1e-6);
      }
    }
    EXPECT_EQ(loop.disturbance_response[0], 0.0) << "not before it has moved anything";
    EXPECT_NEAR(std::accumulate(loop.disturbance_response.begin(), loop.disturbance_response.end(), 0.0), 1.0,
                0.02);
  }
}

TEST(DesignLoop, FollowsTheUnitsOfTheAxis) {
  // Ten times the mass and stiffness is the same axis with ten times the force.
  TwoInertiaAxis heavy = kBase;
  for (double* v : {&heavy.motor_mass_kg, &heavy.table_mass_kg, &heavy.stiffness_N_m, &heavy.damping_Ns_m,
                    &heavy.viscous_Ns_m})
    *v *= 10.0;
  const TwoInertiaLoop one = DesignLoop(kBase, kTuning, 1e-3, true);
  const TwoInertiaLoop ten = DesignLoop(heavy, kTuning, 1e-3, true);
  for (std::size_t i = 0; i < kLoopMotion; ++i) {
    const double unit = i == 4 ? 1.0 : 10.0;
    EXPECT_NEAR(ten.regulator_motion[i], unit * one.regulator_motion[i],
                1e-9 * std::abs(ten.regulator_motion[i]));
  }
  EXPECT_NEAR(ten.gain[kObserverDisturbance][0], 10.0 * one.gain[kObserverDisturbance][0],
              1e-9 * std::abs(ten.gain[kObserverDisturbance][0]));
}

TEST(DesignLoop, ADeadTimeOfAWholePeriodIsOneMoreCycle) {
  TwoInertiaAxis late = kBase, queued = kBase;
  late.dead_time_s = 1e-3;
  queued.delay_cycles = 2;
  const TwoInertiaLoop a = DesignLoop(late, kTuning, 1e-3, false);
  const TwoInertiaLoop b = DesignLoop(queued, kTuning, 1e-3, false);
  EXPECT_EQ(a.queued, 2u);
  EXPECT_EQ(a.regulator_queue, b.regulator_queue);
  EXPECT_EQ(a.regulator_motion, b.regulator_motion);
  EXPECT_GT(b.regulator_queue[0], 0.0);
  EXPECT_GT(b.regulator_queue[1], 0.0);
}

TEST(DesignLoop, WorksOnATorqueThatIsReportedWithoutDelay) {
  TwoInertiaAxis reported = kBase;
  reported.delay_cycles = 0;
  reported.lag_s = 0.0;
  const TwoInertiaLoop loop = DesignLoop(reported, kTuning, 1e-3, false);
  EXPECT_EQ(loop.queued, 0u);
  const ForceRun run = RunUnderForce(loop, 10.0, 500);
  EXPECT_NEAR(run.found_N.back(), 10.0, 1e-3);
}

TEST(DesignLoop, FilterHasItsZeroAndItsGain) {
  const TwoInertiaLoop loop = DesignLoop(kSoft, kTuning, 1e-3, false);
  const Biquad& f = loop.filter;
  EXPECT_NEAR((f.b0 + f.b1 + f.b2) / (1.0 + f.a1 + f.a2), 1.0, 1e-12);
  const double w = 2.0 * std::numbers::pi * kTuning.notch_ratio * ModeFrequency_Hz(kSoft) * 1e-3;
  const std::complex<double> z = std::polar(1.0, -w);
  const auto gain = std::abs((f.b0 + f.b1 * z + f.b2 * z * z) / (1.0 + f.a1 * z + f.a2 * z * z));
  EXPECT_NEAR(gain, kTuning.notch_zero_damping / kTuning.notch_pole_damping, 1e-9);
}

TEST(ModeFrequency, IsThatOfMotorAgainstTable) {
  EXPECT_NEAR(ModeFrequency_Hz(kBase), 338.0, 1.0);
  EXPECT_NEAR(ModeFrequency_Hz(kSoft), 106.0, 1.0);
}

std::string WhatIsThrown(const TwoInertiaAxis& axis, const LoopTuning& tuning) {
  try {
    DesignLoop(axis, tuning, 1e-3, true);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "nothing";
}

TEST(DesignLoop, NamesTheValueThatCannotBe) {
  TwoInertiaAxis axis = kBase;
  axis.table_mass_kg = 0.0;
  EXPECT_EQ(WhatIsThrown(axis, kTuning), "table_mass_kg: expected a positive number");
  LoopTuning tuning = kTuning;
  tuning.bias_Hz = -1.0;
  EXPECT_EQ(WhatIsThrown(kBase, tuning), "bias_Hz: expected a positive number");
  axis = kBase;
  axis.dead_time_s = 8e-3;
  EXPECT_EQ(WhatIsThrown(axis, kTuning), "dead_time_s: expected at most 6 periods of delay");
}

}  // namespace
}  // namespace contour
