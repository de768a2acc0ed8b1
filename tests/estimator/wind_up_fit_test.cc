#include "estimator/wind_up_fit.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;
constexpr double kMass_kg = 90.0;
constexpr double kCommissioned_N_m = 44e6;
constexpr double kSigma0_N_m = 5e6;
constexpr double kLevel_N = 50.0;
constexpr int kSubsteps = 50;

WindUpFit::Tuning Tuning(double stiffness_std = 0.1) {
  return {kPeriod_s, kCommissioned_N_m, stiffness_std, 2e-3, 3000.0, 2e-3, 500.0};
}

/// Friction of a table that has moved so far since the last call, at this speed.
using Friction = std::function<double(double moved_m, double velocity_m_s)>;

Friction LuGre(double sigma0_N_m, double level_N) {
  return [=, bristle_N = 0.0](double moved_m, double velocity_m_s) mutable {
    const double target_N = std::copysign(level_N, moved_m);
    bristle_N += (target_N - bristle_N) * (1.0 - std::exp(-sigma0_N_m * std::abs(moved_m) / level_N));
    const double u = velocity_m_s / 2e-3;
    const double slip = 1.0 - std::copysign(bristle_N, bristle_N * moved_m) / level_N;
    return bristle_N + 3000.0 * std::exp(-u * u) * velocity_m_s * slip + 500.0 * velocity_m_s;
  };
}

/// Ten elements in parallel, breaking away one after the other.
Friction MaxwellSlip(double level_N) {
  return [=, force_N = std::array<double, 10>{}](double moved_m, double) mutable {
    double sum_N = 0.0;
    for (std::size_t i = 0; i < force_N.size(); ++i) {
      const double slips_m = 0.5e-6 * std::pow(40.0, static_cast<double>(i) / 9.0);
      const double most_N = 0.1 * level_N;
      force_N[i] = std::clamp(force_N[i] + most_N / slips_m * moved_m, -most_N, most_N);
      sum_N += force_N[i];
    }
    return sum_N;
  };
}

struct Run {
  double stiffness_N_m = 40e6;
  double amplitude_m = 1e-4;
  double frequency_Hz = 0.785;
  double count_m = 0.0;
  double noise_m = 1.4e-9;
  double seconds = 12.0;
  double sigma0_N_m = kSigma0_N_m;
  bool alone = false;
  double force_noise_N = 0.0;  ///< of the torque as told
};

/// A table on a screw that follows a sine; the motor leads it by what the screw carries.
void Drive(WindUpFit& fit, Friction friction, const Run& run) {
  const double omega = 2.0 * std::numbers::pi * run.frequency_Hz;
  double table_m = 0.0, before_N = 0.0;
  std::uint32_t random = 1;
  const auto cycles = static_cast<int>(run.seconds / kPeriod_s);
  for (int k = 1; k <= cycles; ++k) {
    const double t_s = k * kPeriod_s;
    double force_N = 0.0, velocity_m_s = 0.0;
    for (int i = 1; i <= kSubsteps; ++i) {
      const double at_s = t_s - kPeriod_s * (1.0 - static_cast<double>(i) / kSubsteps);
      const double next_m = run.amplitude_m * std::sin(omega * at_s);
      velocity_m_s = run.amplitude_m * omega * std::cos(omega * at_s);
      before_N = friction(next_m - table_m, velocity_m_s);
      table_m = next_m;
      force_N += (before_N - kMass_kg * run.amplitude_m * omega * omega * std::sin(omega * at_s)) / kSubsteps;
    }
    random = random * 1664525u + 1013904223u;
    double motor_m = table_m + before_N / run.stiffness_N_m + run.noise_m * (random / 2147483648.0 - 1.0);
    if (run.count_m > 0.0) motor_m = run.count_m * std::round(motor_m / run.count_m);
    random = random * 1664525u + 1013904223u;
    force_N += run.force_noise_N * (random / 2147483648.0 - 1.0);
    fit.Learn({motor_m, force_N, kMass_kg, velocity_m_s > 0.0 ? 1 : -1, run.alone, 1.2 * kLevel_N, 1.0,
               run.sigma0_N_m});
  }
}

