#include "daemon/rt/path_follower.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;
constexpr double kRadius_m = 0.01;
constexpr double kOmega_rad_s = 5.0;
constexpr std::size_t kHorizon = 24;
constexpr double kStopPeriods = 75.0;
constexpr auto kShortest = PathFollower::StopKind::kShortest;

/// Not limited: by the fixed ramp at once.
PerAxis<StopLimits> NoLimits() {
  PerAxis<StopLimits> limits;
  limits.push_back({});
  limits.push_back({});
  return limits;
}

/// A circle from rest: the angle runs up by a smooth ramp of 0.2 s and down again at the end.
PathPoint CirclePoint(std::uint32_t program, int k, int count) {
  const double t = k * kPeriod_s;
  const double ramp = 0.2;
  double angle = 0, rate = 0, change = 0;
  if (t < ramp) {
    const double u = t / ramp;
    angle = kOmega_rad_s * ramp * (u * u * u - 0.5 * u * u * u * u);
    rate = kOmega_rad_s * u * u * (3 - 2 * u);
    change = kOmega_rad_s * 6 * u * (1 - u) / ramp;
  } else {
    angle = kOmega_rad_s * (0.5 * ramp + t - ramp);
    rate = kOmega_rad_s;
  }
  PathPoint p;
  p.program_id = program;
  p.last = k == count - 1;
  const double c = std::cos(angle), s = std::sin(angle);
  p.axes.push_back({kRadius_m * (c - 1), -kRadius_m * s * rate, kRadius_m * (-c * rate * rate - s * change)});
  p.axes.push_back({kRadius_m * s, kRadius_m * c * rate, kRadius_m * (-s * rate * rate + c * change)});
  return p;
}

class PathFollowerTest : public ::testing::Test {
 protected:
  PathFollowerTest()
      : follower_(std::make_unique<PathFollower>(NoLimits(), kPeriod_s, kStopPeriods, kHorizon)) {
    PerAxis<double> zero(2);
    zero[0] = zero[1] = 0.0;
    follower_->Hold(zero);
  }

  void Supply(int upto, int count, std::uint32_t program = 7) {
    while (next_ < upto && next_ < count && follower_->Room() != 0)
      follower_->Accept(CirclePoint(program, next_++, count));
  }
  ReferencePoint Now(std::size_t axis) {
    AxisHorizon h;
    follower_->Horizon(axis, kHorizon, h);
    return h[0];
  }

  std::unique_ptr<PathFollower> follower_;
  int next_ = 0;
};

TEST_F(PathFollowerTest, GivesThePointsThemselvesBitForBit) {
  constexpr int kCount = 600;
  follower_->Expect(7);
  Supply(kCount, kCount);
  ASSERT_TRUE(follower_->Prefetched());
  follower_->Start();
  AxisHorizon x;
  follower_->Horizon(0, kHorizon, x);
  EXPECT_EQ(x[0].position_m, 0.0);  // the feedback's instant: still at rest
  for (int k = 0; k < kCount - 1; ++k) {
    follower_->Advance();
    ASSERT_EQ(follower_->moving(), true);
    follower_->Horizon(0, kHorizon, x);
    ASSERT_EQ(x[0].position_m, CirclePoint(7, k, kCount).axes[0].position_m) << k;
    ASSERT_EQ(x[0].acceleration_m_s2, CirclePoint(7, k, kCount).axes[0].acceleration_m_s2) << k;
    if (k + 5 < kCount - 1) {
      ASSERT_EQ(x[5].velocity_m_s, CirclePoint(7, k + 5, kCount).axes[0].velocity_m_s);
    }
  }
  follower_->Advance();
  EXPECT_TRUE(follower_->at_end());
  EXPECT_EQ(Now(0).velocity_m_s, 0.0);
}

