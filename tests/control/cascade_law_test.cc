#include "control/cascade_law.h"

#include <gtest/gtest.h>

#include <cmath>

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;
constexpr double kRadius_m = 10e-3;
constexpr double kOmega_1_s = 20.0;

/// One axis of a circle, from its middle.
ReferencePoint OnCircle(double time_s) {
  const double angle = kOmega_1_s * time_s;
  return {kRadius_m * std::sin(angle), kRadius_m * kOmega_1_s * std::cos(angle),
          -kRadius_m * kOmega_1_s * kOmega_1_s * std::sin(angle)};
}

ControlledAxis Stiff() {
  ControlledAxis axis;
  axis.mechanics = {5e-3 / 6.283185307179586, 80.0, 10.0, 4e7};
  axis.limits.force_N = 1000.0;
  return axis;
}

PerAxis<ControlledAxis> OneAxis(double acceleration_share = 0.0) {
  PerAxis<ControlledAxis> axes;
  axes.push_back(Stiff());
  axes[0].acceleration_share = acceleration_share;
  return axes;
}

/// A drive that gives out targets by a uniform quadratic B-spline and is late and short besides, by what it
/// is told.
struct Drive {
  double late_s;
  double short_s2;
  std::array<double, 3> target_m{};  // newest first

  void Take(double target_m_) { target_m = {target_m_, target_m[0], target_m[1]}; }
  /// At the SYNC that brought the newest target.
  [[nodiscard]] double Position(double time_s) const {
    const ReferencePoint then = OnCircle(time_s - 0.5 * kPeriod_s);
    return 0.5 * (target_m[1] + target_m[2]) - late_s * then.velocity_m_s +
           0.5 * late_s * late_s * then.acceleration_m_s2 + short_s2 * then.acceleration_m_s2;
  }
};

struct Loop {
  explicit Loop(Drive d, double acceleration_share = 0.0)
      : axes(OneAxis(acceleration_share)), law(axes, kPeriod_s), drive(d) {
    input.estimate.resize(1);
    input.reference.resize(1);
    input.friction.resize(1);
    output.force_N.resize(1);
    output.feedforward_N.resize(1);
    output.target_position_m.resize(1);
    output.limit.resize(1);
    for (int n = 0; n < 3; ++n)
      drive.target_m[static_cast<std::size_t>(n)] = OnCircle(-n * kPeriod_s).position_m;
    measured_m = drive.Position(-kPeriod_s);
  }
  /// Step k: feedback of t(k-1), command for SYNC k.
  void Step() {
    const double time_s = k * kPeriod_s;
    AxisHorizon& horizon = input.reference[0];
    horizon.clear();
    for (int n = 0; n < 5; ++n) horizon.push_back(OnCircle(time_s + (n - 1) * kPeriod_s));
    input.estimate[0].position_m = measured_m;
    if (forgets) law.Reset();
    law.Step(input, output);
    drive.Take(output.target_position_m[0]);
    measured_m = drive.Position(time_s);
    ++k;
  }
  /// A turn, and how far inside the circle the drive was about its turning points. That it is late is left
  /// out.
  double Turn_m() {
    const ControlledAxis axis = Stiff();
    const int cycles = static_cast<int>(std::lround(2.0 * 3.141592653589793 / kOmega_1_s / kPeriod_s));
    double sum_m = 0.0;
    int count = 0;
    for (int i = 0; i < cycles; ++i) {
      Step();
      const ReferencePoint there = OnCircle((k - 1.5) * kPeriod_s - drive.late_s);
      if (std::abs(there.position_m) < 0.98 * kRadius_m) continue;
      const double windup_m =
          axis.mechanics.table_mass_kg * there.acceleration_m_s2 / axis.mechanics.stiffness_N_m;
      const double inside_m = there.position_m + windup_m - measured_m;
      sum_m += there.position_m > 0.0 ? inside_m : -inside_m;
      ++count;
    }
    return sum_m / count;
  }

  PerAxis<ControlledAxis> axes;
  CascadeLaw law;
  ControlInput input;
  ControlOutput output;
  Drive drive;
  double measured_m = 0.0;
  bool forgets = false;
  int k = 0;
};

