#include "estimator/friction_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

// What is published of the LuGre law: C. Canudas de Wit, H. Olsson, K. J. Astrom, P. Lischinsky, "A new model
// for control of systems with friction", IEEE TAC 40(3), 1995, with the parameters given there.
namespace contour {
namespace {

Friction Published() {
  Friction f;
  f.Fs_plus_N = f.Fs_minus_N = 1.5;
  f.Fc_plus_N = f.Fc_minus_N = 1.0;
  f.vs_m_s = 1e-3;
  f.stribeck_exponent = 2.0;
  f.sigma0_N_m = 1e5;
  f.sigma1_Ns_m = std::sqrt(1e5);
  f.sigma1_decay_m_s = 1e9;  // constant damping, as in the paper
  f.sigma2_Ns_m = 0.4;
  return f;
}

TEST(FrictionModel, LevelIsPositiveAndAsymmetric) {
  Friction f = Published();
  f.Fs_minus_N = 2.5;
  f.Fc_minus_N = 2.0;
  for (const double v : {-1.0, -1e-3, -1e-9, 0.0, 1e-9, 1e-3, 1.0}) EXPECT_GT(FrictionLevel(f, v), 0.0);
  EXPECT_DOUBLE_EQ(FrictionLevel(f, 0.0), 1.5);
  EXPECT_NEAR(FrictionLevel(f, -1e-12), 2.5, 1e-9);
  EXPECT_NEAR(FrictionLevel(f, 1e-3), 1.0 + 0.5 * std::exp(-1.0), 1e-15);
  EXPECT_NEAR(FrictionLevel(f, -1.0), 2.0, 1e-15);
  f.stribeck_exponent = 1.0;
  EXPECT_NEAR(FrictionLevel(f, 2e-3), 1.0 + 0.5 * std::exp(-2.0), 1e-15);
  f.stribeck_exponent = 1.5;
  EXPECT_NEAR(FrictionLevel(f, 2e-3), 1.0 + 0.5 * std::exp(-std::pow(2.0, 1.5)), 1e-14);
}

TEST(FrictionModel, BristleStepMatchesAFineIntegrationAtAnyStiffness) {
  // a t from 1e-9 to 100: explicit Euler would need thousands of steps at the upper end.
  for (const double v : {1e-12, 1e-6, 79e-6, -2e-3, 50e-3, -200e-3, 1.0}) {
    const double g = 45.0, s0 = 5e6, h = 1e-3;
    long double F = -20.0L;
    const int n = 200000;
    const long double dt = static_cast<long double>(h) / n;
    for (int i = 0; i < n; ++i) {
      const auto rate = [&](long double x) { return s0 * v - s0 * std::abs(v) * x / g; };
      const long double k1 = rate(F), k2 = rate(F + 0.5L * dt * k1);
      F += dt * k2;
    }
    EXPECT_NEAR(BristleAfter(-20.0, v, s0, g, h), static_cast<double>(F), 1e-6 * 65.0) << v;
  }
  EXPECT_EQ(BristleAfter(-20.0, 0.0, 5e6, 45.0, 1e-3), -20.0);
}

TEST(FrictionModel, SteadySlidingGivesTheStribeckCurve) {
  const Friction f = Published();
  for (const double v : {-0.1, -1e-3, -2e-4, 2e-4, 1e-3, 0.1}) {
    FrictionState s;
    s.velocity_m_s = v;
    for (int i = 0; i < 400000; ++i) {
      s.bristle_N = BristleAfter(s.bristle_N, v, f.sigma0_N_m, FrictionLevel(f, v), 1e-5);
    }
    const double expected = std::copysign(1.0 + 0.5 * std::exp(-(v / 1e-3) * (v / 1e-3)), v) + 0.4 * v;
    EXPECT_NEAR(TotalFriction(f, s), expected, 1e-9) << v;
  }
}

TEST(FrictionModel, PreslidingIsAHystereticSpring) {
  const Friction f = Published();
  // Force up to 95 % of break-away, down to its negative, and up again, slowly.
  FrictionState s;
  const double h = 1e-4;
  std::vector<double> up, down;
  const int quarter = 40000;
  for (int k = 0; k < 5 * quarter; ++k) {
    const double phase = static_cast<double>(k) / quarter;
    const double force = 1.425 * (phase < 1 ? phase : phase < 3 ? 2 - phase : phase - 4);
    s = StepRigid(f, s, 1.0, force, h);
    if (k == 2 * quarter) down.push_back(s.position_m);
    if (k == 4 * quarter) up.push_back(s.position_m);
  }
  // Micrometres at most, and at zero force the way back lies above the way there.
  EXPECT_LT(std::abs(s.position_m), 1e-4);
  EXPECT_GT(down[0] - up[0], 1e-6);
}

TEST(FrictionModel, DampingOfABristleWhoseLevelHasFallenIsBounded) {
  const Friction f = Published();
  const double v = 1e-3;
  const double most = (1.0 + kMostLevels) * f.sigma1_Ns_m * v;
  EXPECT_LE(std::abs(BristleDamping(f, 1.0, v, 1e-6)), most);
  EXPECT_LE(std::abs(BristleDamping(f, -1.0, v, 1e-6)), most);
  // Within two levels it is eq. 5.
  const double u = v / f.sigma1_decay_m_s;
  EXPECT_DOUBLE_EQ(BristleDamping(f, -0.8, v, 0.5), f.sigma1_Ns_m * Exp(-u * u) * (v + v * 0.8 / 0.5));
}

double LagLoopArea(double frequency_rad_s) {
  const Friction f = Published();
  const double h = 1e-5;
  double bristle = 0.0, area = 0.0, rising_minus_falling = 0.0;
  double previous = 0.0;
  const double period = 2.0 * std::numbers::pi / frequency_rad_s;
  const int n = static_cast<int>(3.0 * period / h);
  for (int k = 0; k < n; ++k) {
    const double t = k * h;
    const double v = 1.5e-3 + 1.3e-3 * std::sin(frequency_rad_s * t);
    const double g = FrictionLevel(f, v);
    bristle = BristleAfter(bristle, v, f.sigma0_N_m, g, h);
    const double force = bristle + BristleDamping(f, bristle, v, g) + f.sigma2_Ns_m * v;
    if (t > 2.0 * period) {
      area += force * (v - previous);
      rising_minus_falling += std::cos(frequency_rad_s * t) > 0.0 ? force : -force;
    }
    previous = v;
  }
  EXPECT_GT(rising_minus_falling, 0.0) << "friction is larger while the velocity rises";
  return area;
}

TEST(FrictionModel, FrictionLagsVelocityMoreAtHigherFrequency) {
  const double slow = LagLoopArea(1.0), middle = LagLoopArea(10.0), fast = LagLoopArea(25.0);
  EXPECT_GT(slow, 0.0);
  EXPECT_GT(middle, slow);
  EXPECT_GT(fast, middle);
}

double BreakAwayForce(double rate_N_s) {
  const Friction f = Published();
  FrictionState s;
  const double h = 1e-5;
  double largest = 0.0;
  for (int k = 0; s.velocity_m_s < 0.02; ++k) {
    const double force = rate_N_s * k * h;
    s = StepRigid(f, s, 1.0, force, h);
    largest = std::max(largest, TotalFriction(f, s));
    if (k > 100000000) break;
  }
  return largest;
}

TEST(FrictionModel, BreakAwayForceFallsWithTheForceRate) {
  const double slow = BreakAwayForce(1.0), middle = BreakAwayForce(5.0), fast = BreakAwayForce(50.0);
  EXPECT_LE(slow, 1.5 + 1e-3);
  EXPECT_GT(slow, 1.35);
  EXPECT_LT(middle, slow);
  EXPECT_LT(fast, middle);
  EXPECT_GT(fast, 1.0);
}

TEST(FrictionModel, AMassPulledByASpringSticksAndSlips) {
  const Friction f = Published();
  FrictionState s;
  const double h = 1e-4;
  int slips = 0;
  bool stuck = true;
  double slip_speed = 0.0;
  for (int k = 0; k < 400000; ++k) {  // 40 s
    const double spring = 2.0 * (0.1 * k * h - s.position_m);
    s = StepRigid(f, s, 1.0, spring, h);
    if (stuck && s.velocity_m_s > 0.05) {
      stuck = false;
      ++slips;
    } else if (!stuck && std::abs(s.velocity_m_s) < 1e-4) {
      stuck = true;
    }
    slip_speed = std::max(slip_speed, s.velocity_m_s);
  }
  EXPECT_GE(slips, 3);
  EXPECT_GT(slip_speed, 0.2);  // slips are faster than the pull
}

TEST(FrictionModel, APidControllerHunts) {
  const Friction f = Published();
  FrictionState s;
  const double h = 1e-4;
  double integral = 0.0, last_low = 1e9, last_high = -1e9;
  int crossings = 0;
  double previous = -1.0;
  for (int k = 0; k < 2000000; ++k) {  // 200 s
    const double error = 1.0 - s.position_m;
    integral += error * h;
    const double u = 3.0 * error + 4.0 * integral - 6.0 * s.velocity_m_s;
    s = StepRigid(f, s, 1.0, u, h);
    if (k > 1000000) {
      if (error * previous < 0.0) ++crossings;
      last_low = std::min(last_low, s.position_m);
      last_high = std::max(last_high, s.position_m);
    }
    previous = error;
  }
  EXPECT_GE(crossings, 2);  // still going in the second half
  EXPECT_GT(last_high - last_low, 0.01);
}

TEST(FrictionModel, BristleStaysInsideItsInvariantSet) {
  const Friction f = Published();
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  double bristle = 1.5;
  for (int k = 0; k < 200000; ++k) {
    const double v = normal(random) * std::pow(10.0, 4.0 * normal(random) - 4.0);
    bristle = BristleAfter(bristle, v, f.sigma0_N_m, FrictionLevel(f, v), 1e-3);
    ASSERT_LE(std::abs(bristle), 1.5 + 1e-12);
  }
}

TEST(FrictionModel, IsPassiveWhereDampingFades) {
  // v -> z is passive with storage z^2 / 2 always; v -> Fn with sigma0 z^2 / 2 where sigma1(v) |v| <= 4 g(v).
  Friction f = Published();
  f.sigma1_decay_m_s = 5e-3;
  for (double v = 0.0; v < 0.1; v += 1e-5) {
    ASSERT_LE(f.sigma1_Ns_m * std::exp(-(v / 5e-3) * (v / 5e-3)) * v, 4.0 * FrictionLevel(f, v));
  }
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  double bristle = 0.7, work = 0.0, work_z = 0.0, v = 0.0;
  const double start = 0.5 * bristle * bristle / f.sigma0_N_m;
  const double h = 1e-6;
  for (int k = 0; k < 400000; ++k) {
    v += -v * 20.0 * h + 0.05 * std::sqrt(h) * normal(random);
    const double g = FrictionLevel(f, v);
    const double before = bristle;
    bristle = BristleAfter(bristle, v, f.sigma0_N_m, g, h);
    const double mean = 0.5 * (before + bristle);
    work += h * v * (mean + BristleDamping(f, mean, v, g));
    work_z += h * v * mean / f.sigma0_N_m;
    ASSERT_GE(work, 0.5 * bristle * bristle / f.sigma0_N_m - start - 1e-9) << k;
    ASSERT_GE(work_z, 0.5 * bristle * bristle / (f.sigma0_N_m * f.sigma0_N_m) - start / f.sigma0_N_m - 1e-14)
        << k;
  }
}

TEST(FrictionModel, ReversalStartsWithTwiceTheBristleStiffness) {
  // Right after a saturated reversal dF/dx = sigma0 (1 + g_old / g_new).
  Friction f = Published();
  f.Fs_plus_N = f.Fc_plus_N = 1.0;
  f.Fs_minus_N = f.Fc_minus_N = 0.5;
  const double x = 1e-9, v = -1e-3;
  const double after = BristleAfter(1.0, v, f.sigma0_N_m, FrictionLevel(f, v), x / std::abs(v));
  EXPECT_NEAR((1.0 - after) / x, f.sigma0_N_m * (1.0 + 1.0 / 0.5), 1e-3 * f.sigma0_N_m);
}

TEST(FrictionModel, AStiffBristleStaysStableAtTheCyclePeriod) {
  // 3e7 N/m on 89 kg at 1 ms: stepping v and z with each other's old value grows by 14 % per step.
  Friction f = Published();
  f.Fs_plus_N = f.Fs_minus_N = f.Fc_plus_N = f.Fc_minus_N = 50.0;
  f.sigma0_N_m = 3e7;
  f.sigma1_Ns_m = 0.0;
  f.sigma2_Ns_m = 0.0;
  FrictionState s;
  s.velocity_m_s = 1e-5;
  double largest = 0.0;
  for (int k = 0; k < 20000; ++k) {
    s = StepRigid(f, s, 89.0, 0.0, 1e-3);
    if (k > 19000) largest = std::max(largest, std::abs(s.velocity_m_s));
  }
  EXPECT_LT(largest, 1e-5);
}

}  // namespace
}  // namespace contour