TEST_F(PathFollowerTest, StopStaysOnThePathWithinTheAccelerationLimit) {
  constexpr int kCount = 100000;
  follower_->Expect(7);
  Supply(kCount, kCount);
  follower_->Start();
  for (int k = 0; k < 700; ++k) {
    follower_->Advance();
    Supply(kCount, kCount);
  }
  const double before = follower_->path_time();
  follower_->BeginStop(kShortest);
  double largest = 0.0;
  ReferencePoint last[2] = {Now(0), Now(1)};
  int cycles = 0;
  while (!follower_->at_rest() && cycles < 1000) {
    follower_->Advance();
    ++cycles;
    const ReferencePoint x = Now(0), y = Now(1);
    // On the circle all the way, with derivatives that belong to the positions.
    ASSERT_NEAR(std::hypot(x.position_m + kRadius_m, y.position_m), kRadius_m, 1e-12);
    ASSERT_NEAR((x.position_m - last[0].position_m) / kPeriod_s,
                0.5 * (x.velocity_m_s + last[0].velocity_m_s), 2e-5);
    const double speed = std::hypot(x.velocity_m_s, y.velocity_m_s);
    const double speed_before = std::hypot(last[0].velocity_m_s, last[1].velocity_m_s);
    largest = std::max(largest, (speed_before - speed) / kPeriod_s);
    last[0] = x;
    last[1] = y;
  }
  EXPECT_TRUE(follower_->at_rest());
  EXPECT_NEAR(cycles, kStopPeriods, 4);
  // Steepest slope of the ramp: 1.5 v / T.
  EXPECT_NEAR(largest, 1.5 * kOmega_rad_s * kRadius_m / (kStopPeriods * kPeriod_s), 0.02);
  // Travel of half a ramp, and the cycle the ramp waits for.
  EXPECT_NEAR(follower_->path_time() - before, 0.5 * kStopPeriods + 1, 1.5);
  EXPECT_EQ(Now(0).velocity_m_s, 0.0);
  EXPECT_EQ(Now(0).acceleration_m_s2, 0.0);
}

TEST_F(PathFollowerTest, RunsDryInTimeToStopOnThePath) {
  constexpr int kCount = 100000;
  constexpr int kSupplied = 1024;
  follower_->Expect(7);
  Supply(kSupplied, kCount);
  follower_->Start();
  int cycles = 0;
  while (!follower_->running_dry() && cycles++ < 2000) follower_->Advance();
  ASSERT_TRUE(follower_->running_dry());
  follower_->BeginStop(kShortest);
  while (!follower_->at_rest() && cycles++ < 4000) follower_->Advance();
  EXPECT_TRUE(follower_->at_rest());
  EXPECT_LT(follower_->path_time(), kSupplied - 1.0);
  EXPECT_FALSE(follower_->at_end());
}

TEST_F(PathFollowerTest, IgnoresPointsOfAnotherProgramAndAfterTheLast) {
  follower_->Expect(7);
  follower_->Accept(CirclePoint(6, 0, 10));
  EXPECT_EQ(follower_->waiting(), 0u);
  Supply(10, 10);
  EXPECT_TRUE(follower_->Prefetched());
  EXPECT_EQ(follower_->Room(), 0u);
  follower_->Accept(CirclePoint(7, 3, 10));
  EXPECT_EQ(follower_->waiting(), 10u);
}

/// The same circle from point `from` on at half the pace: law 1.
PathPoint HalfPace(int from, int k, int count) {
  PathPoint p = CirclePoint(7, k, count);
  if (k >= from) {
    // Between two points of the circle; what lies there does not matter here, but that it is told apart.
    p = CirclePoint(7, from + (k - from) / 2, count);
    p.law = 1;
    p.program_time_s = kPeriod_s * (from + 0.5 * (k - from));
    p.line = 3;
  }
  p.index = static_cast<std::uint64_t>(k);
  return p;
}

TEST_F(PathFollowerTest, AnotherLawOfTimeTakesThePlaceOfWhatWasToCome) {
  constexpr int kCount = 100000;
  follower_->Expect(7);
  Supply(kCount, kCount);
  follower_->Start();
  for (int k = 0; k < 300; ++k) {
    follower_->Advance();
    Supply(kCount, kCount);
  }
  const PathProgress before = follower_->progress();
  ASSERT_NE(before.earliest, PathProgress::kNowhere);
  const int from = static_cast<int>(before.earliest) + 1;
  // Points that are here already come again first, and change nothing.
  int next = from - 5;
  const auto supply = [&] {
    for (int i = 0; i < 8 && follower_->Room() != 0; ++i) follower_->Accept(HalfPace(from, next++, kCount));
  };
  for (int k = 300; k < from + 400; ++k) {
    supply();
    ASSERT_FALSE(follower_->running_dry()) << k;
    follower_->Advance();
    AxisHorizon x;
    follower_->Horizon(0, kHorizon, x);
    for (std::size_t j = 0; j < kHorizon; ++j)
      ASSERT_EQ(x[j].position_m, HalfPace(from, k + static_cast<int>(j), kCount).axes[0].position_m)
          << k << " " << j;
    const double time_s = k < from ? kPeriod_s * k : kPeriod_s * (from + 0.5 * (k - from));
    ASSERT_NEAR(follower_->program_place().time_s, time_s, 1e-12);
    ASSERT_NEAR(follower_->program_place().pace, k < from ? 1.0 : 0.5, 1e-9);
    ASSERT_EQ(follower_->program_place().line, k < from ? 0u : 3u);
  }
  EXPECT_EQ(follower_->progress().law, 1u);
  EXPECT_EQ(follower_->progress().refused_law, 0u);
  follower_->BeginStop(kShortest);
  EXPECT_EQ(follower_->progress().earliest, PathProgress::kNowhere) << "a stop keeps its path";
  for (int k = 0; k < 200 && !follower_->at_rest(); ++k) follower_->Advance();
  EXPECT_TRUE(follower_->at_rest());
}

