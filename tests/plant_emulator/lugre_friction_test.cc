// The emulated machine's LuGre friction against the behaviour published for it: Canudas de Wit, Olsson,
// Astrom, Lischinsky, "A new model for control of systems with friction", IEEE TAC 40(3), 1995, with that
// paper's parameters.
#include "tools/plant_emulator/lugre_friction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "tools/plant_emulator/random.h"

namespace contour::plant {
namespace {

constexpr double kSigma0_N_m = 1e5;

FrictionParameters Published() {
  FrictionParameters p;
  p.plus = {1.5, 1.0};
  p.minus = {1.5, 1.0};
  p.vs_m_s = 1e-3;
  p.stribeck_exponent = 2;
  p.sigma0_N_m = kSigma0_N_m;
  p.sigma1_Ns_m = std::sqrt(1e5);
  p.sigma1_decay_m_s = 1e3;  // the paper's damping is constant
  p.sigma2_Ns_m = 0.4;
  return p;
}

/// A block of 1 kg on a surface with this friction, under a force; implicit midpoint, as the plant steps it.
struct Block {
  explicit Block(const FrictionParameters& p, double mass = 1.0) : friction(p), mass_kg(mass) {}

  void Step(double force_N, double step_s) {
    double expected = v_m_s + 0.5 * step_s * a_m_s2;
    double mid = 0.0;
    for (int pass = 0; pass < 2; ++pass) {
      const FrictionLine line = friction.Line(expected, step_s, {});
      mid = (2.0 * mass_kg / step_s * v_m_s + force_N - line.constant_N) /
            (2.0 * mass_kg / step_s + line.slope_Ns_m);
      if ((mid < 0.0) == (expected < 0.0)) break;
      expected = mid;
    }
    friction.Commit(mid);
    a_m_s2 = 2.0 * (mid - v_m_s) / step_s;
    x_m += step_s * mid;
    v_m_s += step_s * a_m_s2;
  }

