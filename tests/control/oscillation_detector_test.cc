#include "control/oscillation_detector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;

OscillationBounds Bounds() {
  OscillationBounds b;
  b.low_Hz = 2.0;
  b.low_moving_Hz = 8.0;
  b.swing_m = 0.4e-6;
  b.swing_N = 1.6;
  b.swing_moving_N = 120.0;
  b.mass_kg = 90.0;
  b.growing_m = 60e-6;
  return b;
}

struct Found {
  int lasting = 0;
  int growing = 0;
  double first_s = -1.0;
};

template <class Sample>
Found Watch(double seconds, Sample sample, OscillationBounds bounds = Bounds()) {
  OscillationDetector detector(bounds);
  Found found;
  for (double t = 0.0; t < seconds; t += kPeriod_s) {
    const Oscillation o = detector.Step(sample(t));
    found.lasting += o == Oscillation::kLasting ? 1 : 0;
    found.growing += o == Oscillation::kGrowing ? 1 : 0;
    if (o != Oscillation::kNone && found.first_s < 0.0) found.first_s = t;
  }
  return found;
}

double Wave(double t, double frequency_Hz) { return std::sin(2.0 * std::numbers::pi * frequency_Hz * t); }

// The case found on the product: 16 Hz at rest, 1.6 um and 6 N peak to peak.
TEST(OscillationDetector, ALimitCycleAtRestIsFoundWithinTwelveHalfWaves) {
  const Found f = Watch(2.0, [](double t) {
    return OscillationSample{0.8e-6 * Wave(t, 16.0), 3.0 * Wave(t, 16.0), 0.0, 0.0};
  });
  EXPECT_GE(f.lasting, 4);
  EXPECT_EQ(f.growing, 0);
  EXPECT_LT(f.first_s, 0.5);
}

TEST(OscillationDetector, WhatCountsAndTorqueStepsExplainIsNone) {
  EXPECT_EQ(Watch(5.0,
                  [](double t) {
                    return OscillationSample{0.15e-6 * Wave(t, 16.0), 3.0 * Wave(t, 16.0), 0.0, 0.0};
                  })
                .lasting,
            0);
  EXPECT_EQ(Watch(5.0,
                  [](double t) {
                    return OscillationSample{0.8e-6 * Wave(t, 16.0), 0.6 * Wave(t, 16.0), 0.0, 0.0};
                  })
                .lasting,
            0);
}

TEST(OscillationDetector, NoiseHasNoPeriod) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  double slow = 0.0;
  EXPECT_EQ(Watch(60.0,
                  [&](double) {
                    slow += 0.05 * (normal(random) - slow);
                    return OscillationSample{3e-6 * slow, 20.0 * slow, 0.0, 0.0};
                  })
                .lasting,
            0);
}

TEST(OscillationDetector, WhatDiesOutByItselfIsNone) {
  EXPECT_EQ(
      Watch(3.0,
            [](double t) {
              const double left = std::exp(-4.0 * t);  // 22 % per period
              return OscillationSample{40e-6 * left * Wave(t, 16.0), 200.0 * left * Wave(t, 16.0), 0.0, 0.0};
            })
          .lasting,
      0);
}

TEST(OscillationDetector, InMotionFrictionAndThePathExplainMore) {
  const auto moving = [](double force_N, double acceleration_m_s2, double frequency_Hz) {
    return Watch(3.0, [=](double t) {
      return OscillationSample{5e-6 * Wave(t, frequency_Hz), force_N * Wave(t, frequency_Hz), 0.05,
                               acceleration_m_s2 * Wave(t, frequency_Hz)};
    });
  };
  EXPECT_EQ(moving(40.0, 0.0, 30.0).lasting, 0) << "cogging";
  EXPECT_GT(moving(100.0, 0.0, 30.0).lasting, 0);
  EXPECT_EQ(moving(100.0, 1.0, 30.0).lasting, 0) << "the reference itself asks for it";
  EXPECT_EQ(moving(100.0, 0.0, 3.0).lasting, 0) << "slower than the loop";
}

TEST(OscillationDetector, GrowthIsToldBeforeItIsAFollowingError) {
  const Found f = Watch(2.0, [](double t) {
    const double grown = std::exp(6.0 * t);
    return OscillationSample{5e-6 * grown * Wave(t, 20.0), 100.0 * grown * Wave(t, 20.0), 0.05, 0.0};
  });
  EXPECT_GE(f.growing, 1);
}

TEST(OscillationDetector, AnExperimentExplainsWhatItPushesAndNoViolentSwing) {
  const auto watch = [](double swing_N, double pushed_N) {
    OscillationBounds bounds = Bounds();
    bounds.violent_N = 500.0;
    bounds.answered = 4.0;
    return Watch(
               2.0,
               [=](double t) {
                 return OscillationSample{20e-6 * Wave(t, 100.0), 0.5 * swing_N * Wave(t, 100.0), 0.0, 0.0,
                                          pushed_N * Wave(t, 30.0)};
               },
               bounds)
        .lasting;
  };
  EXPECT_GT(watch(100.0, 0.0), 0) << "no torque acts, a spring or a loop holds";
  EXPECT_EQ(watch(100.0, 50.0), 0);
  EXPECT_EQ(watch(880.0, 50.0), 0) << "the loop's answer";
  EXPECT_GT(watch(1000.0, 50.0), 0);
}

