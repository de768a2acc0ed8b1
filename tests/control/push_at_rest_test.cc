#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "control/motion_monitor.h"
#include "tests/control/motion_rig.h"

namespace contour {
namespace {

/// An axis whose drive closes the loop, brought to rest; from then on its reading stands.
class AtRest {
 public:
  explicit AtRest(double period_s = kPeriod_s) : period_s_(period_s), monitor_(InCascade(), {}, period_s) {}

  /// A motion that ends now: `braking_N` was needed for it.
  void Stop(double braking_N) {
    const double speed_m_s = 0.02;
    s_.enabled = s_.fresh = true;
    for (double left_s = 0.2; left_s > 0.0; left_s -= period_s_) {
      s_.reference_m += speed_m_s * period_s_ * std::min(1.0, 20.0 * left_s);
      s_.position_m = InCascade().count_m * std::floor(s_.reference_m / InCascade().count_m);
      ASSERT_EQ(Step(left_s < 0.05 ? Held_N() - braking_N : Held_N()), Reason::kNone)
          << left_s << " s before rest";
    }
  }
  /// Stands without torque; the next step enables it.
  void Disabled() {
    s_.fresh = true;
    for (int k = 0; k < 5; ++k) ASSERT_EQ(Step(0.0), Reason::kNone);
    s_.enabled = true;
  }
  /// What friction leaves on the drive.
  static double Held_N() { return 0.8 * InCascade().Fc_N; }
  Reason Step(double reported_N) {
    s_.reported_force_N = reported_N;
    return monitor_.Step(s_);
  }
  /// So many counts from where it stopped.
  void Read(int counts) {
    const double moved = counts - counts_;
    s_.position_m += moved * InCascade().count_m;
    counts_ = counts;
  }
  static MonitoredAxis InCascade() {
    MonitoredAxis axis = Axis();
    axis.in_cascade = true;
    return axis;
  }

