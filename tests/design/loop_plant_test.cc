#include "design/loop_plant.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/design/family_axes.h"

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;

TEST(MakePlant, IsTheModelOfTheLoopWhereNothingHoldsTheTable) {
  for (const double dead_time_s : {0.0, 60e-6}) {
    LoopAxis axis = AxisOf("soft");
    axis.axis.dead_time_s = dead_time_s;
    const TwoInertiaLoop loop = LoopMotionOf(axis.axis, kPeriod_s);
    const LinearSystem s = MakePlant(SlidingMember(axis), kPeriod_s, 1.0).system;
    ASSERT_EQ(s.a.rows(), 6 + static_cast<Eigen::Index>(loop.queued));
    // Velocities are per period here.
    const double unit[] = {1.0, 1.0 / kPeriod_s, 1.0, 1.0 / kPeriod_s, 1.0};
    for (std::size_t i = 0; i < kLoopMotion; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      for (std::size_t j = 0; j < kLoopMotion; ++j)
        EXPECT_NEAR(s.a(row, static_cast<Eigen::Index>(j)) * unit[i] / unit[j], loop.motion_from_motion[i][j],
                    1e-9 * (1e-6 + std::abs(loop.motion_from_motion[i][j])));
      EXPECT_NEAR(s.a(row, 6) * unit[i], loop.motion_from_input[0][i],
                  1e-15 + 1e-9 * std::abs(loop.motion_from_input[0][i]));
      EXPECT_NEAR(s.b(row, 1) * unit[i], loop.motion_from_disturbance[i], 1e-15);
    }
  }
}

TEST(MakePlant, HeldTableGivesWayByScrewAndBristle) {
  const LoopAxis axis = AxisOf("base");
  const LinearSystem s = MakePlant(RestingMember(axis), kPeriod_s, 1.0).system;
  const auto response = Response(s, 0, {1e-5});
  const double sigma0 = axis.friction.sigma0_N_m;
  EXPECT_NEAR(response[0][1].real(), 1.0 / sigma0, 1e-3 / sigma0);
  EXPECT_NEAR(response[0][0].real(), 1.0 / sigma0 + 1.0 / axis.axis.stiffness_N_m, 1e-3 / sigma0);
}

TEST(MakePlant, FrictionBeforeTheScrewHoldsTheMotor) {
  LoopAxis axis = AxisOf("base");
  axis.friction.motor_share = 0.3;
  const LinearSystem s = MakePlant(RestingMember(axis), kPeriod_s, 1.0).system;
  const auto response = Response(s, 0, {1e-5});
  const double motors = 0.3 * axis.friction.sigma0_N_m, tables = 0.7 * axis.friction.sigma0_N_m;
  const double behind = 1.0 / (1.0 / tables + 1.0 / axis.axis.stiffness_N_m);
  EXPECT_NEAR(response[0][0].real(), 1.0 / (motors + behind), 1e-3 / motors);
}

/// Motor, table and parts that swing, in steps of a thousandth of a period: the motor's force is the command.
struct Swinging {
  const LoopMember& m;
  double p1 = 0, v1 = 0, p2 = 0, v2 = 0, u = 0;
  std::vector<double> p = std::vector<double>(m.side_modes.size()), v = p;

  void Step(double command_N, double step_s) {
    const TwoInertiaAxis& a = m.axis;
    u += (command_N - u) * step_s / a.lag_s;
    const double screw = a.stiffness_N_m * (p1 - p2) + a.damping_Ns_m * (v1 - v2);
    double table_kg = a.table_mass_kg, on_table = screw - a.viscous_Ns_m * v2;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const SideMode& s = m.side_modes[i];
      const double kg = s.mass_share_rel * a.table_mass_kg, w = 2 * std::numbers::pi * s.frequency_Hz;
      const double spring = kg * (w * w * (p[i] - p2) + 2 * s.damping_ratio * w * (v[i] - v2));
      v[i] -= spring / kg * step_s;
      on_table += spring;
      table_kg -= kg;
    }
    v1 += (u - screw) / a.motor_mass_kg * step_s;
    v2 += on_table / table_kg * step_s;
    p1 += v1 * step_s;
    p2 += v2 * step_s;
    for (std::size_t i = 0; i < p.size(); ++i) p[i] += v[i] * step_s;
  }
};