TEST(CascadeLaw, BendsAreNotCutShort) {
  // Of 4 m/s^2: 0.5 um by interpolation, 0.8 um by the drive's loops.
  Loop loop({0.0, 0.2e-6});
  for (int i = 0; i < 4; ++i) loop.Turn_m();
  EXPECT_NEAR(loop.Turn_m(), 0.0, 0.05e-6);
  Loop unlearning({0.0, 0.2e-6});
  unlearning.forgets = true;
  EXPECT_NEAR(unlearning.Turn_m(), 1.3e-6, 0.05e-6);
}

TEST(CascadeLaw, ADelayIsNotTakenForABend) {
  Loop loop({0.4e-3, 0.2e-6});
  for (int i = 0; i < 4; ++i) loop.Turn_m();
  EXPECT_NEAR(loop.Turn_m(), 0.0, 0.08e-6);
}

TEST(CascadeLaw, FrictionGoesIntoTheOffsetAndItsWindUpIntoTheTarget) {
  Loop with({0.0, 0.0}), without({0.0, 0.0});
  for (int n = 0; n < 4; ++n) with.input.friction[0].push_back({40.0, 40.0, 0.0});
  with.Step();
  without.Step();
  EXPECT_NEAR(with.output.force_N[0] - without.output.force_N[0], 40.0, 1e-9);
  EXPECT_NEAR(with.output.target_position_m[0] - without.output.target_position_m[0], 40.0 / 4e7, 1e-15);
  // The drive feeds the mass's acceleration forward itself: without friction the offset is that of the
  // wind-up alone.
  EXPECT_LT(std::abs(without.output.force_N[0]), 0.1);
}

/// Two axes that stand until they are moved; the friction that is foreseen may change at rest.
struct Standing {
  Standing() : axes(TwoAxes()), law(axes, kPeriod_s) {
    input.estimate.resize(2);
    input.reference.resize(2);
    input.friction.resize(2);
    output.force_N.resize(2);
    output.feedforward_N.resize(2);
    output.target_position_m.resize(2);
    output.limit.resize(2);
  }
  static PerAxis<ControlledAxis> TwoAxes() {
    PerAxis<ControlledAxis> both;
    both.push_back(Stiff());
    both.push_back(Stiff());
    return both;
  }
  /// The offset of the first axis under `friction_N`, the second one moving at `other_m_s`.
  double Offset_N(double friction_N, double own_m_s = 0.0, double other_m_s = 0.0) {
    for (std::size_t i = 0; i < 2; ++i) {
      input.reference[i].clear();
      input.friction[i].clear();
      for (int n = 0; n < 4; ++n) {
        input.reference[i].push_back({0.0, i == 0 ? own_m_s : other_m_s, 0.0});
        input.friction[i].push_back({friction_N, friction_N, 0.0});
      }
    }
    law.Step(input, output);
    return output.force_N[0];
  }

  PerAxis<ControlledAxis> axes;
  CascadeLaw law;
  ControlInput input;
  ControlOutput output;
};

// What the drive's integral has made up for it would have to make up for anew, with the gains of an axis at
// rest in seconds: every change moves the axis.
TEST(CascadeLaw, WhileNothingMovesTheOffsetStays) {
  Standing axis;
  EXPECT_NEAR(axis.Offset_N(40.0, 0.01), 40.0, 1e-9);
  EXPECT_NEAR(axis.Offset_N(38.0), 38.0, 1e-9);
  for (int i = 0; i < 1000; ++i) EXPECT_NEAR(axis.Offset_N(38.0 - 0.03 * i), 38.0, 1e-9);
  // The target follows: it is where the table is to be.
  EXPECT_NEAR(axis.output.target_position_m[0], (38.0 - 0.03 * 999) / 4e7, 1e-12);
}

TEST(CascadeLaw, AnAxisThatWaitsForAnotherIsGivenWhatIsForeseen) {
  Standing axis;
  axis.Offset_N(38.0, 0.01);
  for (int i = 0; i < 100; ++i) EXPECT_NEAR(axis.Offset_N(38.0 - 0.3 * i, 0.0, 0.01), 38.0 - 0.3 * i, 1e-9);
}