TEST(WindUpFit, FindsAScrewThatIsStifferThanCommissioned) {
  for (const double truth_N_m : {50e6, 60e6}) {
    WindUpFit fit(Tuning(0.3));
    Drive(fit, LuGre(kSigma0_N_m, kLevel_N), {.stiffness_N_m = truth_N_m});
    EXPECT_GE(fit.reversals(), 12);
    const double found_N_m = 1.0 / (1.0 / kCommissioned_N_m + fit.extra_compliance_m_N());
    EXPECT_NEAR(found_N_m, truth_N_m, 0.06 * truth_N_m);
  }
}

// Of what is stated and what reversals tell: less than stated, never less than the law of friction is off by.
TEST(WindUpFit, SaysHowFarItMayBeOff) {
  for (const double truth_N_m : {36e6, 44e6, 55e6}) {
    WindUpFit fit(Tuning(0.3));
    EXPECT_NEAR(fit.compliance_std_m_N(), 0.3 / kCommissioned_N_m, 1e-12);
    Drive(fit, LuGre(kSigma0_N_m, kLevel_N), {.stiffness_N_m = truth_N_m});
    EXPECT_LT(std::abs(fit.compliance_m_N() - 1.0 / truth_N_m), 2.0 * fit.compliance_std_m_N());
    EXPECT_LT(fit.compliance_std_m_N(), 0.2 / kCommissioned_N_m);
    EXPECT_GT(fit.compliance_std_m_N(), 0.04 / truth_N_m);
    fit.Reset();
    EXPECT_NEAR(fit.compliance_std_m_N(), 0.3 / kCommissioned_N_m, 1e-12);
  }
}

double Found_N_m(const WindUpFit& fit) {
  return 1.0 / (1.0 / kCommissioned_N_m + fit.extra_compliance_m_N());
}

TEST(WindUpFit, FindsASofterOne) {
  WindUpFit fit(Tuning());
  Drive(fit, LuGre(kSigma0_N_m, kLevel_N), {.stiffness_N_m = 30e6});
  EXPECT_NEAR(Found_N_m(fit), 30e6, 0.06 * 30e6);
}

// 1 per mille of the rated torque of a small motor, and its own loop's noise.
TEST(WindUpFit, FindsItFromTheTorqueThatADriveReports) {
  for (const double truth_N_m : {30e6, 60e6}) {
    WindUpFit::Tuning tuning = Tuning();
    tuning.most_std = 0.25;
    WindUpFit fit(tuning);
    Drive(fit, LuGre(kSigma0_N_m, kLevel_N),
          {.stiffness_N_m = truth_N_m, .frequency_Hz = 0.125, .seconds = 24.0, .force_noise_N = 1.4});
    EXPECT_GE(fit.reversals(), 3);
    EXPECT_NEAR(Found_N_m(fit), truth_N_m, 0.15 * truth_N_m);
  }
}

// Stated with 10 %, and off by half: what is stated counts for little then.
TEST(WindUpFit, WhatIsFoundOutweighsWhatWasStatedQuiteWrong) {
  WindUpFit fit(Tuning());
  Drive(fit, LuGre(kSigma0_N_m, kLevel_N), {.stiffness_N_m = 22e6, .seconds = 3.0});
  EXPECT_NEAR(Found_N_m(fit), 22e6, 0.1 * 22e6);
}

// Being late along the path is no error of the contour, going past its ends is.
TEST(WindUpFit, AnAnswerThatIsFartherOffThanMayBeTeachesNothing) {
  WindUpFit::Tuning tuning = Tuning();
  tuning.most_change = 0.4;
  WindUpFit far(tuning), near(tuning);
  Drive(far, LuGre(kSigma0_N_m, kLevel_N), {.stiffness_N_m = 22e6, .seconds = 3.0});
  EXPECT_EQ(far.extra_compliance_m_N(), 0.0);
  Drive(near, LuGre(kSigma0_N_m, kLevel_N), {.stiffness_N_m = 36e6});
  EXPECT_NEAR(Found_N_m(near), 36e6, 0.06 * 36e6);
}

TEST(WindUpFit, AnAxisThatMovesAloneStaysShort) {
  for (const double truth_N_m : {30e6, 40e6, 60e6}) {
    for (const double seconds : {0.5, 3.0, 20.0}) {
      WindUpFit fit(Tuning());
      Drive(fit, LuGre(kSigma0_N_m, kLevel_N),
            {.stiffness_N_m = truth_N_m, .seconds = seconds, .alone = true});
      EXPECT_GT(Found_N_m(fit), truth_N_m) << seconds;
    }
  }
  WindUpFit known(Tuning(0.005));
  Drive(known, LuGre(kSigma0_N_m, kLevel_N), {.stiffness_N_m = kCommissioned_N_m, .alone = true});
  EXPECT_NEAR(Found_N_m(known), kCommissioned_N_m, 0.03 * kCommissioned_N_m);
}

