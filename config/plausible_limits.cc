#include "config/plausible_limits.h"

#include <charconv>
#include <limits>
#include <optional>
#include <utility>

#include "config/number_text.h"
#include "config/stopping.h"
#include "core/horizon.h"
#include "core/path_room.h"
#include "core/stop_on_path.h"

namespace contour {
namespace {

// An axis in the middle of its stroke must have room for its safe travel twice over, on either side.
constexpr double kSafeTravelOfStroke = 0.25;
// Far below any programmed motion: a distance to the path that is a fault, not a motion of its own.
constexpr double kFollowingErrorOfStroke = 0.05;
// Noise of a few counts and the rounding of a target are no fault.
constexpr double kFollowingErrorInCounts = 10.0;
// What the I/O has not yet seen may use up no more than this.
constexpr double kBlindTravelOfStroke = 0.5;
// A drive that misses so many of its own heartbeats is gone.
constexpr double kMostMissedHeartbeats = 10.0;
// A quick stop that takes so many times its bound will not end; its shortest deadline is the default's.
constexpr double kQuickStopPatience = 10.0;
constexpr double kQuickStopAlwaysAllowed_ms = 1000.0;

using Problems = std::vector<ConfigProblem>;

std::string Say(double number) { return RoundedText(number); }

void Distances(const std::string& key, const AxisLimits& l, double stroke_mm, Problems& problems) {
  const std::string of_stroke = " of a stroke of " + Say(stroke_mm) + " mm";
  if (l.safe_travel_mm > kSafeTravelOfStroke * stroke_mm)
    problems.push_back(
        {key + ".limits.safe_travel_mm", "found " + Say(l.safe_travel_mm) + ", expected at most " +
                                             Say(kSafeTravelOfStroke * stroke_mm) + ", a quarter" +
                                             of_stroke + ": more keeps nothing from its end"});
  if (l.following_error_mm > kFollowingErrorOfStroke * stroke_mm)
    problems.push_back({key + ".limits.following_error_mm",
                        "found " + Say(l.following_error_mm) + ", expected at most " +
                            Say(kFollowingErrorOfStroke * stroke_mm) + ", a twentieth" + of_stroke});
  else if (l.following_error_mm > l.safe_travel_mm)
    problems.push_back({key + ".limits.following_error_mm",
                        "found " + Say(l.following_error_mm) + ", expected at most safe_travel_mm " +
                            Say(l.safe_travel_mm) + ": an axis off its path is to be stopped within that"});
}

void Counts(const std::string& key, const AxisConfig& axis, Problems& problems) {
  const double least_mm =
      kFollowingErrorInCounts * axis.model.mechanics.lead_mm / axis.drive.encoder_counts_per_rev;
  if (axis.limits.following_error_mm < least_mm)
    problems.push_back({key + ".limits.following_error_mm",
                        "found " + NumberText(axis.limits.following_error_mm) + ", expected at least " +
                            Say(least_mm) + ", ten counts of the encoder: below, standing still is a fault"});
}

// `quick_stop_ms`: 0 where nothing stops the axis, which is refused elsewhere.
void Deadlines(const std::string& key, const DriveConfig& d, double quick_stop_ms, Problems& problems) {
  if (d.heartbeat_timeout_ms > kMostMissedHeartbeats * d.heartbeat_ms)
    problems.push_back({key + ".drive.heartbeat_timeout_ms",
                        "found " + Say(d.heartbeat_timeout_ms) + ", expected at most " +
                            Say(kMostMissedHeartbeats * d.heartbeat_ms) +
                            ", ten times heartbeat_ms: a drive that is gone is to be noticed"});
  if (quick_stop_ms <= 0.0) return;
  const double most_ms = kQuickStopAlwaysAllowed_ms + kQuickStopPatience * quick_stop_ms;
  if (d.quick_stop_ms > most_ms)
    problems.push_back({key + ".drive.quick_stop_ms",
                        "found " + Say(d.quick_stop_ms) + ", expected at most " + Say(most_ms) +
                            ": the quick stop of this axis takes " + Say(quick_stop_ms) + " ms"});
  if (d.quick_stop_ms < quick_stop_ms)
    problems.push_back(
        {key + ".drive.quick_stop_ms",
         "found " + Say(d.quick_stop_ms) + ", expected at least " + Say(quick_stop_ms) +
             ", which the quick stop of this axis takes: the voltage would go before its end"});
}

// What the emergency-stop and enable inputs promise is worth the travel until they have been seen and obeyed.
void BlindTravel(const std::string& axis, const ModbusConfig& modbus, const StoppingAxis& s, double stroke_mm,
                 Problems& problems) {
  const double blind_ms = modbus.poll_ms + modbus.timeout_ms;
  const double travel_mm =
      s.speed_m_s * blind_ms + (s.Deceleration_m_s2() > 0.0 ? QuickStop(s, s.speed_m_s, 0.0).travel_mm : 0.0);
  if (travel_mm > kBlindTravelOfStroke * stroke_mm)
    problems.push_back({"io.modbus.timeout_ms",
                        "found " + Say(modbus.timeout_ms) + " with poll_ms " + Say(modbus.poll_ms) +
                            ": an emergency stop is seen up to " + Say(blind_ms) + " ms late, and axis '" +
                            axis + "' goes " + Say(travel_mm) + " mm until it stands; expected at most " +
                            Say(kBlindTravelOfStroke * stroke_mm) +
                            ", half its stroke, or accept_blind_travel: true"});
}

// Value of `ttl` in an LCM address, "udpm://group:port?ttl=1"; none when it is not there, -1 when it is no
// number.
std::optional<int> TimeToLive(const std::string& url) {
  std::size_t at = url.find('?');
  while (at != std::string::npos) {
    const std::size_t end = url.find('&', at + 1);
    const std::string option = url.substr(at + 1, end == std::string::npos ? end : end - at - 1);
    if (option.starts_with("ttl=")) {
      int value = -1;
      const auto [rest, error] = std::from_chars(option.data() + 4, option.data() + option.size(), value);
      return error == std::errc() && rest == option.data() + option.size() && value >= 0 ? value : -1;
    }
    at = end;
  }
  return std::nullopt;
}

/// The cycle keeps so many points of the path, and has to come to rest on those.
void PathStops(const std::string& key, const AxisLimits& limits, double period_s, Problems& problems) {
  constexpr double kUnlimited = std::numeric_limits<double>::infinity();
  const double most_s = MostRamp_periods(kMaxHorizonPoints) * period_s;
  const double takes_s =
      stop_on_path::RampTime_s(limits.velocity_mm_s, limits.acceleration_mm_s2, limits.jerk_mm_s3);
  if (takes_s <= most_s) return;
  const bool jerk =
      takes_s > stop_on_path::RampTime_s(limits.velocity_mm_s, limits.acceleration_mm_s2, kUnlimited);
  const double share = takes_s / most_s;
  problems.push_back(
      {key + ".limits." + (jerk ? "jerk_mm_s3" : "acceleration_mm_s2"),
       "found " + RoundedText(jerk ? limits.jerk_mm_s3 : limits.acceleration_mm_s2) +
           ", with which a stop on the path from " + RoundedText(limits.velocity_mm_s) + " mm/s takes " +
           RoundedText(takes_s) + " s, expected at least " +
           RoundedText(jerk ? limits.jerk_mm_s3 * share * share : limits.acceleration_mm_s2 * share) + ": " +
           RoundedText(most_s) +
           " s are what the cycle keeps points of the path for; a lower velocity_mm_s or a longer "
           "machine.cycle_us would do, too"});
}

}  // namespace

std::vector<ConfigProblem> ImplausibleLimits(const MachineConfig& machine, const std::string& axis) {
  Problems problems;
  const AxisConfig& config = machine.axes.at(axis);
  const AxisLimits& limits = config.limits;
  const double stroke_mm = limits.position_mm[1] - limits.position_mm[0];
  if (!(stroke_mm > 0.0)) return problems;  // refused elsewhere
  const std::string key = "axes." + axis;
  const StoppingAxis s = ToStoppingAxis(machine, config);
  Distances(key, limits, stroke_mm, problems);
  Counts(key, config, problems);
  PathStops(key, limits, s.period_s, problems);
  Deadlines(key, config.drive,
            s.Deceleration_m_s2() > 0.0
                ? 1e3 * QuickStop(s, machine.control.guard.overspeed_factor * s.speed_m_s, 0.0).time_s
                : 0.0,
            problems);
  if (machine.io.modbus && !machine.io.modbus->accept_blind_travel)
    BlindTravel(axis, *machine.io.modbus, s, stroke_mm, problems);
  return problems;
}

std::vector<ConfigProblem> ImplausibleTelemetry(const TelemetryConfig& telemetry) {
  const std::optional<int> ttl = TimeToLive(telemetry.lcm_url);
  if (!telemetry.publish || !ttl) return {};
  if (*ttl < 0 || *ttl > 255)
    return {{"telemetry.lcm_url", "found '" + telemetry.lcm_url + "', expected a ttl from 0 to 255"}};
  if (*ttl > 1 && !telemetry.leave_network)
    return {{"telemetry.lcm_url",
             "found ttl=" + std::to_string(*ttl) +
                 ", expected 0 (this computer) or 1 (this network): above, routers pass the packets on; "
                 "telemetry.leave_network: true allows it"}};
  return {};
}

}  // namespace contour
