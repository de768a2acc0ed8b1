#include "analysis/rough_fit/two_starts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace contour::diagnosis {
namespace {

constexpr double kInertia = 3e-4, kLevel = 0.08, kViscous = 3e-4;

/// 20 s to and fro at several speeds, with a ripple of half the level that no model has.
AxisLog Rippled() {
  AxisLog log;
  log.period_s = 1e-3;
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 5e-3);
  double q = 0.0, w = 0.0;
  for (int k = 0; k < 20000; ++k) {
    const double t = 1e-3 * k;
    const double aim = (20.0 + 15.0 * std::sin(0.5 * t)) * std::tanh(3.0 * std::sin(2.0 * t));
    const double u = kLevel * std::tanh(aim) + kViscous * w + kInertia * 30.0 * (aim - w);
    log.position.push_back(1e-4 * std::round(q / 1e-4));
    log.command.push_back(u);
    const double torque = u + noise(random);
    for (int i = 0; i < 20; ++i) {
      const double ripple = 0.5 * kLevel * std::sin(8.0 * q);
      w += 5e-5 * (torque - kLevel * std::tanh(w / 0.02) - kViscous * w + ripple) / kInertia;
      q += 5e-5 * w;
    }
  }
  log.rows = log.position.size();
  log.present.assign(log.rows, 1);
  return log;
}

StatedAxis Stated(double level) {
  StatedAxis stated;
  stated.motor_inertia = 2.8e-4;
  StatedFriction& f = stated.friction;
  f.Fc_plus = f.Fc_minus = f.Fs_plus = f.Fs_minus = level;
  f.vs = 1.0;
  f.s0 = 400.0;
  f.s2 = 2e-4;
  stated.position_step = 1e-4;
  stated.endless = true;
  for (const char* name : {"inertia", "Fc", "s0", "s2"}) stated.sigma[name] = 1.0;
  return stated;
}

// A ripple that the model lacks may keep a fit where it began: the interval holds the truth all the same.
TEST(TwoStarts, TheLevelIsInsideItsIntervalFromEitherSide) {
  const AxisLog log = Rippled();
  for (const double factor : {0.8, 1.25}) {
    const StatedAxis stated = Stated(factor * kLevel);
    Problem problem(log, stated, 1);
    const TwoStarts found = FitFromTwoStarts(problem, FitRoughly(log, stated));
    for (std::size_t i = 0; i < problem.terms.size(); ++i) {
      if (std::string(problem.terms[i].name) != "Fc") continue;
      const double sigma = std::max(found.sigma[i], found.apart[i]);
      EXPECT_NEAR(found.fit.point.base[i], -std::log(factor), 3.0 * sigma) << factor;
      EXPECT_NEAR(found.fit.point.base[i], -std::log(factor), 0.1) << factor;
    }
  }
}

}  // namespace
}  // namespace contour::diagnosis