TEST(WindUpFit, TheBristlesStiffnessNeedNotBeKnown) {
  for (const double believed : {0.7, 1.4}) {
    WindUpFit fit(Tuning(0.3));
    Drive(fit, LuGre(kSigma0_N_m, kLevel_N), {.stiffness_N_m = 55e6, .sigma0_N_m = believed * kSigma0_N_m});
    EXPECT_GE(fit.reversals(), 12);
    EXPECT_NEAR(1.0 / (1.0 / kCommissioned_N_m + fit.extra_compliance_m_N()), 55e6, 6e6);
  }
}

// What the law of friction is wrong by is the same at every reversal. However many there are, they do not
// do away with a stiffness that is stated nearly as well.
TEST(WindUpFit, ManyReversalsAreNotWorthMoreThanTheLaw) {
  constexpr double kTruth_N_m = 36e6;
  WindUpFit::Tuning tuning = Tuning();
  tuning.same_law = 0.3;
  WindUpFit fit(tuning);
  Drive(fit, LuGre(kSigma0_N_m, kLevel_N), {.stiffness_N_m = kTruth_N_m, .seconds = 60.0});
  EXPECT_GE(fit.reversals(), 80);
  const double whole_way_m_N = 1.0 / kTruth_N_m - 1.0 / kCommissioned_N_m;
  EXPECT_GT(fit.extra_compliance_m_N(), 0.35 * whole_way_m_N);
  EXPECT_LT(fit.extra_compliance_m_N(), 0.8 * whole_way_m_N);
}

TEST(WindUpFit, NorDoesASoftBristleTeachOfAStiffScrew) {
  WindUpFit fit(Tuning());
  Drive(fit, LuGre(kSigma0_N_m / 3.0, kLevel_N), {.sigma0_N_m = kSigma0_N_m / 3.0});
  EXPECT_EQ(fit.reversals(), 0);
}

TEST(WindUpFit, AnotherKindOfFrictionTeachesNothing) {
  for (const double frequency_Hz : {0.125, 0.785}) {
    WindUpFit fit(Tuning());
    Drive(fit, MaxwellSlip(kLevel_N), {.frequency_Hz = frequency_Hz, .seconds = 10.0 / frequency_Hz});
    EXPECT_EQ(fit.reversals(), 0) << frequency_Hz;
  }
}

TEST(WindUpFit, NorDoesACoarseEncoder) {
  WindUpFit fit(Tuning());
  Drive(fit, LuGre(kSigma0_N_m, kLevel_N), {.count_m = 0.5e-6});
  EXPECT_EQ(fit.reversals(), 0);
}

TEST(WindUpFit, NorDoFastReversals) {
  WindUpFit fit(Tuning());
  Drive(fit, LuGre(kSigma0_N_m, kLevel_N), {.amplitude_m = 10e-3});
  EXPECT_EQ(fit.reversals(), 0);
}

TEST(WindUpFit, LearnsNothingWhereTheStiffnessIsCertain) {
  WindUpFit fit(Tuning(0.0));
  EXPECT_FALSE(fit.learns());
  WindUpFit nearly(Tuning(0.002));
  Drive(nearly, LuGre(kSigma0_N_m, kLevel_N), {.stiffness_N_m = 60e6});
  EXPECT_GE(nearly.reversals(), 12);
  EXPECT_LT(std::abs(nearly.extra_compliance_m_N()), 0.02 / kCommissioned_N_m);
}

TEST(WindUpFit, APauseAndAResetForgetWhatTheyShould) {
  WindUpFit fit(Tuning());
  Drive(fit, LuGre(kSigma0_N_m, kLevel_N), {.stiffness_N_m = 60e6});
  const double learnt = fit.extra_compliance_m_N();
  ASSERT_LT(learnt, 0.0);
  fit.Pause();
  EXPECT_EQ(fit.extra_compliance_m_N(), learnt);
  fit.Reset();
  EXPECT_EQ(fit.extra_compliance_m_N(), 0.0);
  EXPECT_EQ(fit.reversals(), 0);
}

}  // namespace
}  // namespace contour