 private:
  double period_s_;
  MotionMonitor monitor_;
  MotionSample s_;
  int counts_ = 0;
};

/// What 0x6077 says in steps of one per mille.
double PerMille(double force_N) {
  const double step_N = 1e-3 * AtRest::InCascade().rated_force_N;
  return step_N * std::round(force_N / step_N);
}

// The integral of a drive's loop pushes at once, and friction may hardly hold the axis any more.
TEST(PushAtRest, ThatGrowsUnderAStandingReadingIsSeenRightAfterAMotion) {
  for (const double slope_N_s : {8.0, 40.0, 200.0, 4000.0}) {
    AtRest axis;
    axis.Stop(0.0);
    double pushed_N = 0.0;
    Reason found = Reason::kNone;
    while (found == Reason::kNone && pushed_N < 400.0) {
      pushed_N += slope_N_s * kPeriod_s;
      found = axis.Step(PerMille(AtRest::Held_N() + pushed_N));
    }
    EXPECT_EQ(found, Reason::kFeedbackFrozen);
    // Slow ones before they add up to what breaks the axis away, fast ones before it has gone anywhere.
    const double share = 0.2 * AtRest::InCascade().Fc_N;
    EXPECT_LT(pushed_N, share + 0.03 * slope_N_s) << slope_N_s << " N/s";
  }
}

/// Of a step that comes so long after the axis has come to rest: until it is told.
int PeriodsUntilTold(double period_s, int at_rest) {
  AtRest axis(period_s);
  axis.Stop(0.0);
  for (int k = 0; k < at_rest + 200; ++k)
    if (axis.Step(PerMille(AtRest::Held_N() + (k < at_rest ? 0.0 : 400.0))) == Reason::kFeedbackFrozen)
      return k + 1 - at_rest;
  return 1000;
}

// Where 20 ms are hardly more than what is under way, too: within what `contour check` counts on.
TEST(PushAtRest, AStepIsSeenInLongCyclesToo) {
  for (const double period_s : {1e-3, 2e-3, 5e-3, 10e-3, 20e-3}) {
    const MotionThresholds t = ThresholdsOf(AtRest::InCascade(), {}, period_s);
    const auto begin = static_cast<int>(t.begin_periods), most = static_cast<int>(t.PushSeen_periods());
    for (const int at_rest : {begin, begin + 1, begin + 3, 100})
      EXPECT_LE(PeriodsUntilTold(period_s, at_rest), most)
          << period_s << " s, " << at_rest << " periods at rest";
  }
}

/// What a report may do while nothing pushes, by the time since the axis came to rest.
struct Report {
  const char* what;
  double braking_N;
  std::function<double(double time_s, double noise)> says_N;
};

TEST(PushAtRest, IsNotWhatAReportDoesByItself) {
  const double rated_N = AtRest::InCascade().rated_force_N;
  const Report reports[] = {
      {"filtered", 150.0, [](double t, double) { return -150.0 * std::exp(-t / 10e-3); }},
      {"filtered, and rings", 150.0,
       [](double t, double) { return -150.0 * std::exp(-t / 10e-3) * std::cos(300.0 * t); }},
      {"noise", 0.0, [=](double, double noise) { return 0.005 * rated_N * noise; }},
      {"hum", 0.0,
       [=](double t, double) { return 0.01 * rated_N * std::sin(2.0 * std::numbers::pi * 50.0 * t); }},
      {"coarse steps", 0.0,
       [=](double t, double noise) {
         const double step_N = 0.005 * rated_N;
         return step_N * std::round(0.5 + std::sin(0.3 * t) + 0.02 * noise);
       }},
      {"drifts", 0.0, [=](double t, double) { return PerMille(0.01 * rated_N * t / 60.0); }},
  };
  for (const double period_s : {0.25e-3, 1e-3, 2e-3})
    for (const Report& report : reports) {
      std::mt19937 draw(7);
      std::normal_distribution<double> noise;
      AtRest axis(period_s);
      axis.Stop(report.braking_N);
      for (double t = 0.0; t < 30.0; t += period_s)
        ASSERT_EQ(axis.Step(AtRest::Held_N() + report.says_N(t, noise(draw))), Reason::kNone)
            << report.what << " at " << t << " s, period " << period_s;
    }
}

// An axis that rests beside the edge of a count. Its drive reads more often than we do and answers every
// count that comes or goes by a kick of one of its ticks, of which 0x6077 shows those that fall on a SYNC.
TEST(PushAtRest, IsNotWhatCountsThatFlickerBetweenReadingsMakeOfTheReport) {
  const double kick_N = 0.3 * AtRest::InCascade().rated_force_N;
  for (const double share : {0.02, 0.05, 0.1, 0.2, 0.5})
    for (unsigned seed = 1; seed <= 10; ++seed) {
      std::mt19937 draw(seed);
      std::bernoulli_distribution beyond(share);
      AtRest axis;
      axis.Stop(0.0);
      for (int k = 0; k < 5000; ++k) {
        const int before = beyond(draw) ? 1 : 0, now = beyond(draw) ? 1 : 0;
        axis.Read(now);
        ASSERT_EQ(axis.Step(AtRest::Held_N() + kick_N * (now - before)), Reason::kNone)
            << "share " << share << ", seed " << seed << ", period " << k;
      }
    }
}

// As a drive with a table of 300 kg behind 10 000 counts a turn said in its first four cycles: the kick that
// answers a count was over before anything of it had come back.
TEST(PushAtRest, IsNotWhatADriveAnswersToTheCountsThatFlickerWhenItIsEnabled) {
  const double rated_N = AtRest::InCascade().rated_force_N;
  for (const int moves_at : {-1, 0, 1}) {
    AtRest axis;
    axis.Disabled();
    int k = 0;
    for (const double share : {0.81, 0.34, 0.17, -0.40, 0.03, 0.0}) {
      if (k == moves_at) axis.Read(1);
      ASSERT_EQ(axis.Step(share * rated_N), Reason::kNone) << "moves at " << moves_at << ", cycle " << k;
      ++k;
    }
  }
}

// Nor does that hide a push under an encoder that is frozen when its axis is enabled.
TEST(PushAtRest, IsSeenRightAfterEnabling) {
  AtRest axis;
  axis.Disabled();
  double pushed_N = 0.0;
  Reason found = Reason::kNone;
  while (found == Reason::kNone && pushed_N < 400.0) {
    pushed_N += 200.0 * kPeriod_s;
    found = axis.Step(PerMille(pushed_N));
  }
  EXPECT_EQ(found, Reason::kFeedbackFrozen);
  EXPECT_LT(pushed_N, 0.2 * AtRest::InCascade().Fc_N + 0.03 * 200.0);
}

// Of an axis that hangs on its drive, a weight that friction does not bear.
TEST(PushAtRest, IsSeenWhereTheDriveHoldsAWeightFromTheFirstReport) {
  for (const double rate_N_s : {50.0, 200.0, 1000.0})
    for (const double sign : {-1.0, 1.0}) {
      AtRest axis;
      axis.Disabled();
      const double weight_N = 3.0 * AtRest::InCascade().Fc_N;
      for (int k = 0; k < 300; ++k) ASSERT_EQ(axis.Step(PerMille(weight_N)), Reason::kNone);
      double pushed_N = 0.0;
      Reason found = Reason::kNone;
      while (found == Reason::kNone && pushed_N < 400.0) {
        pushed_N += rate_N_s * kPeriod_s;
        found = axis.Step(PerMille(weight_N + sign * pushed_N));
      }
      EXPECT_EQ(found, Reason::kFeedbackFrozen);
      EXPECT_LT(pushed_N, 0.2 * AtRest::InCascade().Fc_N + 0.03 * rate_N_s) << rate_N_s * sign;
    }
}

}  // namespace
}  // namespace contour