TEST(OscillationDetector, ZeroSwitchesOff) {
  OscillationBounds off = Bounds();
  off.half_waves = 0;
  const auto sample = [](double t) {
    return OscillationSample{0.8e-6 * Wave(t, 16.0), 3.0 * Wave(t, 16.0), 0.0, 0.0};
  };
  EXPECT_EQ(Watch(2.0, sample, off).lasting, 0);
}

// To and fro from cycle to cycle there are no half waves to be told apart; a step of the force is none.
TEST(OscillationDetector, FindsAForceThatChangesFromCycleToCycle) {
  OscillationBounds bounds;
  bounds.chatter_N = 100.0;
  OscillationDetector detector(bounds);
  int found = 0;
  for (int k = 0; k < 1000; ++k)
    found += detector.Step({.force_N = k % 2 == 0 ? 80.0 : -80.0}) == Oscillation::kLasting ? 1 : 0;
  EXPECT_GE(found, 5);
  detector.Reset();
  for (int k = 0; k < 1000; ++k)
    EXPECT_EQ(detector.Step({.force_N = k % 200 < 100 ? 800.0 : -800.0}), Oscillation::kNone) << k;
}

TEST(OscillationDetector, ViolentIsWhatTakesMuchOfTheTorque) {
  OscillationBounds bounds = Bounds();
  bounds.violent_N = 900.0;
  const auto is_violent = [&](double force_N) {
    OscillationDetector detector(bounds);
    bool violent = false, found = false;
    for (double t = 0.0; t < 1.0; t += kPeriod_s)
      if (detector.Step({20e-6 * Wave(t, 60.0), force_N * Wave(t, 60.0), 0.0, 0.0}) ==
          Oscillation::kLasting) {
        found = true;
        violent = violent || detector.violent();
      }
    EXPECT_TRUE(found) << force_N;
    return violent;
  };
  EXPECT_FALSE(is_violent(400.0));
  EXPECT_TRUE(is_violent(500.0));
}

/// What a violent alarm of the force alone needs: how often such a swing of 240 Hz is told, and told violent.
template <class Size>
Found Chattering(Size size_N) {
  OscillationBounds bounds = Bounds();
  bounds.chatter_N = bounds.swing_moving_N;
  OscillationDetector detector(bounds);
  Found found;
  for (double t = 0.0; t < 2.0; t += kPeriod_s)
    if (detector.Step({.force_N = size_N(t) * Wave(t, 240.0)}) == Oscillation::kLasting) {
      ++found.lasting;
      found.growing += detector.violent() ? 1 : 0;
    }
  return found;
}

TEST(OscillationDetector, ViolentFromCycleToCycleIsWhatHasGrown) {
  for (const double per_s : {15.0, 40.0, 200.0})
    EXPECT_GE(Chattering([&](double t) { return std::min(1500.0, std::exp(per_s * t)); }).growing, 1)
        << per_s;
}

// Before: it had hardly grown when it was told, and was told for ever without being violent.
TEST(OscillationDetector, ViolentFromCycleToCycleIsWhatStaysOverALoudBackground) {
  for (const double per_s : {1.5, 3.0, 10.0})
    EXPECT_GE(Chattering([&](double t) { return 50.0 * std::min(4.0, std::exp(per_s * t)); }).growing, 1)
        << per_s;
  // Nor is what was loud all along.
  EXPECT_EQ(Chattering([](double) { return 50.0; }).lasting, 0);
}

// However large: what it leaves rings, and dies out.
TEST(OscillationDetector, ASingleShockIsNotViolent) {
  for (const double per_s : {2.0, 5.0, 20.0, 60.0})
    for (const double shock_N : {500.0, 2000.0, 8000.0})
      EXPECT_EQ(Chattering([&](double t) {
                  return t < 0.5 ? 0.0 : shock_N * std::exp(-per_s * (t - 0.5));
                }).growing,
                0)
          << per_s << ' ' << shock_N;
}

// Before: the second was judged by what the first had left of its tail, and told violent, in 25 gaps of 100.
TEST(OscillationDetector, ASecondShockIsJudgedByItself) {
  OscillationBounds bounds = Bounds();
  bounds.chatter_N = 100.0;
  for (int gap = 0; gap < 100; ++gap) {
    const double second_s = 5.3 + 1.3e-3 * gap;
    OscillationDetector detector(bounds);
    int told = 0, violent = 0;
    for (int k = 0; k < 6000; ++k) {
      const double t = k * kPeriod_s;
      double size_N = 0.0;
      for (const double from_s : {0.1, second_s})
        if (t >= from_s) size_N += 400.0 * std::exp(-100.0 * (t - from_s));
      if (detector.Step({.force_N = k % 2 == 0 ? size_N : -size_N}) != Oscillation::kLasting) continue;
      ++told;
      violent += detector.violent() ? 1 : 0;
    }
    EXPECT_GE(told, 2) << gap;
    EXPECT_EQ(violent, 0) << gap;
  }
}

}  // namespace
}  // namespace contour