TEST(MakePlant, PartsOfTheTableSwing) {
  LoopAxis axis = AxisOf("t30");
  axis.side_modes = {{175.0, 0.12, 0.02, 0.0}, {90.0, 0.05, 0.05, 0.0}};
  const LoopMember member = SlidingMember(axis);
  const LoopPlant plant = MakePlant(member, kPeriod_s, 1.0);
  LoopMatrix x = LoopMatrix::Zero(plant.system.a.rows(), 1);
  Swinging truth{member};
  constexpr int kSteps = 2000;
  double largest = 0.0, before = 0.0, now = 0.0;
  for (int k = 0; k < 60; ++k) {
    const double command = k % 9 < 4 ? 30.0 : -20.0;
    // One period of delay: the plant's queue holds it, the truth gets it a period later.
    for (int i = 0; i < kSteps; ++i) truth.Step(before, kPeriod_s / kSteps);
    before = command;
    LoopMatrix u = LoopMatrix::Zero(2, 1);
    u(0, 0) = command;
    x = (plant.system.a * x + plant.system.b * u).eval();
    now = (plant.system.c * x)(1, 0);
    largest = std::max(largest, std::abs(truth.p2));
    EXPECT_NEAR(now, truth.p2, 2e-3 * largest + 1e-9) << k;
  }
  // They matter: the table alone goes elsewhere.
  LoopAxis plain = axis;
  plain.side_modes.clear();
  EXPECT_NE(plant.system.a.rows(), MakePlant(SlidingMember(plain), kPeriod_s, 1.0).system.a.rows());
}

TEST(UncertaintySet, TriesSideModesOffAndTheShareEitherWay) {
  LoopAxis axis = AxisOf("t30");
  const std::size_t plain = UncertaintySet(axis).size();
  axis.side_modes = {{175.0, 0.12, 0.02}};
  EXPECT_EQ(UncertaintySet(axis).size(), plain + 2);
  axis.friction.motor_share = 0.2;
  axis.motor_share_std = 0.1;
  EXPECT_EQ(UncertaintySet(axis).size(), plain + 4);
}

TEST(Response, HasTheModeOfTheScrew) {
  const LoopAxis axis = AxisOf("t30");
  const LinearSystem s = MakePlant(SlidingMember(axis), kPeriod_s, 1.0).system;
  const double mode = ModeFrequency_Hz(axis.axis) * kPeriod_s;
  const auto r = Response(s, 0, {0.95 * mode, mode, 1.05 * mode});
  EXPECT_GT(std::abs(r[1][1]), 1.5 * std::abs(r[0][1]));
  EXPECT_GT(std::abs(r[1][1]), 1.5 * std::abs(r[2][1]));
}

TEST(ResponseToBoth, IsThatOfTheResolvent) {
  const LoopAxis axis = AxisOf("soft", true);
  const LinearSystem s = MakeController(DesignLoop(axis.axis, kTuning, kPeriod_s, true), 139e6);
  const std::vector<double> f{1e-3, 0.03, 0.11, 0.3, 0.49};
  const auto found = ResponseToBoth(s, f);
  for (std::size_t i = 0; i < f.size(); ++i) {
    Eigen::MatrixXcd shifted = -s.a.cast<Complex>();
    shifted.diagonal().array() += std::polar(1.0, 2.0 * std::numbers::pi * f[i]);
    const Eigen::MatrixXcd y =
        s.c.cast<Complex>() * shifted.fullPivLu().solve(s.b.cast<Complex>().eval()) + s.d;
    for (std::size_t j = 0; j < 2; ++j)
      EXPECT_NEAR(std::abs(found[i][j] - y(0, static_cast<Eigen::Index>(j))), 0.0, 1e-8 * std::abs(y(0, 0)));
  }
}

}  // namespace
}  // namespace contour
