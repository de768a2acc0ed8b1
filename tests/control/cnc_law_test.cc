// What a numerical control adds at a reversal: as much as its numbers say, after the travel they say, and the
// same on an axis of another size.
#include "control/cnc_law.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;

ControlledAxis Axis(double size) {
  ControlledAxis axis;
  axis.mechanics = {5e-3 / 6.283185307179586, 90.0 * size, 10.0 * size, 4e7 * size};
  axis.limits.force_N = 1000.0 * size;
  axis.viscous_Ns_m = 500.0 * size;
  axis.coulomb_plus_N = 44.0 * size;
  axis.coulomb_minus_N = 36.0 * size;
  axis.presliding_m = 8e-6;
  return axis;
}

/// One axis on a reference that the test gives point by point.
struct Loop {
  explicit Loop(const CncConfig& config, double size = 1.0) : law(config, Axes(size), kPeriod_s) {
    input.estimate.resize(1);
    input.reference.resize(1);
    input.friction.resize(1);
    output.force_N.resize(1);
    output.feedforward_N.resize(1);
    output.target_position_m.resize(1);
    output.limit.resize(1);
  }
  static PerAxis<ControlledAxis> Axes(double size) {
    PerAxis<ControlledAxis> axes;
    axes.push_back(Axis(size));
    return axes;
  }
  /// So many cycles at a velocity, m/s; the horizon goes on in the same way.
  void Move(double velocity_m_s, int cycles) {
    for (int i = 0; i < cycles; ++i) {
      position_m += velocity_m_s * kPeriod_s;
      AxisHorizon& horizon = input.reference[0];
      horizon.clear();
      for (int n = 0; n < 5; ++n)
        horizon.push_back({position_m + (n - 2) * velocity_m_s * kPeriod_s, velocity_m_s, acceleration_m_s2});
      law.Step(input, output);
    }
  }
  [[nodiscard]] double offset_um() const { return 1e6 * (output.target_position_m[0] - position_m); }
  [[nodiscard]] double force_N() const { return output.force_N[0]; }

  CncLaw law;
  ControlInput input;
  ControlOutput output;
  double position_m = 0.0;
  double acceleration_m_s2 = 0.0;
};

CncConfig Nothing() {
  CncConfig c;
  c.lost_motion_share = c.friction_share = c.viscous_share = c.pulse_share = c.bend_share = 0.0;
  return c;
}

TEST(CncLaw, LostMotionIsFrictionOverStiffnessInEachDirection) {
  CncConfig c = Nothing();
  c.lost_motion_share = 1.0;
  for (const double size : {1.0, 7.0}) {
    Loop loop(c, size);
    loop.Move(1e-3, 50);
    EXPECT_NEAR(loop.offset_um(), 1e6 * 44.0 / 4e7, 1e-6);
    loop.Move(-1e-3, 8);  // a share of Fc / sigma0 brings it to the middle
    EXPECT_NEAR(loop.offset_um(), 0.0, 1e-3);
    loop.Move(-1e-3, 4);
    EXPECT_NEAR(loop.offset_um(), -0.5 * 1e6 * 36.0 / 4e7, 1e-3);
    loop.Move(-1e-3, 30);
    EXPECT_NEAR(loop.offset_um(), -1e6 * 36.0 / 4e7, 1e-6);
    loop.Move(0.0, 100);  // at rest it stays
    EXPECT_NEAR(loop.offset_um(), -1e6 * 36.0 / 4e7, 1e-6);
    EXPECT_EQ(loop.force_N(), 0.0);
  }
}

TEST(CncLaw, FrictionTurnsRoundOverItsTravel) {
  CncConfig c = Nothing();
  c.friction_share = 0.5;
  c.friction_travel_rel = 2.0;
  Loop loop(c);
  loop.Move(1e-3, 500);
  EXPECT_NEAR(loop.force_N(), 22.0, 1e-6);
  loop.Move(-1e-3, 16);
  // From +1 towards -1: 1 - 2 (1 - 1/e) = -0.264. Reversing, the reference behind the torque moves
  // one period later than the target.
  EXPECT_NEAR(loop.force_N(), 0.5 * 36.0 * (1.0 - 2.0 * (1.0 - std::exp(-1.0))), 1.5);
  loop.Move(-1e-3, 500);
  EXPECT_NEAR(loop.force_N(), -18.0, 1e-6);
}

TEST(CncLaw, ThePulseComesAtReversalsOnlyAndFades) {
  CncConfig c = Nothing();
  c.pulse_share = 0.25;
  c.pulse_ms = 5.0;
  Loop loop(c);
  loop.Move(1e-3, 50);
  EXPECT_EQ(loop.force_N(), 0.0);  // setting out is no reversal
  loop.Move(0.0, 10);
  loop.Move(-1e-3, 2);
  const double first_N = loop.force_N();
  EXPECT_LT(first_N, -0.25 * 36.0 * std::exp(-2.0 / 5.0));
  loop.Move(-1e-3, 5);
  EXPECT_NEAR(loop.force_N(), first_N * std::exp(-1.0), 1e-9);
}

TEST(CncLaw, ViscousFrictionBendAndLimit) {
  CncConfig c = Nothing();
  c.viscous_share = 2.0;
  c.bend_share = 3.0;
  Loop loop(c);
  loop.acceleration_m_s2 = 0.4;
  loop.Move(0.1, 5);
  EXPECT_NEAR(loop.force_N(), 100.0, 1e-9);
  EXPECT_NEAR(loop.offset_um(), 3.0 * 1e6 * 10.0 * 0.4 / 4e7, 1e-6);
  loop.Move(2.0, 5);
  EXPECT_EQ(loop.force_N(), 1000.0);
  EXPECT_EQ(loop.output.limit[0], Reason::kTorqueLimit);
}

TEST(CncLaw, ALeadBringsTheTorqueForward) {
  CncConfig c = Nothing();
  c.viscous_share = 1.0;
  c.lead_ms = 1.5;
  Loop loop(c);
  AxisHorizon& horizon = loop.input.reference[0];
  horizon.clear();
  for (int n = 0; n < 5; ++n) horizon.push_back({0.0, 0.01 * n, 0.0});  // node 1 is t(k)
  loop.law.Step(loop.input, loop.output);
  EXPECT_NEAR(loop.force_N(), 500.0 * 0.025, 1e-9);
}

TEST(CncLaw, SoftenedItHoldsBackItsTorqueAndKeepsItsOffset) {
  Loop loop({});
  loop.Move(1e-3, 50);
  const double whole_N = loop.force_N(), offset_um = loop.offset_um();
  loop.law.Soften(Softness::kSofter);
  loop.Move(1e-3, 1);
  EXPECT_NEAR(loop.force_N(), 0.5 * whole_N, 0.01 * whole_N);
  EXPECT_NEAR(loop.offset_um(), offset_um, 1e-6);
  loop.law.Reset();
  loop.Move(0.0, 1);
  EXPECT_EQ(loop.offset_um(), 0.0);
}

TEST(CncLaw, NeedsAScrew) {
  PerAxis<ControlledAxis> axes = Loop::Axes(1.0);
  axes[0].mechanics.stiffness_N_m = 0.0;
  EXPECT_THROW(CncLaw({}, axes, kPeriod_s), std::invalid_argument);
}

}  // namespace
}  // namespace contour