TEST_F(PathFollowerTest, ALawThatComesTooLateIsRefusedAndChangesNothing) {
  constexpr int kCount = 100000;
  follower_->Expect(7);
  Supply(kCount, kCount);
  follower_->Start();
  for (int k = 0; k < 300; ++k) follower_->Advance();
  const PathProgress before = follower_->progress();
  for (const std::uint64_t index : {before.earliest - 1, before.end + 1}) {
    PathPoint late = HalfPace(static_cast<int>(index), static_cast<int>(index), kCount);
    ++late.law;
    late.law += static_cast<std::uint32_t>(index);
    follower_->Accept(late);
    EXPECT_EQ(follower_->progress().refused_law, late.law);
    // What follows it is refused with it.
    ++late.index;
    follower_->Accept(late);
  }
  EXPECT_EQ(follower_->progress().end, before.end);
  EXPECT_EQ(follower_->progress().law, 0u);
  for (int k = 300; k < 600; ++k) {
    follower_->Advance();
    ASSERT_EQ(Now(0).position_m, CirclePoint(7, k, kCount).axes[0].position_m);
  }
}

TEST_F(PathFollowerTest, ALawMayTakeBackTheLastPoint) {
  constexpr int kCount = 600;
  follower_->Expect(7);
  EXPECT_EQ(follower_->progress().earliest, PathProgress::kNowhere) << "it does not run yet";
  Supply(kCount, kCount);
  EXPECT_EQ(follower_->Room(), 0u);
  follower_->Start();
  for (int k = 0; k < 100; ++k) follower_->Advance();
  EXPECT_EQ(follower_->Room(), 1u);
  const int from = 400;
  follower_->Accept(HalfPace(from, from, kCount));
  EXPECT_EQ(follower_->progress().law, 1u);
  EXPECT_EQ(follower_->progress().end, static_cast<std::uint64_t>(from + 1));
  EXPECT_GT(follower_->Room(), 8u);
}

TEST(PathFollower, RefusesAStopThatItCannotLookAheadFor) {
  EXPECT_THROW(PathFollower(NoLimits(), kPeriod_s, 2000.0, kHorizon), std::invalid_argument);
}

TEST_F(PathFollowerTest, ExtraTorqueFadesWithThePaceAndTheSpringStays) {
  constexpr int kCount = 1000;
  follower_->Expect(7);
  for (int k = 0; k < kCount; ++k) {
    PathPoint p = CirclePoint(7, k, kCount);
    p.axes[0].extra_torque_Nm = 0.5;
    p.axes[0].spring_N_m = 1e5;
    follower_->Accept(p);
  }
  follower_->Start();
  for (int k = 0; k < 100; ++k) follower_->Advance();
  EXPECT_EQ(Now(0).extra_torque_Nm, 0.5);
  EXPECT_EQ(Now(1).extra_torque_Nm, 0.0);
  follower_->BeginStop(kShortest);
  double before = 0.5;
  while (!follower_->at_rest()) {
    follower_->Advance();
    if (follower_->at_rest()) break;
    EXPECT_LE(Now(0).extra_torque_Nm, before);
    EXPECT_NEAR(Now(0).spring_N_m, 1e5, 1e-6);
    before = Now(0).extra_torque_Nm;
  }
  EXPECT_LT(before, 0.02);
  EXPECT_EQ(Now(0).extra_torque_Nm, 0.0);
  EXPECT_EQ(Now(0).spring_N_m, 0.0);
}

TEST_F(PathFollowerTest, StopInTheFirstCyclesOfAProgram) {
  constexpr int kCount = 1000;
  follower_->Expect(7);
  Supply(kCount, kCount);
  follower_->Start();
  follower_->BeginStop(kShortest);
  for (int k = 0; k < 200 && !follower_->at_rest(); ++k) follower_->Advance();
  EXPECT_TRUE(follower_->at_rest());
  EXPECT_NEAR(Now(0).position_m, CirclePoint(7, 38, kCount).axes[0].position_m, 1e-5);
}

}  // namespace
}  // namespace contour
