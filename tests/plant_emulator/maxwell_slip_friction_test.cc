#include "tools/plant_emulator/maxwell_slip_friction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "tools/plant_emulator/lugre_friction.h"

namespace contour::plant {
namespace {

constexpr double kFc_N = 40.0;

MaxwellSlipParameters Parameters() {
  MaxwellSlipParameters p;
  p.base.plus = {48.0, kFc_N};
  p.base.minus = {48.0, kFc_N};
  p.base.sigma1_Ns_m = 0.0;
  p.base.sigma2_Ns_m = 0.0;
  return p;
}

/// Force along a path of displacement, at 20 um/s: slow enough for the elements to follow the steady curve.
template <class Friction>
std::vector<double> Follow(Friction& friction, const std::vector<double>& turning_points_um) {
  std::vector<double> force;
  const double v = 20e-6;
  const double h = 5e-4;
  double x = 0.0;
  for (const double to_um : turning_points_um) {
    const double to = to_um * 1e-6;
    const double direction = to > x ? 1.0 : -1.0;
    const auto steps = static_cast<int>(std::round(std::fabs(to - x) / (v * h)));
    for (int i = 0; i < steps; ++i) {
      friction.Line(direction * v, h, {});
      friction.Commit(direction * v);
      force.push_back(friction.Elastic_N());
    }
    x = to;
  }
  return force;
}

// Loops inside loops: four amplitudes, each inner one run twice.
const std::vector<double> kNested{40, -40, 40, 20, 35, 20, 35, 25, 30, 25, 30, 20, 40, -40};

TEST(MaxwellSlipFriction, ManyElementsSpreadLogarithmically) {
  const MaxwellSlipFriction friction(Parameters());
  ASSERT_GE(friction.size(), 10U);
  const auto travel = [&](std::size_t i) { return friction.share(i) * 48.0 / friction.stiffness_N_m(i); };
  EXPECT_NEAR(travel(0), 0.5e-6, 1e-12);
  EXPECT_NEAR(travel(friction.size() - 1), 20e-6, 1e-11);
  const double ratio = travel(1) / travel(0);
  double shares = 0.0;
  double stiffness = 0.0;
  for (std::size_t i = 0; i < friction.size(); ++i) {
    if (i > 0) {
      EXPECT_NEAR(travel(i) / travel(i - 1), ratio, 1e-9);
    }
    shares += friction.share(i);
    stiffness += friction.stiffness_N_m(i);
  }
  EXPECT_NEAR(shares, 1.0, 1e-12);
  EXPECT_NEAR(stiffness, 5e6, 1.0);
}

TEST(MaxwellSlipFriction, MinorLoopsCloseAndAreForgotten) {
  MaxwellSlipFriction with(Parameters());
  MaxwellSlipFriction without(Parameters());
  // Up to 15 um, back to 5 (minor loop), again to 15, on to 30; against straight to 30.
  const auto looped = Follow(with, {40, -40, 15, 5, 15, 30});
  const auto straight = Follow(without, {40, -40, 15, 30});
  EXPECT_NEAR(looped.back(), straight.back(), 0.01 * kFc_N);
  // The loop itself is a loop: at its lower end the force is well below.
  MaxwellSlipFriction a(Parameters());
  MaxwellSlipFriction b(Parameters());
  const double top_before = Follow(a, {40, -40, 15}).back();
  const double top_after = Follow(b, {40, -40, 15, 5, 15}).back();
  EXPECT_NEAR(top_after, top_before, 0.01 * kFc_N);
}

TEST(MaxwellSlipFriction, LugreLoopsDoNotClose) {
  FrictionParameters p = Parameters().base;
  LugreFriction with(p);
  LugreFriction without(p);
  const double looped = Follow(with, {40, -40, 15, 5, 15}).back();
  const double straight = Follow(without, {40, -40, 15}).back();
  EXPECT_GT(std::fabs(looped - straight), 0.02 * kFc_N);
}

/// Largest difference between a LuGre law and recorded forces.
double WorstDifference(const FrictionParameters& p, const std::vector<double>& wanted) {
  LugreFriction friction(p);
  const auto force = Follow(friction, kNested);
  double worst = 0.0;
  for (std::size_t i = 0; i < wanted.size(); ++i) worst = std::max(worst, std::fabs(force[i] - wanted[i]));
  return worst;
}

TEST(MaxwellSlipFriction, LugreCannotFitItsNestedLoops) {
  MaxwellSlipFriction truth(Parameters());
  const auto wanted = Follow(truth, kNested);
  // Levels of both directions and stiffness free; the speed is constant, so that Stribeck's shape makes no
  // difference.
  FrictionParameters best = Parameters().base;
  double worst = 1e9;
  for (double sigma0 = 1e6; sigma0 < 4e7; sigma0 *= 1.15) {
    for (double plus = 0.7; plus < 1.31; plus += 0.05) {
      FrictionParameters p = best;
      p.sigma0_N_m = sigma0;
      p.plus = p.minus = {48.0 * plus, 48.0 * plus};
      const double now = WorstDifference(p, wanted);
      if (now < worst) {
        worst = now;
        best = p;
      }
    }
  }
  // Refine by coordinates, directions apart.
  for (double step = 0.04; step > 1e-4; step *= 0.5) {
    for (bool better = true; better;) {
      better = false;
      for (int which = 0; which < 3; ++which) {
        for (const double factor : {1.0 + step, 1.0 - step}) {
          FrictionParameters p = best;
          if (which == 0) p.sigma0_N_m *= factor;
          if (which == 1) p.plus = {p.plus.Fs_N * factor, p.plus.Fc_N * factor};
          if (which == 2) p.minus = {p.minus.Fs_N * factor, p.minus.Fc_N * factor};
          const double now = WorstDifference(p, wanted);
          if (now >= worst * (1.0 - 1e-6)) continue;
          worst = now;
          best = p;
          better = true;
        }
      }
    }
  }
  RecordProperty("worst_difference_N", std::to_string(worst));
  EXPECT_GT(worst, 0.05 * kFc_N) << "sigma0 " << best.sigma0_N_m << " levels " << best.plus.Fc_N;
}

TEST(MaxwellSlipFriction, FrictionLagsBehindVelocity) {
  MaxwellSlipFriction friction(Parameters());
  const double h = 1e-5;
  double rising = 0.0;
  double falling = 0.0;
  double before = 0.0;
  for (int i = 0; i < 200000; ++i) {
    const double v = 4e-3 - 3e-3 * std::cos(30.0 * h * i);
    friction.Line(v, h, {});
    friction.Commit(v);
    if (before < 4e-3 && v >= 4e-3) rising = friction.Elastic_N();
    if (before >= 4e-3 && v < 4e-3) falling = friction.Elastic_N();
    before = v;
  }
  EXPECT_GT(rising, falling + 0.05);
}

TEST(MaxwellSlipFriction, SteadySlidingGivesTheStribeckCurve) {
  for (const double v : {1e-4, 2e-3, 5e-2, -2e-3}) {
    MaxwellSlipFriction friction(Parameters());
    for (int i = 0; i < 20000; ++i) {
      friction.Line(v, 6e-5, {});
      friction.Commit(v);
    }
    const double level = kFc_N + 8.0 * std::exp(-std::fabs(v) / 2e-3);
    EXPECT_NEAR(friction.Elastic_N(), v > 0 ? level : -level, 0.02) << v;
  }
}

TEST(MaxwellSlipFriction, RefusesAStiffnessItsTravelsCannotGive) {
  MaxwellSlipParameters p = Parameters();
  p.base.sigma0_N_m = 1e9;
  EXPECT_THROW(MaxwellSlipFriction{p}, std::invalid_argument);
}

}  // namespace
}  // namespace contour::plant
