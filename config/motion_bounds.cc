#include "config/motion_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "config/extended_model.h"
#include "config/stated_push.h"
#include "config/stopping.h"
#include "control/loop_bandwidth.h"
#include "control/monitored_axis.h"
#include "control/motion_thresholds.h"
#include "core/mechanics.h"
#include "drivers/cia402/mode_for.h"

namespace contour {
namespace {

// A drive takes the voltage off by its own clock, at most one period of ours after the frame; its current
// then fades along its lag.
constexpr double kLagsToNothing = 3.0;
// Statuswords in which a drive does not follow until that is a fault, besides its delay.
constexpr double kTellingWords = 3.0;
// Presliding may be so much softer than stated.
constexpr double kSofter = 3.0;

struct Axis {
  MonitoredAxis monitored;
  MotionThresholds t;
  AxisLimitsSi limits;
  double period_s = 0.0;
  double lag_s = 0.0;
  double friction_drop_N = 0.0;
  double unborne_N = 0.0;  ///< of what the model says pushes, beyond Coulomb friction: acts with the drive
  double braked_N = 0.0;   ///< by friction without torque, less what the model says pushes
};

// As stiff as the cycle tells its monitors that the loops in use are.
double Loop_Hz(const MachineConfig& config, bool in_cascade) {
  double least_Hz = std::numeric_limits<double>::infinity();
  if (KnowsTwoInertias(config.machine.controller, config.control.friction) && !in_cascade)
    for (const auto& [name, axis] : config.axes)
      if (axis.loop) least_Hz = std::min(least_Hz, axis.loop->regulator_Hz);
  return StiffnessInUse_Hz(config.control, config.machine.controller, in_cascade, least_Hz);
}

Axis Known(const MachineConfig& config, const AxisConfig& axis) {
  const ExtendedModel model = Extended(axis.model);
  const Mechanics m = ToSi(model.mechanics);
  const Friction f = ToSi(model.friction, m.radius_m_rad);
  const bool in_cascade = ModeFor(config.machine.controller, axis.drive) == DriveMode::kCsp;
  // A file with other mistakes is refused for those.
  const auto bus = config.buses.find(axis.drive.bus);
  const std::uint32_t bitrate_bit_s =
      bus == config.buses.end() ? BusConfig{}.bitrate_bit_s : bus->second.bitrate_bit_s;
  const MonitoredDrive drive{axis.drive.rated_torque_Nm,
                             static_cast<double>(axis.drive.encoder_counts_per_rev),
                             static_cast<std::uint32_t>(axis.drive.delay_cycles), bitrate_bit_s, in_cascade};
  Axis a;
  a.limits = ToSi(axis.limits, m.radius_m_rad);
  a.monitored = ToMonitored(m, ToMonitored(f), drive, a.limits, Loop_Hz(config, in_cascade));
  a.period_s = 1e-6 * config.machine.cycle_us;
  a.t = ThresholdsOf(a.monitored, config.control.monitor, a.period_s);
  a.lag_s = 1e-3 * axis.drive.lag_ms;
  a.friction_drop_N = a.monitored.Fs_N - a.monitored.Fc_N;
  const double unborne_N = UnbornePushOf(axis.model).sliding_N;
  a.unborne_N = std::max(0.0, unborne_N);
  a.braked_N = std::max(0.0, -unborne_N);
  return a;
}

// From the sample that shows it to no torque: one period to the frame, one for the drive, its lag.
double Off_s(const Axis& a) {
  return (1.0 + a.monitored.delay_cycles) * a.period_s + kLagsToNothing * a.lag_s;
}

// The path ends with the cycle before the one that sees the fault; an axis in motion goes on until the torque
// is off.
double GoesOn_m(const Axis& a, double feed_m_s) { return feed_m_s * (a.period_s + Off_s(a)); }

// By the torque limit and what pushes along with it.
double Hardest_m_s2(const Axis& a) { return (a.limits.force_N + a.unborne_N) / a.t.light_kg; }

// What the torque limit can do while a force that is on its way has not been judged yet, and for so long
// before.
double Slam_m(const Axis& a, double speed_m_s, double before_s = 0.0) {
  const double open_s = before_s + a.period_s + Off_s(a);
  return speed_m_s * open_s + 0.5 * Hardest_m_s2(a) * open_s * open_s;
}

double JumpSeen_m(const Axis& a, double feed_m_s) {
  // Anything up to the limits may act when it happens.
  return a.t.Jump_m(feed_m_s, a.limits.force_N, a.period_s, 1.0, 1.0);
}

// What changes between two samples changes two steps of the readings, each by a share. Where the share of the
// first is just too little to show, it is told by the second: up to two periods later.
double AtOnce_s(const Axis& a) { return 2.0 * a.period_s; }
// A drive's own loop answers what changes before we have a sample of it.
double AnswersBefore_s(const Axis& a) { return a.monitored.in_cascade ? AtOnce_s(a) : 0.0; }

// From a path that begins to go on without the axis to the answer of the loop.
double Answer_s(const Axis& a) { return (a.t.loop_periods + 1.0 + a.t.begin_periods) * a.period_s; }

// By what the path must go on under a reading that stands. In csp the torque is known by the drive's report
// alone, and what that swings by may be a disturbance that settles.
double Path_m(const Axis& a, const Standing& standing) {
  const double swings_N = a.monitored.in_cascade ? a.t.rest_force_N - a.t.frozen.force_N : 0.0;
  return standing.Path_m(a.t.loop_N_m, kSettlingShare * swings_N);
}

// Until the path has gone on by what may be taken up while the reading stands.
double GoneOn_s(const Axis& a, const Standing& standing, double begins, double feed_m_s) {
  const double path_m = begins * Path_m(a, standing);
  const double shows_m_s = (1.0 - kSettlingShare * kLoopOvershoot) * feed_m_s;
  if (begins <= 1.0) return path_m / shows_m_s;
  // Under a reading that flickers inertia takes up a share, less the longer it lasts: the first time from
  // which on both are exceeded.
  const auto short_m = [&](double time_s) {
    return path_m + begins * a.t.Inertial_N(standing, time_s) / a.t.loop_N_m - shows_m_s * time_s;
  };
  double early_s = 0.0, late_s = a.period_s;
  while (short_m(late_s) > 0.0) late_s *= 2.0;
  for (int i = 0; i < 50; ++i) {
    const double middle_s = 0.5 * (early_s + late_s);
    (short_m(middle_s) > 0.0 ? early_s : late_s) = middle_s;
  }
  // Our own loops' torque is looked at through a filter.
  return late_s + (a.monitored.in_cascade ? 0.0 : (kChatter_periods + a.monitored.delay_cycles) * a.period_s);
}

// `begins`: how often the reading that stands may be taken for a new one.
FaultBound Frozen(const Axis& a, const Standing& standing, double begins, double feed_m_s) {
  const double infinity = std::numeric_limits<double>::infinity();
  // A drive's own loop may add up what flickers as slowly as it likes: at rest nothing tells it from a load.
  if (feed_m_s <= 0.0 && begins > 1.0 && a.monitored.in_cascade) return {infinity, infinity};
  if (feed_m_s <= 0.0) {
    // At rest nothing asks for another force; what the force may change by moves presliding at its softest.
    const double soft_N_m = a.monitored.sigma0_N_m / kSofter;
    // In the time that the force is judged late, and after, it may break away.
    const double force_N = begins > 1.0 ? a.t.pushed_force_N : a.t.rest_force_N;
    // What a motion left may be all that friction bears; a drive's own loop then moves the axis at once, and
    // small changes of its torque count only under a reading that has stood for a while.
    const double free_s = a.monitored.in_cascade ? a.t.PushSeen_periods() * a.period_s : 0.0;
    const double acceleration = (force_N + a.friction_drop_N) / a.t.light_kg;
    const double away_m = force_N / soft_N_m + 0.5 * acceleration * free_s * free_s;
    return {1e3 * (away_m + Slam_m(a, acceleration * free_s)), Off_s(a)};
  }
  // What the loop made of the motion before may still be settling, by its share.
  // Seen by the reading's step to rest at once, or by the path going on for as long as the loop takes to
  // answer.
  const bool at_once = feed_m_s * a.period_s > JumpSeen_m(a, feed_m_s);
  const double begin_s = a.t.begin_periods * a.period_s;
  const double answer_s = begins * (a.t.loop_periods + 1.0) * a.period_s + begin_s;
  const double seen_s =
      at_once ? AtOnce_s(a)
              : std::max(GoneOn_s(a, standing, begins, feed_m_s) + a.period_s + begin_s, answer_s);
  // Until then the force is what moved the axis before, changed by what the loop makes of the standing
  // reading, and by no more than would show by itself; friction may fall from break-away to Coulomb's.
  const double built_N =
      at_once ? 0.0 : std::min(kLoopOvershoot * a.t.loop_N_m * feed_m_s * seen_s, a.t.frozen_force_N);
  const double excess_N = a.friction_drop_N + built_N;
  const double acceleration = excess_N / a.t.light_kg;
  const double away_m = 0.5 * acceleration * seen_s * seen_s;
  const double before_s = at_once ? AnswersBefore_s(a) : 0.0;
  return {1e3 * (away_m + Slam_m(a, acceleration * seen_s, before_s) + GoesOn_m(a, feed_m_s)),
          seen_s + a.period_s + Off_s(a)};
}

// Until an axis without torque is the following error away from its path, which it leaves from rest or at the
// path's speed.
double LeftBehind_s(const Axis& a, double feed_m_s) {
  const double fe_m = a.limits.following_error_m;
  if (a.unborne_N > 0.0) return std::sqrt(2.0 * fe_m * a.t.heavy_kg / a.unborne_N);
  if (feed_m_s <= 0.0) return 0.0;
  // It coasts; once it stands, the path goes on.
  const double coasts_s = a.braked_N > 0.0 ? feed_m_s * a.t.heavy_kg / a.braked_N : 0.0;
  const double while_coasting_m = 0.5 * feed_m_s * coasts_s;
  return fe_m < while_coasting_m ? coasts_s * std::sqrt(fe_m / while_coasting_m)
                                 : 0.5 * coasts_s + fe_m / feed_m_s;
}

// Without torque the axis stays behind its path, and where friction does not bear what pushes, it falls
// besides. Along a path downwards it is ahead, faster than the path by what it has fallen.
FaultBound TorqueLost(const Axis& a, double feed_m_s) {
  const double fe_m = a.limits.following_error_m, fall_m_s2 = a.unborne_N / a.t.light_kg;
  const double away_m_s = feed_m_s + std::sqrt(2.0 * fall_m_s2 * fe_m);
  const double open_s = a.period_s + Off_s(a);
  const double seen_s = LeftBehind_s(a, feed_m_s);
  return {1e3 * (fe_m + away_m_s * open_s + 0.5 * fall_m_s2 * open_s * open_s), seen_s + open_s};
}

// Feedback that tells the mirror image of the truth: the following error ends it.
FaultBound RunsAway(const Axis& a, double feed_m_s) {
  // A sign that changes in motion shows in the reading that changes: by twice the way of a period.
  if (2.0 * feed_m_s * a.period_s > JumpSeen_m(a, feed_m_s))
    return {1e3 * (Slam_m(a, 0.0, AnswersBefore_s(a)) + GoesOn_m(a, feed_m_s)),
            AtOnce_s(a) + a.period_s + Off_s(a)};
  const double fe_m = a.limits.following_error_m;
  const double gain_m_s = std::sqrt(2.0 * Hardest_m_s2(a) * fe_m);
  // Nothing moves before the loop's force breaks the axis away, along the path; then an unstable loop
  // leaves its first count by e^(w t).
  const double rate_1_s = std::sqrt(a.t.loop_N_m / (a.t.mass_kg * 2.0));
  const double break_away_s = feed_m_s > 0.0 ? a.monitored.Fs_N / (a.t.loop_N_m * feed_m_s) : 0.0;
  const double seen_s = std::min(feed_m_s > 0.0 ? fe_m / feed_m_s + 1.0 / rate_1_s : 1e9,
                                 break_away_s + std::log(1.0 + fe_m / a.monitored.count_m) / rate_1_s);
  return {1e3 * (fe_m + Slam_m(a, gain_m_s + 2.0 * feed_m_s)), seen_s + a.period_s + Off_s(a)};
}

}  // namespace

std::string_view Name(MotionFault fault) {
  switch (fault) {
    case MotionFault::kFrozen:
      return "encoder frozen";
    case MotionFault::kFlickers:
      return "frozen, flickers";
    case MotionFault::kJump:
      return "encoder jumps";
    case MotionFault::kSmallJump:
      return "jump not seen";
    case MotionFault::kReversed:
      return "encoder reversed";
    case MotionFault::kTorqueLost:
      return "torque lost";
    case MotionFault::kNotFollowing:
      return "drive tells of it";
  }
  return "unknown";
}

FaultBound BoundOf(const MachineConfig& config, const AxisConfig& axis, MotionFault fault, double feed_mm_s) {
  const Axis a = Known(config, axis);
  const double feed_m_s = 1e-3 * feed_mm_s;
  switch (fault) {
    case MotionFault::kFrozen:
      return Frozen(a, a.t.frozen, 1.0, feed_m_s);
    case MotionFault::kFlickers:
      return Frozen(a, a.t.flickering, 2.0, feed_m_s);
    case MotionFault::kJump:
      // Seen in the reading that jumps, before anything answers it.
      return {1e3 * (Slam_m(a, 0.0) + GoesOn_m(a, feed_m_s)), a.period_s + Off_s(a)};
    case MotionFault::kSmallJump:
      return {1e3 * JumpSeen_m(a, feed_m_s), 0.0};
    case MotionFault::kReversed:
      return RunsAway(a, feed_m_s);
    case MotionFault::kTorqueLost:
      return TorqueLost(a, feed_m_s);
    case MotionFault::kNotFollowing:
      // Some statuswords without the bit, then the drive's own ramp.
      return {1e3 * (a.limits.following_error_m + Slam_m(a, 0.0) + GoesOn_m(a, feed_m_s)),
              QuickStop(ToStoppingAxis(config, axis), feed_m_s,
                        (kTellingWords + a.monitored.delay_cycles) * a.period_s + Off_s(a))
                  .time_s};
  }
  return {};
}

std::vector<double> BoundFeeds_mm_s(const AxisConfig& axis) {
  std::vector<double> feeds{0.0};
  for (double feed = kSlowestFeed_mm_s; feed < 0.999 * axis.limits.velocity_mm_s; feed *= 10.0)
    feeds.push_back(feed);
  feeds.push_back(axis.limits.velocity_mm_s);
  return feeds;
}

double PromisedFeed_mm_s(const MachineConfig& config, const AxisConfig& axis) {
  if (axis.limits.slowest_feed_mm_s > 0.0) return axis.limits.slowest_feed_mm_s;
  const Axis a = Known(config, axis);
  return std::max(kSlowestFeed_mm_s, 1e3 * Path_m(a, a.t.frozen) / kShows_s);
}

double TellingFeed_mm_s(const MachineConfig& config, const AxisConfig& axis) {
  const Axis a = Known(config, axis);
  const double held_N = a.t.friction_N + a.t.external_N - a.monitored.Fc_N;
  return 1e3 * held_N / (a.t.loop_N_m * Answer_s(a));
}

WorstDeparture WorstDepartureOf(const MachineConfig& config, const AxisConfig& axis) {
  WorstDeparture worst;
  // Finer than what is printed: the worst feed is where a reading's step to rest is just not seen.
  std::vector<double> feeds{0.0, axis.limits.velocity_mm_s};
  for (double feed = PromisedFeed_mm_s(config, axis); feed < axis.limits.velocity_mm_s; feed *= 1.25)
    feeds.push_back(feed);
  for (const MotionFault fault : kMotionFaults)
    for (const double feed : feeds) {
      if (fault == MotionFault::kFlickers) continue;
      const FaultBound bound = BoundOf(config, axis, fault, feed);
      if (bound.departure_mm > worst.bound.departure_mm) worst = {bound, fault, feed};
    }
  return worst;
}

double CoastTravel_mm(const AxisConfig& axis) {
  const double held_N = -UnbornePushOf(axis.model).sliding_N;
  if (held_N <= 0.0) return std::numeric_limits<double>::infinity();
  const double speed_m_s = 1e-3 * axis.limits.velocity_mm_s;
  return 1e3 * 0.5 * ToSi(Extended(axis.model).mechanics).mass_kg * speed_m_s * speed_m_s / held_N;
}

}  // namespace contour
