#include <gtest/gtest.h>

#include <algorithm>

#include "tests/control/motion_rig.h"

// An encoder may begin to lie anywhere between two samples, and its first lie is then a part of a step.
namespace contour {
namespace {

constexpr int kPlaces = 20;  // in a period

/// How long after it the worst place is told [periods]. `lie`: what is read so far beyond where it began [m].
template <class Lie>
double WorstPeriods(double speed_m_s, const Lie& lie) {
  double worst = 0.0;
  for (int place = 0; place < kPlaces; ++place) {
    Rig rig;
    rig.RunUp(speed_m_s, 1000);
    const double share = static_cast<double>(place) / kPlaces;
    const double began_m = rig.position_m() + share * speed_m_s * kPeriod_s;
    rig.tells = [&](double p) { return began_m + lie(p - began_m); };
    int periods = 0;
    double away_m = 0.0;
    EXPECT_NE(rig.Until(speed_m_s, 2000, periods, away_m), Reason::kNone) << place;
    worst = std::max(worst, periods - share);
  }
  return worst;
}

// `contour check` reckons with two (config/motion_bounds.cc).
TEST(BetweenTwoSamples, WhatShowsAtOnceShowsWithinTwoPeriods) {
  double worst = 0.0;
  for (const double speed_m_s : {0.05, 0.1, 0.15, 0.25}) {
    const double frozen = WorstPeriods(speed_m_s, [](double) { return 0.0; });
    EXPECT_LE(frozen, 2.0) << speed_m_s;
    EXPECT_LE(WorstPeriods(speed_m_s, [](double m) { return -m; }), 2.0) << speed_m_s;
    worst = std::max(worst, frozen);
  }
  EXPECT_GT(worst, 1.0) << "it may miss the first sample";
}

}  // namespace
}  // namespace contour
