#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/control/support/two_inertia_machine.h"

// The loop that goes by a linear scale: what it is worth, and what comes of a scale that lies.
namespace contour {
namespace {

using test::FamilyAxis;
using test::Machine;
using test::ModelError;
using test::Result;
using test::ScaledLoop;

/// Found on t30 (docs/laboratory/loop_designs.md); used on all.
constexpr LoopTuning kScaleTuning{.regulator_Hz = 32.4,
                                  .windup_weight = 0.47,
                                  .velocity_weight = 0.08,
                                  .disturbance_Hz = 345,
                                  .motor_force_Hz = 452,
                                  .table_force_Hz = 1048,
                                  .notch_ratio = 1.48,
                                  .notch_pole_damping = 0.13,
                                  .notch_zero_damping = 0.29,
                                  .scale_noise_ratio = 0.12,
                                  .bias_Hz = 151.4};

double WindUp_m(const FamilyAxis& a) { return a.friction_N / a.stiffness_N_m; }

// In units of the wind-up. Without the scale: 0.4 to 0.5 and 0.8 to 1.2.
TEST(TwoInertiaScale, DrawsCirclesAtTheTableWhateverTheStiffness) {
  for (const std::size_t i : {0u, 1u, 2u}) {
    const FamilyAxis& member = test::kFamily[i];
    for (const double stiffness : {0.98, 0.7, 1.3}) {
      const ModelError error{.stiffness = stiffness};
      const Result small = Draw(member, error, 1e-4, std::numbers::pi / 4, 0.0, ScaledLoop{kScaleTuning});
      EXPECT_LT(small.peak_m, 0.2 * WindUp_m(member)) << member.name << " " << stiffness;
      EXPECT_LT(small.swing_m, 0.2 * WindUp_m(member)) << member.name << " " << stiffness;
      const Result large = Draw(member, error, 5e-3, 1.5915, 0.0, ScaledLoop{kScaleTuning});
      EXPECT_LT(large.peak_m, (stiffness < 0.9 ? 1.0 : 0.45) * WindUp_m(member))
          << member.name << " " << stiffness;
    }
  }
}

TEST(TwoInertiaScale, IsNotLostWithAModelThatIsThirtyPercentOff) {
  const FamilyAxis& heavy = test::kFamily[1];
  for (const double masses : {0.7, 1.3}) {
    for (const double stiffness : {0.7, 1.3}) {
      const Result r = Draw(heavy, {.masses = masses, .stiffness = stiffness}, 1e-4, std::numbers::pi / 4,
                            0.0, ScaledLoop{kScaleTuning});
      EXPECT_LT(r.peak_m, 1.5 * WindUp_m(heavy)) << masses << " " << stiffness;
      EXPECT_LT(r.swing_m, 0.2 * WindUp_m(heavy)) << masses << " " << stiffness;
    }
  }
}

// A tenth of rated force through a lag of 4 ms, as a cutting force comes.
TEST(TwoInertiaScale, SeesAForceOnTheTable) {
  const FamilyAxis& member = test::kFamily[1];
  const auto rms_m = [&](const std::optional<ScaledLoop>& scale) {
    Machine machine(member, {}, 0.0, scale);
    const test::SmoothSine sine{5e-3, 1.5915, 0.2};
    double sum_m2 = 0.0;
    for (int k = 0; k < 2600; ++k) {
      const double since_s = test::kPeriod_s * (k - 2400);
      machine.axis.extra_force_N =
          since_s > 0.0 ? 0.1 * member.rated_N * (1.0 - std::exp(-since_s / 4e-3)) : 0.0;
      const double e = machine.Step(sine);
      if (since_s > 0.01) sum_m2 += e * e;
    }
    return std::sqrt(sum_m2 / 190.0);
  };
  EXPECT_LT(rms_m(ScaledLoop{kScaleTuning}), 0.25 * rms_m(std::nullopt));
}

enum class Lie { kFrozen, kBackwards, kJump, kSilent, kWrongUnit };

struct Failed {
  double largest_m = 0.0;  ///< table from its reference, from the fault on
  double left_m = 0.0;     ///< the same from half a second after it
  int until = 0;           ///< cycles until it was named; 0: never
  Reason reason = Reason::kNone;
};

/// A scale that begins to lie in the middle of a motion, and goes on.
Failed Fail(const FamilyAxis& member, Lie lie, double amplitude_m, double frequency_Hz, double from_s = 1.5) {
  Machine machine(member, {}, 0.0, ScaledLoop{kScaleTuning});
  const test::SmoothSine sine{amplitude_m, frequency_Hz, 0.2};
  const int begin = static_cast<int>(from_s * 1000.0), end = begin + 1500;
  double first_m = 0.0;
  Failed f;
  for (int k = 0; k < end; ++k) {
    if (k == begin)
      machine.tamper = [&, seen = false](double& scale_m) mutable {
        if (!seen) first_m = scale_m;
        seen = true;
        switch (lie) {
          case Lie::kFrozen:
            scale_m = first_m;
            break;
          case Lie::kBackwards:
            scale_m = 2.0 * first_m - scale_m;
            break;
          case Lie::kJump:
            scale_m += 50e-6;
            break;
          case Lie::kWrongUnit:
            scale_m = first_m + 1.5 * (scale_m - first_m);
            break;
          case Lie::kSilent:
            return false;
        }
        return true;
      };
    const double e = machine.Step(sine);
    if (k < begin) continue;
    f.largest_m = std::max(f.largest_m, std::abs(e));
    if (k > begin + 500) f.left_m = std::max(f.left_m, std::abs(e));
    if (f.until == 0 && machine.estimate.scale != Reason::kNone) {
      f.until = k - begin + 1;
      f.reason = machine.estimate.scale;
      EXPECT_FALSE(machine.estimate.by_scale);
    }
  }
  return f;
}

// Where the lie begins the table is as it was within the micrometres that motor and scale may differ by, or
// it is braked within a tenth of what is safe to travel (2 mm).
TEST(TwoInertiaScale, AScaleThatLiesMovesNothingFar) {
  for (const FamilyAxis& member : test::kFamily) {
    for (const Lie lie : {Lie::kFrozen, Lie::kBackwards, Lie::kJump}) {
      for (const double amplitude_m : {1e-5, 1e-4, 5e-3}) {
        const Failed f = Fail(member, lie, amplitude_m, amplitude_m > 1e-3 ? 1.6 : 0.8);
        EXPECT_EQ(f.reason, Reason::kScaleDoubted) << member.name << " " << amplitude_m;
        EXPECT_LT(f.largest_m, 0.25e-3) << member.name << " " << amplitude_m;
        EXPECT_LT(f.left_m, 3.0 * WindUp_m(member)) << member.name << " " << amplitude_m;
      }
    }
  }
}

TEST(TwoInertiaScale, GoesOnByTheMotorWithoutAJumpWhenTheScaleIsSilent) {
  for (const FamilyAxis& member : test::kFamily) {
    for (const double amplitude_m : {1e-4, 5e-3}) {
      const Failed f = Fail(member, Lie::kSilent, amplitude_m, amplitude_m > 1e-3 ? 1.6 : 0.8);
      EXPECT_EQ(f.reason, Reason::kScaleLost) << member.name;
      EXPECT_EQ(f.until, 3) << member.name;
      EXPECT_LT(f.largest_m, 2.0 * WindUp_m(member)) << member.name << " " << amplitude_m;
    }
  }
}

TEST(TwoInertiaScale, AScaleOfAnotherUnitIsDoubtedOnceItMatters) {
  const Failed f = Fail(test::kFamily[1], Lie::kWrongUnit, 5e-3, 1.6);
  EXPECT_EQ(f.reason, Reason::kScaleDoubted);
  EXPECT_LT(f.largest_m, 5e-6);
}

}  // namespace
}  // namespace contour
