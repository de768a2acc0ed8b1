#include "analysis/rough_fit/smoothed_motion.h"

#include <gtest/gtest.h>

#include <cmath>

namespace contour::diagnosis {
namespace {

/// A sine of 2 Hz and amplitude 1, 4 s at 1 kHz, a gap at 2 s.
AxisLog Sine() {
  AxisLog log;
  log.period_s = 1e-3;
  for (int k = 0; k < 4000; ++k) {
    log.position.push_back(std::sin(4.0 * M_PI * 1e-3 * k));
    log.command.push_back(0.5);
  }
  log.rows = log.position.size();
  log.present.assign(log.rows, 1);
  log.present[2000] = 0;
  return log;
}

TEST(SmoothMotion, HasSpeedAndAccelerationOfTheSameSmoothing) {
  const AxisLog log = Sine();
  const SmoothedMotion m = SmoothMotion(log, StatedAxis{}, nullptr);
  ASSERT_EQ(m.size(), log.size());
  constexpr double kOmega = 4.0 * M_PI;
  for (const std::size_t k : {300U, 1001U, 3333U}) {
    const double phase = kOmega * 1e-3 * static_cast<double>(k);
    ASSERT_NE(m.counts[k], 0);
    EXPECT_NEAR(m.velocity[k], kOmega * std::cos(phase), 0.01 * kOmega);
    EXPECT_NEAR(m.acceleration[k], -kOmega * kOmega * std::sin(phase), 0.01 * kOmega * kOmega);
    EXPECT_NEAR(m.command[k], 0.5, 1e-12);
  }
  EXPECT_EQ(m.counts[0], 0);
  EXPECT_EQ(m.counts[1995], 0) << "a gap is near";
  EXPECT_TRUE(m.Slides(1001));
  EXPECT_FALSE(m.Slides(125)) << "it turns there";
}

TEST(SmoothMotion, TakesOutWhatFallsWithTheSpeed) {
  StatedFriction falling;
  falling.Fs_plus = falling.Fs_minus = 0.3;
  falling.Fc_plus = falling.Fc_minus = 0.2;
  falling.vs = 1e6;
  const SmoothedMotion m = SmoothMotion(Sine(), StatedAxis{}, &falling);
  EXPECT_NEAR(m.command[1001], 0.4, 1e-3) << "forth";
  EXPECT_NEAR(m.command[750], 0.6, 1e-3) << "back";
}

TEST(SmoothAsMotion, LeavesAConstantForce) {
  for (const double x : SmoothAsMotion(Signal(200, 0.7), 1e-3)) EXPECT_NEAR(x, 0.7, 1e-12);
}

}  // namespace
}  // namespace contour::diagnosis