// The second axis begins a side, or a stroke of its own, while the first one goes on standing.
TEST(CascadeLaw, AnAxisThatHasNotMovedYetKeepsItsOffsetWhileAnotherMoves) {
  Standing axis;
  axis.Offset_N(38.0);
  axis.Offset_N(38.0);
  for (int i = 0; i < 1000; ++i) EXPECT_NEAR(axis.Offset_N(38.0 - 0.03 * i, 0.0, 0.01), 38.0, 1e-9);
  for (int i = 0; i < 300; ++i) axis.Offset_N(8.0, 0.01, 0.01);
  // It has moved: from now on it waits for the other.
  for (int i = 0; i < 100; ++i) EXPECT_NEAR(axis.Offset_N(8.0 + 0.1 * i, 0.0, 0.01), 8.0 + 0.1 * i, 0.1);
}

TEST(CascadeLaw, WithMotionTheOffsetGoesOverToWhatIsForeseenWithoutAJump) {
  Standing axis;
  axis.Offset_N(38.0);
  double before_N = axis.Offset_N(8.0);
  EXPECT_NEAR(before_N, 38.0, 1e-9);
  for (int i = 0; i < 300; ++i) {
    const double now_N = axis.Offset_N(8.0, 0.01);
    EXPECT_LT(std::abs(now_N - before_N), 0.03 * 30.0);
    before_N = now_N;
  }
  EXPECT_NEAR(before_N, 8.0, 0.1);
}

TEST(CascadeLaw, AnEnabledAxisBeginsWithWhatIsForeseen) {
  Standing axis;
  axis.Offset_N(38.0);
  axis.Offset_N(8.0);
  axis.law.Reset();
  EXPECT_NEAR(axis.Offset_N(8.0), 8.0, 1e-9);
}

TEST(CascadeLaw, ASoftenedOffsetIsSofterAtRestToo) {
  Standing axis;
  axis.Offset_N(38.0);
  axis.law.Soften(Softness::kSofter);
  EXPECT_NEAR(axis.Offset_N(8.0), 19.0, 1e-9);
}

TEST(CascadeLaw, ADriveThatDoesNotFeedAccelerationForwardIsGivenIt) {
  Loop does({0.0, 0.0}), does_not({0.0, 0.0}, 1.0), by_half({0.0, 0.0}, 0.5);
  for (int i = 0; i < 40; ++i)
    for (Loop* loop : {&does, &does_not, &by_half}) loop->Step();
  // Of the whole axis, for t(k): what acts from then on is half a period behind the targets.
  const double acceleration_N = 80.0 * OnCircle((does.k - 1) * kPeriod_s).acceleration_m_s2;
  ASSERT_GT(std::abs(acceleration_N), 100.0);
  EXPECT_NEAR(does_not.output.force_N[0] - does.output.force_N[0], acceleration_N,
              1e-3 * std::abs(acceleration_N));
  EXPECT_NEAR(by_half.output.force_N[0] - does.output.force_N[0], 0.5 * acceleration_N,
              1e-3 * std::abs(acceleration_N));
}

TEST(CascadeLaw, ABlowTeachesNothing) {
  Loop loop({0.0, 0.2e-6}), hit({0.0, 0.2e-6});
  for (int i = 0; i < 200; ++i) {
    loop.Step();
    hit.Step();
  }
  hit.measured_m += 600e-6;
  loop.Step();
  hit.Step();
  hit.measured_m = loop.measured_m;
  loop.Step();
  hit.Step();
  // One sample less, which is nothing; taken for a bend it would be micrometres.
  EXPECT_NEAR(loop.output.target_position_m[0], hit.output.target_position_m[0], 10e-9);
}

TEST(CascadeLaw, NeedsTheScrewsStiffness) {
  PerAxis<ControlledAxis> axes = OneAxis();
  axes[0].mechanics.stiffness_N_m = 0.0;
  EXPECT_THROW(CascadeLaw(axes, kPeriod_s), std::invalid_argument);
}

}  // namespace
}  // namespace contour