  LugreFriction friction;
  double mass_kg;
  double x_m = 0.0;
  double v_m_s = 0.0;
  double a_m_s2 = 0.0;
};

TEST(LugreFriction, PreslidingDisplacementShowsHysteresis) {
  // Force to 95 % of break-away, to its negative, and back, slowly (paper's fig. 2).
  Block block(Published());
  const double peak_N = 1.425;
  double top_m = 0.0;
  double at_zero_down_m = 0.0;
  double at_zero_up_m = 0.0;
  const double h = 1e-4;
  double force = 0.0;
  for (const double target : {peak_N, -peak_N, peak_N}) {
    const double direction = target > force ? 1.0 : -1.0;
    while (direction * (target - force) > 0.0) {
      const double before = force;
      force += direction * 0.1 * h;
      block.Step(force, h);
      if (before > 0.0 && force <= 0.0) at_zero_down_m = block.x_m;
      if (before < 0.0 && force >= 0.0) at_zero_up_m = block.x_m;
    }
    if (target == peak_N && top_m == 0.0) top_m = block.x_m;
  }
  // Presliding: far more than elastic (14 um), far less than sliding.
  EXPECT_GT(top_m, 1.05 * peak_N / kSigma0_N_m);
  EXPECT_LT(top_m, 100e-6);
  // Without force the block stays where it was pushed; which side depends on where it came from.
  EXPECT_GT(at_zero_down_m - at_zero_up_m, 5e-6);
}

TEST(LugreFriction, SmallForcesMoveItLikeASpring) {
  Block block(Published());
  for (int i = 0; i < 100000; ++i) block.Step(0.1 * i / 100000.0, 1e-4);
  EXPECT_NEAR(block.x_m, 0.1 / kSigma0_N_m, 0.06 * 0.1 / kSigma0_N_m);
}

/// Friction at 1.5 mm/s with rising and with falling velocity, the velocity swinging between 0.5 and 2.5
/// mm/s.
struct Lag {
  double rising_N = 0.0;
  double falling_N = 0.0;
};
Lag LagAt(double omega_rad_s) {
  LugreFriction friction(Published());
  const double h = 1e-4 / omega_rad_s;
  Lag lag;
  double before = 0.0;
  const int periods = 3;
  const auto steps = static_cast<int>(periods * 6.283185307 / (omega_rad_s * h));
  for (int i = 0; i < steps; ++i) {
    const double v = 1.5e-3 - 1.0e-3 * std::cos(omega_rad_s * h * (i + 0.5));
    friction.Line(v, h, {});
    friction.Commit(v);
    if (i > steps / 2) {
      if (before < 1.5e-3 && v >= 1.5e-3) lag.rising_N = friction.Force_N(v, {});
      if (before >= 1.5e-3 && v < 1.5e-3) lag.falling_N = friction.Force_N(v, {});
    }
    before = v;
  }
  return lag;
}

TEST(LugreFriction, FrictionLagsBehindVelocityAndTheLoopWidensWithFrequency) {
  const Lag slow = LagAt(1.0);
  const Lag medium = LagAt(10.0);
  const Lag fast = LagAt(25.0);
  EXPECT_GT(slow.rising_N, slow.falling_N);
  EXPECT_GT(medium.rising_N - medium.falling_N, 1.5 * (slow.rising_N - slow.falling_N));
  EXPECT_GT(fast.rising_N - fast.falling_N, 1.5 * (medium.rising_N - medium.falling_N));
}

double BreakAway_N(double rate_N_s) {
  // The paper's fig. 4: the friction when the block breaks away, taken as the largest friction on the way.
  Block block(Published());
  double largest = 0.0;
  const double h = 1e-5;
  for (double force = 0.0; force < 4.0 && block.v_m_s < 0.02; force += rate_N_s * h) {
    block.Step(force, h);
    largest = std::max(largest, block.friction.Force_N(block.v_m_s, {}));
  }
  return largest;
}

TEST(LugreFriction, BreakAwayForceFallsAsTheForceRisesFaster) {
  double before = 1.5 + 1e-3;
  for (const double rate : {0.1, 1.0, 5.0, 20.0, 50.0}) {
    const double force = BreakAway_N(rate);
    EXPECT_LT(force, before) << rate;
    EXPECT_GT(force, 1.0) << rate;
    before = force;
  }
  EXPECT_LT(before, 1.2);
}

TEST(LugreFriction, StickSlipWhenPulledThroughASoftSpring) {
  // 1 kg, 2 N/m, 0.1 m/s (the paper's fig. 6): the spring loads to break-away, the block jumps, again and
  // again.
  Block block(Published());
  const double h = 1e-4;
  int jumps = 0;
  bool sticking = true;
  double stuck_s = 0.0;
  double highest_N = 0.0;
  for (int i = 0; i < 400000; ++i) {
    const double spring = 2.0 * (0.1 * i * h - block.x_m);
    block.Step(spring, h);
    highest_N = std::max(highest_N, spring);
    if (std::fabs(block.v_m_s) < 1e-4) {
      stuck_s += h;
      if (!sticking && stuck_s > 0.5) sticking = true;
    } else {
      if (block.v_m_s > 0.05 && sticking) {
        ++jumps;
        sticking = false;
      }
      stuck_s = 0.0;
    }
  }
  EXPECT_GE(jumps, 3);
  EXPECT_NEAR(highest_N, 1.5, 0.05);
}

TEST(LugreFriction, PidPositionControlHunts) {
  // 1 kg, PID with Kp 3, Kv 6, Ki 4 towards x = 1 (the paper's section on servo control): a limit cycle about
  // the goal.
  Block block(Published());
  const double h = 1e-4;
  double integral = 0.0;
  std::vector<double> crossings;
  double late_low = 2.0;
  double late_high = 0.0;
  for (int i = 0; i < 2000000; ++i) {
    const double error = 1.0 - block.x_m;
    integral += error * h;
    block.Step(3.0 * error + 4.0 * integral - 6.0 * block.v_m_s, h);
    const double t = i * h;
    if (t < 100.0) continue;
    late_low = std::min(late_low, block.x_m);
    late_high = std::max(late_high, block.x_m);
    const double after = 1.0 - block.x_m;
    if ((error < 0.0) != (after < 0.0)) crossings.push_back(t);
  }
  EXPECT_GE(crossings.size(), 3U);
  EXPECT_GT(late_high - late_low, 1e-3);
  EXPECT_LT(late_high - late_low, 0.5);
}

double LargestLevel(const FrictionParameters& p) {
  return std::max({p.plus.Fs_N, p.plus.Fc_N, p.minus.Fs_N, p.minus.Fc_N});
}

/// A velocity that wanders over four decades and both signs.
class Wander {
 public:
  explicit Wander(std::uint64_t seed) : random_(seed, 0) {}
  double Next() {
    phase_ += 0.02 * random_.Normal();
    size_ += 0.05 * random_.Normal();
    size_ = std::clamp(size_, -6.0, -1.0);
    return std::pow(10.0, size_) * std::sin(20.0 * phase_);
  }

