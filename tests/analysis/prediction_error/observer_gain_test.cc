#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analysis/prediction_error/forward_filter.h"

namespace contour::diagnosis {
namespace {

AxisModel Rigid(double inertia) {
  AxisModel m;
  m.motor_inertia = inertia;
  return m;
}

// (w T)^2 is the tracking index: the gain of position is what Kalata's equations make of it. Force that is
// held over the period is not force at its beginning, so it is so for slow observers.
TEST(ObserverGain, OfARigidAxisFollowsItsBandwidth) {
  for (const double bandwidth_Hz : {5.0, 10.0, 20.0}) {
    const double index = std::pow(2.0 * std::numbers::pi * bandwidth_Hz * 1e-3, 2);
    const double d = (4.0 + index - std::sqrt(8.0 * index + index * index)) / 4.0;
    const ObserverGain gain = SteadyObserverGain(Rigid(5e-5), 1e-3, bandwidth_Hz);
    EXPECT_NEAR(gain[0], 1.0 - d * d, 1e-6) << bandwidth_Hz;
    EXPECT_EQ(gain[2], 0.0);
    EXPECT_EQ(gain[3], 0.0);
  }
}

TEST(ObserverGain, TheInertiaDoesNotMatter) {
  const ObserverGain light = SteadyObserverGain(Rigid(1e-6), 1e-3, 35.0),
                     heavy = SteadyObserverGain(Rigid(1.0), 1e-3, 35.0);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(light[i] / heavy[i], 1.0, 1e-6);
}

TEST(ObserverGain, TwoInertiasOnAHardScrewMoveAsOne) {
  AxisModel two = Rigid(3e-5);
  two.two_inertia = true;
  two.load_inertia = 2e-5;
  two.stiffness = 2e-5 * 4e8;
  two.damping = 5e-2;
  const ObserverGain one = SteadyObserverGain(Rigid(5e-5), 1e-3, 35.0),
                     both = SteadyObserverGain(two, 1e-3, 35.0);
  EXPECT_NEAR(both[0], both[2], 0.02 * both[0]);
  EXPECT_NEAR(both[1], both[3], 0.05 * both[1]);
  EXPECT_NEAR(both[0] / one[0], 1.0, 0.3);
}

}  // namespace
}  // namespace contour::diagnosis
