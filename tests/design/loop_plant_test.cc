#include "design/loop_plant.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/design/family_axes.h"

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;
constexpr LoopTuning kTuning{.regulator_Hz = 9.0,
                             .windup_weight = 0.2,
                             .velocity_weight = 0.35,
                             .disturbance_Hz = 150.0,
                             .motor_force_Hz = 400.0,
                             .table_force_Hz = 60.0,
                             .notch_ratio = 0.7,
                             .notch_pole_damping = 0.7,
                             .notch_zero_damping = 0.2};

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