 private:
  Random random_;
  double phase_ = 0.0;
  double size_ = -3.0;
};

FrictionParameters Machine(double sigma0_N_m) {
  FrictionParameters p;
  p.plus = {52.0, 42.0};
  p.minus = {47.0, 36.0};
  p.sigma0_N_m = sigma0_N_m;
  return p;
}

TEST(LugreFriction, DeflectionStaysBelowTheLargestLevelOverStiffness) {
  for (const double sigma0 : {1e6, 5e6, 3e7}) {
    const FrictionParameters p = Machine(sigma0);
    LugreFriction friction(p);
    Wander wander(7);
    const double bound = LargestLevel(p) / sigma0 * (1.0 + 1e-9);
    for (int i = 0; i < 200000; ++i) {
      const double v = wander.Next();
      friction.Line(v, 6e-5, {});
      friction.Commit(v);
      ASSERT_LE(std::fabs(friction.bristle_m()), bound) << i;
    }
  }
}

TEST(LugreFriction, VelocityToDeflectionIsPassive) {
  // With V = z^2 / 2: V grows by no more than the integral of z v, over every step.
  const FrictionParameters p = Machine(5e6);
  LugreFriction friction(p);
  Wander wander(11);
  for (int i = 0; i < 200000; ++i) {
    const double v = wander.Next();
    const double h = 1e-5;
    const double before = friction.bristle_m();
    friction.Line(v, h, {});
    friction.Commit(v);
    const double after = friction.bristle_m();
    // The integral of z over the step: exact for z' = v - a z, by the trapezoid where a h is tiny.
    const double a = p.sigma0_N_m * std::fabs(v) / SteadyLevel_N(p, {}, v);
    const double mean_z = a * h > 1e-3 ? (v - (after - before) / h) / a : 0.5 * (before + after);
    const double supplied = mean_z * v * h;
    ASSERT_LE(0.5 * (after * after - before * before), supplied + 1e-6 * std::fabs(supplied)) << i;
  }
}

TEST(LugreFriction, VelocityToForceIsPassiveWhereDampingFades) {
  // Storage sigma0 z^2 / 2; sigma1(v) |v| <= 4 g(v) holds for all v with the machine's fading damping.
  const FrictionParameters p = Machine(5e6);
  LugreFriction friction(p);
  Wander wander(13);
  double stored_before = 0.0;
  for (int i = 0; i < 200000; ++i) {
    const double v = wander.Next();
    ASSERT_LE(PreslidingDamping_Ns_m(p, v) * std::fabs(v), 4.0 * SteadyLevel_N(p, {}, v));
    const double h = 1e-5;
    const FrictionLine line = friction.Line(v, h, {});
    friction.Commit(v);
    const double work = (line.constant_N + line.slope_Ns_m * v - p.sigma2_Ns_m * v) * v * h;
    const double stored = 0.5 * p.sigma0_N_m * friction.bristle_m() * friction.bristle_m();
    ASSERT_LE(stored - stored_before, work + 1e-12) << i;
    stored_before = stored;
  }
}

TEST(LugreFriction, SteadySlidingGivesTheStribeckCurveInEachDirection) {
  const FrictionParameters p = Machine(5e6);
  for (const double v : {1e-5, 5e-4, 2e-3, 2e-2, -1e-5, -5e-4, -2e-3, -2e-2}) {
    LugreFriction friction(p);
    for (int i = 0; i < 2000000 && i * 6e-5 < 30e-6 / std::fabs(v) * 10.0; ++i) {
      friction.Line(v, 6e-5, {});
      friction.Commit(v);
    }
    const double level = v > 0 ? 42.0 + 10.0 * std::exp(-v / 2e-3) : -(36.0 + 11.0 * std::exp(v / 2e-3));
    EXPECT_NEAR(friction.Force_N(v, {}), level + 500.0 * v, 0.02) << v;
  }
}

TEST(LugreFriction, ScaleActsOnTheLevels) {
  LugreFriction friction(Machine(5e6));
  const FrictionScale half{0.5, 0.25, 2.0};
  for (int i = 0; i < 20000; ++i) {
    friction.Line(0.02, 6e-5, half);
    friction.Commit(0.02);
  }
  EXPECT_NEAR(friction.Force_N(0.02, half), 0.5 * (42.0 + 10.0 * std::exp(-10.0)) + 2.0 * 500.0 * 0.02, 1e-6);
}

TEST(LugreFriction, WithoutFrictionThereIsNoForce) {
  FrictionParameters p = Machine(5e6);
  p.plus = p.minus = {0.0, 0.0};
  p.sigma1_Ns_m = 0.0;
  p.sigma2_Ns_m = 0.0;
  Block block(p, 10.0);
  for (int i = 0; i < 10000; ++i) block.Step(1.0, 1e-4);
  EXPECT_NEAR(block.v_m_s, 0.1, 1e-6);
}

}  // namespace
}  // namespace contour::plant
