#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/control/motion_rig.h"

namespace contour {
namespace {

TEST(QuietMonitor, IsThroughReversalsStepsOfForceAndMisreadCounts) {
  for (const double counts_per_mm : {209715.2, 26214.4, 2000.0}) {
    Rig rig(Axis(counts_per_mm));
    for (int i = 0; i < 20000; ++i) {
      rig.external_N = i / 1500 % 2 == 0 ? 0.0 : i < 12000 ? -120.0 : -10.0;
      const bool misread = i % 97 == 0;
      const double off_m = misread ? 7.0 * Axis(counts_per_mm).count_m : 0.0;
      rig.tells = [=](double p) { return p + off_m; };
      const double t = 1e-3 * i;
      const double speed_m_s = 0.05 * std::sin(2.0 * 3.14159 * 0.7 * t) * (i < 12000 ? 1.0 : 1e-3);
      ASSERT_EQ(rig.Step(speed_m_s), Reason::kNone) << "period " << i << ", counts per mm " << counts_per_mm;
    }
  }
}

TEST(QuietMonitor, IsWhileAnOutsideForceGrowsSlowlyOnAStandingAxis) {
  Rig rig;
  rig.RunUp(0.0);
  for (int i = 0; i < 20000; ++i) {
    rig.external_N = 150.0 * i / 20000.0;
    ASSERT_EQ(rig.Step(0.0), Reason::kNone) << "period " << i;
  }
}

TEST(QuietMonitor, IsWithMassesAndFrictionOffByWhatIsAllowed) {
  for (const double factor : {0.75, 1.25, 1.6}) {
    Rig rig;
    rig.mass_factor = factor;
    for (int i = 0; i < 8000; ++i) {
      const double speed_m_s = 0.2 * std::sin(2.0 * 3.14159 * 2.0 * 1e-3 * i);
      ASSERT_EQ(rig.Step(speed_m_s), Reason::kNone) << "period " << i << ", masses times " << factor;
    }
  }
}

/// 20 to 200 kg on soft presliding, an encoder so fine that inertia alone holds the reading for a while, and
/// a torque that is not quite what was asked for.
MonitoredAxis HeavyAxis(std::mt19937& draw) {
  std::uniform_real_distribution<double> u;
  MonitoredAxis a = Axis();
  a.motor_mass_kg = 10.0 + 150.0 * u(draw);
  a.table_mass_kg = 10.0 + 30.0 * u(draw);
  a.stiffness_N_m = 2e8;
  a.Fs_N = 15.0 + 60.0 * u(draw);
  a.Fc_N = 0.8 * a.Fs_N;
  a.sigma0_N_m = a.Fs_N * (3e4 + 5e4 * u(draw));
  a.count_m = 1e-9 * (30.0 + 200.0 * u(draw));
  a.loop_Hz = 30.0;
  return a;
}

TEST(QuietMonitor, AtTheTurningPointsOfAHeavyAxisWithAFineEncoder) {
  std::mt19937 draw(1);
  std::normal_distribution<double> noise;
  for (int machine = 0; machine < 40; ++machine) {
    const MonitoredAxis axis = HeavyAxis(draw);
    Rig rig(axis);
    for (int i = 0; i < 12000; ++i) {
      rig.external_N = 0.1 * axis.Fs_N * noise(draw);
      const double t = 1e-3 * i;
      const double speed_m_s = (0.02 * std::sin(2.0 * std::numbers::pi * 0.7 * t) +
                                0.01 * std::sin(2.0 * std::numbers::pi * 4.0 * t)) *
                               std::sin(2.0 * std::numbers::pi * 0.11 * t);
      ASSERT_EQ(rig.Step(speed_m_s), Reason::kNone) << "machine " << machine << ", period " << i;
    }
  }
}

}  // namespace
}  // namespace contour
