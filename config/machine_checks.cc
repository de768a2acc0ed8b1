#include "config/machine_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <utility>

#include "config/bus_timing.h"
#include "config/emergency_checks.h"
#include "config/key_table.h"
#include "config/loop_checks.h"
#include "config/motion_bounds.h"
#include "config/name_checks.h"
#include "config/number_text.h"
#include "config/plausible_limits.h"
#include "config/stated_push.h"
#include "config/stopping.h"
#include "core/cycle_input.h"
#include "core/mechanics.h"
#include "drivers/cia402/drive_script.h"
#include "drivers/cia402/mode_for.h"

namespace contour {
namespace {

class Problems {
 public:
  void Add(std::string key, std::string message) { list_.push_back({std::move(key), std::move(message)}); }
  [[nodiscard]] bool empty() const { return list_.empty(); }
  std::vector<ConfigProblem> Take() { return std::move(list_); }

 private:
  std::vector<ConfigProblem> list_;
};

std::string Say(double number) { return RoundedText(number); }

std::string Under(const std::string& key, std::string_view sub) {
  return key.empty() ? std::string(sub) : key + "." + std::string(sub);
}

void CheckSizes(const MachineConfig& c, Problems& problems) {
  if (c.axes.empty()) problems.Add("axes", "found no axis, expected at least one");
  if (c.axes.size() > kMaxAxes)
    problems.Add("axes", "found " + std::to_string(c.axes.size()) + " axes, expected at most " +
                             std::to_string(kMaxAxes));
  if (c.buses.empty()) problems.Add("buses", "found no bus, expected at least one");
  if (c.buses.size() > kMaxBuses)
    problems.Add("buses", "found " + std::to_string(c.buses.size()) + " buses, expected at most " +
                              std::to_string(kMaxBuses));
}

void CheckTiming(const MachineConfig& c, Problems& problems) {
  try {
    std::ignore = ToInterpolationPeriod(static_cast<std::uint32_t>(c.machine.cycle_us));
  } catch (const std::invalid_argument& e) {
    problems.Add("machine.cycle_us", e.what());
  }
  if (SendDeadline_ns(c) >= 1000 * std::int64_t{c.machine.cycle_us})
    problems.Add("realtime.send_deadline_us", "found " + std::to_string(SendDeadline_ns(c) / 1000) +
                                                  ", expected less than the cycle of " +
                                                  std::to_string(c.machine.cycle_us) + " us");
}

void CheckBuses(const MachineConfig& c, Problems& problems) {
  std::map<std::string, std::string> bus_of_interface;
  for (const auto& [name, bus] : c.buses) {
    const std::string key = "buses." + name;
    const double least_ms = 3e-3 * c.machine.cycle_us;
    if (bus.listen_ms != 0.0 && bus.listen_ms < least_ms)
      problems.Add(key + ".listen_ms", "found " + Say(bus.listen_ms) + ", expected at least three cycles, " +
                                           Say(least_ms) +
                                           " ms, to see the SYNC of another master, or 0 to hear nothing");
    if (bus.interface.empty())
      problems.Add(key + ".interface", "found nothing, expected the name of an interface");
    if (bus.interface == "loopback") continue;
    // IFNAMSIZ leaves 15 characters.
    if (bus.interface.size() > 15)
      problems.Add(key + ".interface",
                   "found '" + bus.interface + "', longer than a Linux interface name can be");
    const auto [other, inserted] = bus_of_interface.emplace(bus.interface, name);
    if (!inserted)
      problems.Add(key + ".interface", "found '" + bus.interface + "', already the interface of bus '" +
                                           other->second + "'; each bus needs its own");
  }
}

// Within a cycle all frames of that cycle must be through: RPDOs and SYNC go out at the grid point, the
// answers to SYNC are wanted at the next one. An emergency message may make one answer late; a fault follows
// it anyway.
void CheckBusTiming(const MachineConfig& c, Problems& problems) {
  const double cycle_us = c.machine.cycle_us;
  const double deadline_us = 1e-3 * static_cast<double>(SendDeadline_ns(c));
  for (const BusTiming& t : BusTimings(c)) {
    if (t.messages.empty()) {
      problems.Add("buses." + t.bus, "found a bus with no drive on it");
      continue;
    }
    const std::string rate = Say(c.buses.at(t.bus).bitrate_bit_s) + " bit/s";
    if (t.cyclic_load > 1.0)
      problems.Add("buses." + t.bus, "bus overload at this cycle: the frames of a cycle take " +
                                         Say(1e2 * t.cyclic_load) + " % of " + Say(cycle_us) + " us at " +
                                         rate);
    else if (!t.worst_us || *t.worst_us > cycle_us)
      problems.Add("buses." + t.bus, "bus overload at this cycle: a frame of a cycle takes up to " +
                                         (t.worst_us ? Say(*t.worst_us) + " us" : "for ever") +
                                         ", expected at most " + Say(cycle_us) + " us (" + rate + ", load " +
                                         Say(1e2 * t.load) + " %)");
    else if (*t.worst_us + deadline_us > cycle_us && deadline_us < cycle_us)
      problems.Add("realtime.send_deadline_us", "found " + Say(deadline_us) + " us, expected at most " +
                                                    Say(cycle_us - *t.worst_us) + " us: frames of bus '" +
                                                    t.bus + "' take up to " + Say(*t.worst_us) +
                                                    " us, and feedback must be in at the next grid point");
  }
}

void CheckNodes(const MachineConfig& c, Problems& problems) {
  std::map<std::pair<std::string, int>, std::string> user;
  for (const auto& [name, axis] : c.axes) {
    const std::string key = "axes." + name + ".drive";
    const auto bus = c.buses.find(axis.drive.bus);
    if (bus == c.buses.end()) {
      std::string known;
      for (const std::string& b : BusNames(c)) known += (known.empty() ? "" : ", ") + b;
      problems.Add(key + ".bus", "found '" + axis.drive.bus + "', expected a bus of this file: " + known);
      continue;
    }
    const std::string node = std::to_string(axis.drive.node_id);
    const auto [other, inserted] = user.emplace(std::pair{axis.drive.bus, axis.drive.node_id}, name);
    if (!inserted)
      problems.Add(key + ".node_id", "duplicate node: found " + node + ", already the node of axis '" +
                                         other->second + "' on bus '" + axis.drive.bus + "'");
    if (axis.drive.node_id == bus->second.master_node_id)
      problems.Add(key + ".node_id", "found " + node + ", which is the master's own node on bus '" +
                                         axis.drive.bus + "' (master_node_id)");
  }
}

void CheckMode(const MachineConfig& c, const std::string& key, const DriveConfig& d, Problems& problems) {
  const ControllerName controller = c.machine.controller;
  const DriveMode mode = ModeFor(controller, d);
  if (d.mode == DriveMode::kCsp && mode != DriveMode::kCsp)
    problems.Add(key + ".mode", "found csp, but machine.controller " + std::string(Name(controller)) +
                                    " gives torques; expected cst");
  const auto& [first_name, first] = *c.axes.begin();
  if (const DriveMode other = ModeFor(controller, first.drive); mode != other)
    problems.Add(key + ".mode", "found " + std::string(Name(mode)) + ", but axis '" + first_name + "' has " +
                                    std::string(Name(other)) + "; expected one mode for all axes");
  const bool sends_friction = controller == ControllerName::kFull || controller == ControllerName::kCnc;
  if (sends_friction && mode == DriveMode::kCsp && !d.csp_torque_offset)
    problems.Add(key + ".csp_torque_offset",
                 "found false, but machine.controller " + std::string(Name(controller)) +
                     " sends friction as torque offset in mode csp; expected true");
  if (c.control.csp.torque_offset && !d.csp_torque_offset)
    problems.Add(key + ".csp_torque_offset",
                 "found false, but control.csp.torque_offset is true; expected true");
}

// The encoder does not see the table: what it learns is not what the table needs.
void CheckLearning(const MachineConfig& c, const std::string& key, const DriveConfig& d, Problems& problems) {
  if (c.learning.enabled && !d.linear_scale)
    problems.Add(key + ".linear_scale",
                 "found none, but learning.enabled is true; expected a scale on every axis");
}

void CheckDrive(const std::string& key, const DriveConfig& d, double period_ms, Problems& problems) {
  // 0x6085 is an UNSIGNED32 in counts/s^2.
  const double most_rad_s2 =
      2.0 * std::numbers::pi * std::numeric_limits<std::uint32_t>::max() / d.encoder_counts_per_rev;
  if (d.quick_stop_deceleration_rad_s2 > most_rad_s2)
    problems.Add(key + ".quick_stop_deceleration_rad_s2",
                 "found " + Say(d.quick_stop_deceleration_rad_s2) + ", expected at most " + Say(most_rad_s2) +
                     ", the most that 0x6085 can carry with this encoder");
  if (d.peak_torque_Nm < d.rated_torque_Nm)
    problems.Add(
        key + ".peak_torque_Nm",
        "found " + Say(d.peak_torque_Nm) + ", expected at least rated_torque_Nm " + Say(d.rated_torque_Nm));
  if (d.heartbeat_timeout_ms <= d.heartbeat_ms)
    problems.Add(
        key + ".heartbeat_timeout_ms",
        "found " + Say(d.heartbeat_timeout_ms) + ", expected more than heartbeat_ms " + Say(d.heartbeat_ms));
  if (d.notice_ms < 2.0 * period_ms)
    problems.Add(key + ".notice_ms", "found " + Say(d.notice_ms) + ", expected at least two cycles, " +
                                         Say(2.0 * period_ms) + " ms, or one lost frame stops the machine");
  // Bit 7 turns positions round, bit 6 velocities; the others are reserved. Both go to and from the drive.
  constexpr int kBoth = 0xC0;
  if (d.polarity != 0 && d.polarity != kBoth)
    problems.Add(key + ".polarity",
                 "found " + std::to_string(d.polarity) +
                     ", expected 0, or 192: bits 7 (position) and 6 (velocity) of 0x607E together, no other");
  if (d.polarity == kBoth && d.mode == DriveMode::kCst)
    problems.Add(
        key + ".polarity",
        "found 192 in torque mode (cst), expected 0: 0x607E turns positions and velocities and not the "
        "torque, so that the loop would run away. Turn the axis round in the drive's own setting "
        "or in the wiring, or use drive.mode: csp");
  if (d.abort_connection_option != 3)
    problems.Add(
        key + ".abort_connection_option",
        "found " + std::to_string(d.abort_connection_option) +
            ", expected 3 (quick stop): otherwise nothing bounds how far the axis goes when the master dies");
  if (d.quick_stop_option != 2)
    problems.Add(
        key + ".quick_stop_option",
        "found " + std::to_string(d.quick_stop_option) +
            ", expected 2 (quick-stop ramp, then off): no stopping distance can be promised otherwise");
}

void CheckLimits(const std::string& key, const AxisConfig& axis, Problems& problems) {
  const AxisLimits& l = axis.limits;
  if (!(l.position_mm[0] < l.position_mm[1]))
    problems.Add(key + ".limits.position_mm", "found an empty range, " + Say(l.position_mm[0]) + " to " +
                                                  Say(l.position_mm[1]) + ", expected the lower end first");
  if (l.torque_Nm > axis.drive.peak_torque_Nm)
    problems.Add(key + ".limits.torque_Nm", "found " + Say(l.torque_Nm) +
                                                ", more than the drive's peak_torque_Nm of " +
                                                Say(axis.drive.peak_torque_Nm));
  // 0x6071 is an INT16 in per mille of rated torque.
  if (l.torque_Nm > 32.767 * axis.drive.rated_torque_Nm)
    problems.Add(key + ".limits.torque_Nm",
                 "found " + Say(l.torque_Nm) + ", expected at most " +
                     Say(32.767 * axis.drive.rated_torque_Nm) +
                     ", the most a target torque (0x6071) can carry at this rated torque");
}

std::string AndThePush(double pushed_N) {
  return pushed_N > 0.0 ? " and the " + Say(pushed_N) + " N that model.extensions states" : "";
}

void CheckReserve(const std::string& key, const AxisConfig& axis, Problems& problems) {
  const AxisReserve r = Reserve(axis);
  const double radius_m_rad = r.radius_m_rad;
  if (radius_m_rad * r.pushed_N >= axis.limits.torque_Nm)
    problems.Add(key + ".limits.torque_Nm",
                 "found " + Say(axis.limits.torque_Nm) + ", expected more than " +
                     Say(radius_m_rad * r.pushed_N) +
                     ": that much model.extensions (constant_torque, cable_spring) states to push the table "
                     "besides friction, and the axis could not be moved against it");
  else if (r.needed_Nm > axis.limits.torque_Nm)
    problems.Add(key + ".limits.acceleration_mm_s2",
                 "impossible limit: found " + Say(axis.limits.acceleration_mm_s2) + ", which takes " +
                     Say(r.needed_Nm) + " Nm at " + Say(axis.limits.velocity_mm_s) +
                     " mm/s against friction" + AndThePush(r.pushed_N) + "; the torque limit of " +
                     Say(axis.limits.torque_Nm) + " Nm leaves " + Say(1e3 * r.available_m_s2) + " mm/s^2");
  const double jerk_rate_Nm_s = radius_m_rad * r.mass_kg * 1e-3 * axis.limits.jerk_mm_s3;
  if (axis.limits.torque_rate_Nm_s > 0.0 && jerk_rate_Nm_s > axis.limits.torque_rate_Nm_s)
    problems.Add(key + ".limits.jerk_mm_s3",
                 "impossible limit: found " + Say(axis.limits.jerk_mm_s3) + ", which takes " +
                     Say(jerk_rate_Nm_s) + " Nm/s; torque_rate_Nm_s is " + Say(axis.limits.torque_rate_Nm_s));
}

void CheckStopping(const MachineConfig& c, const std::string& key, const AxisConfig& axis,
                   Problems& problems) {
  const StoppingAxis s = ToStoppingAxis(c, axis);
  if (s.ramp_m_s2 <= 0.0) {
    problems.Add(
        key + ".drive.quick_stop_deceleration_rad_s2",
        "found 0 (the drive's own), expected a deceleration: no stopping distance can be promised otherwise");
    return;
  }
  // A push that takes its share of it is counted in the bounds, and warned of.
  const AxisReserve r = Reserve(axis);
  const double most_rad_s2 = axis.limits.torque_Nm / (r.radius_m_rad * r.radius_m_rad * r.mass_kg);
  if (axis.drive.quick_stop_deceleration_rad_s2 > most_rad_s2) {
    problems.Add(key + ".drive.quick_stop_deceleration_rad_s2",
                 "impossible limit: found " + Say(axis.drive.quick_stop_deceleration_rad_s2) +
                     ", the torque limit of " + Say(axis.limits.torque_Nm) + " Nm gives " + Say(most_rad_s2));
    return;
  }
  if (s.Deceleration_m_s2() <= 0.0) return;  // it cannot be held either
  const double travel_mm = SilentMaster(s, 0.0).travel_mm;
  if (travel_mm > axis.limits.safe_travel_mm)
    problems.Add(key + ".limits.safe_travel_mm",
                 "found " + Say(axis.limits.safe_travel_mm) + ", but from rest at the torque limit" +
                     (UnbornePushOf(axis.model).sliding_N > 0.0 ? AndThePush(r.pushed_N) + "," : "") +
                     " the axis goes " + Say(travel_mm) +
                     " mm until the drive notices a dead master (notice_ms " + Say(axis.drive.notice_ms) +
                     ") and has stopped");
}

// The same thresholds that watch the axis in the cycle say how far it can get before they act.
void CheckDepartures(const MachineConfig& c, const std::string& key, const AxisConfig& axis,
                     Problems& problems) {
  const WorstDeparture worst = WorstDepartureOf(c, axis);
  if (worst.bound.departure_mm <= axis.limits.safe_travel_mm) return;
  problems.Add(key + ".limits.safe_travel_mm",
               "found " + Say(axis.limits.safe_travel_mm) + ", but with the fault '" +
                   std::string(Name(worst.fault)) + "' at " + Say(worst.feed_mm_s) +
                   " mm/s the axis goes up to " + Say(worst.bound.departure_mm) +
                   " mm from its path until the torque is off. A finer encoder, a stiffer loop, or a smaller "
                   "following_error_mm, torque_Nm or external_force_N make that smaller; "
                   "limits.slowest_feed_mm_s says from which speed on it must hold");
}

// 0x6064 is an INT32, and an absolute encoder's count is taken as it is at every start: where it wraps within
// reach, it is read a whole wrap away.
void CheckEncoderRange(const std::string& key, const AxisConfig& axis, Problems& problems) {
  if (!axis.drive.absolute_encoder) return;
  const AxisLimits& l = axis.limits;
  const double counts_per_mm = axis.drive.encoder_counts_per_rev / axis.model.mechanics.lead_mm;
  const double farthest_mm =
      std::max(std::abs(l.position_mm[0]), std::abs(l.position_mm[1])) + l.safe_travel_mm;
  const double most_counts = std::numeric_limits<std::int32_t>::max();
  if (farthest_mm * counts_per_mm <= most_counts) return;
  problems.Add(key + ".limits.position_mm",
               "found a range that goes, with safe_travel_mm, to " + Say(farthest_mm) + " mm or " +
                   Say(farthest_mm * counts_per_mm) + " counts of the absolute encoder, expected at most " +
                   Say(most_counts / counts_per_mm) + " mm: its position (0x6064) wraps at " +
                   Say(most_counts) +
                   " counts to either side of its zero, and the axis would be taken to be " +
                   Say(2.0 * most_counts / counts_per_mm) +
                   " mm from where it stands. Let the drive count fewer per turn (0x608F and "
                   "drive.encoder_counts_per_rev), put its zero (0x607C) to the middle of the stroke, or "
                   "narrow limits.position_mm");
}

std::set<std::string> ParameterKeys() {
  std::set<std::string> keys;
  for (const KeyRow& row : DescribeKeys<ModelConfig>())
    if (row.key.find('[') == std::string::npos && row.key.find('<') == std::string::npos)
      keys.insert(row.key.substr(row.key.rfind('.') + 1));
  return keys;
}

void CheckTable(const std::string& key, const std::vector<double>& position_mm, std::size_t values,
                Problems& problems) {
  if (position_mm.empty() || position_mm.size() != values)
    problems.Add(key, "found " + std::to_string(position_mm.size()) + " positions and " +
                          std::to_string(values) + " values, expected as many of both, and at least one");
  for (std::size_t i = 1; i < position_mm.size(); ++i)
    if (!(position_mm[i] > position_mm[i - 1])) {
      problems.Add(Under(key, "position_mm"), "found " + Say(position_mm[i]) + " after " +
                                                  Say(position_mm[i - 1]) + ", expected them to ascend");
      return;
    }
}

void CheckExtensions(const std::string& key, const ExtensionsConfig& e, Problems& problems) {
  if (e.position_friction)
    CheckTable(Under(key, "position_friction"), e.position_friction->position_mm,
               e.position_friction->friction_rel.size(), problems);
  if (e.cable_spring)
    CheckTable(Under(key, "cable_spring"), e.cable_spring->position_mm, e.cable_spring->torque_Nm.size(),
               problems);
  if (e.pitch_error)
    CheckTable(Under(key, "pitch_error"), e.pitch_error->position_mm, e.pitch_error->error_um.size(),
               problems);
}

void CheckSideModes(const std::string& key, const std::vector<SideMode>& modes, Problems& problems) {
  double swinging = 0.0;
  for (const SideMode& mode : modes) swinging += mode.mass_share_rel;
  if (modes.size() > kMostSideModes)
    problems.Add(key, "found " + std::to_string(modes.size()) + ", expected at most " +
                          std::to_string(kMostSideModes) + ": those that hold the most mass");
  if (swinging > kMostSwinging)
    problems.Add(key, "found " + Say(swinging) + " of the table on springs, expected less than " +
                          Say(kMostSwinging) + ": what swings is none of the table that the screw drives");
}

void Append(std::vector<ConfigProblem> more, Problems& problems) {
  for (ConfigProblem& p : more) problems.Add(std::move(p.key), std::move(p.message));
}

}  // namespace

AxisReserve Reserve(const AxisConfig& axis) {
  const Mechanics m = ToSi(axis.model.mechanics);
  const Friction f = ToSi(axis.model.friction, m.radius_m_rad);
  AxisReserve r;
  r.radius_m_rad = m.radius_m_rad;
  r.mass_kg = m.mass_kg;
  r.friction_N = std::max(f.Fc_plus_N, f.Fc_minus_N) + f.sigma2_Ns_m * 1e-3 * axis.limits.velocity_mm_s;
  r.pushed_N = StatedPushOf(axis.model).size_N();
  const double against_N = r.friction_N + r.pushed_N;
  r.needed_Nm = m.radius_m_rad * (m.mass_kg * 1e-3 * axis.limits.acceleration_mm_s2 + against_N);
  r.available_m_s2 = std::max(0.0, (axis.limits.torque_Nm / m.radius_m_rad - against_N) / m.mass_kg);
  return r;
}

std::vector<ConfigProblem> Check(const ModelConfig& model, const std::string& key) {
  Problems problems;
  const Friction f = ToSi(model.friction, ToSi(model.mechanics).radius_m_rad);
  const std::string suffix = model.friction.acts_on == FrictionSide::kTable ? "_N" : "_Nm";
  for (const auto& [side, Fs_N, Fc_N] :
       {std::tuple{"plus", f.Fs_plus_N, f.Fc_plus_N}, std::tuple{"minus", f.Fs_minus_N, f.Fc_minus_N}}) {
    if (Fs_N < Fc_N)
      problems.Add(Under(key, std::string("friction.Fs_") + side + suffix),
                   std::string("found less than Fc_") + side + suffix +
                       ": break-away friction is never below Coulomb friction");
  }
  CheckExtensions(Under(key, "extensions"), model.extensions, problems);
  CheckSideModes(Under(key, "side_modes"), model.side_modes, problems);
  const std::set<std::string> known = ParameterKeys();
  for (const auto& [parameter, value] : model.uncertainty)
    if (!known.contains(parameter))
      problems.Add(Under(key, "uncertainty." + parameter), "found a key that is no parameter of this model");
  return problems.Take();
}

std::vector<ConfigProblem> Check(const MachineConfig& c) {
  Problems problems;
  CheckSizes(c, problems);
  Append(CheckNames(c), problems);
  CheckTiming(c, problems);
  CheckBuses(c, problems);
  CheckNodes(c, problems);
  CheckBusTiming(c, problems);
  for (const auto& [name, axis] : c.axes) {
    const std::string key = "axes." + name;
    CheckMode(c, key + ".drive", axis.drive, problems);
    CheckDrive(key + ".drive", axis.drive, c.machine.cycle_us * 1e-3, problems);
    CheckLearning(c, key + ".drive", axis.drive, problems);
    Append(CheckEmergencyReactions(axis.drive, key + ".drive"), problems);
    CheckLimits(key, axis, problems);
    CheckEncoderRange(key, axis, problems);
    CheckReserve(key, axis, problems);
    CheckStopping(c, key, axis, problems);
    Append(ImplausibleLimits(c, name), problems);
    Append(Check(axis.model, key + ".model"), problems);
  }
  Append(CheckLoops(c), problems);
  Append(ImplausibleTelemetry(c.telemetry), problems);
  if (c.io.modbus) {
    if (std::string text = Problem(*c.io.modbus); !text.empty()) problems.Add("io.modbus.timeout_ms", text);
    const IoOutputsConfig& outputs = c.io.modbus->outputs;
    if (outputs.program) {
      const std::string shared = SharedAddress(
          *outputs.program, outputs.lubrication ? std::optional(outputs.lubrication->coil) : std::nullopt);
      if (!shared.empty())
        problems.Add("io.modbus.outputs." + shared,
                     "another output has this address, expected one of its own");
      const auto& speed = outputs.program->spindle_speed;
      if (speed && speed->largest_rpm * speed->counts_per_rpm > std::numeric_limits<std::uint16_t>::max())
        problems.Add("io.modbus.outputs.program.spindle_speed.largest_rpm",
                     "its counts do not fit into a register of 16 bits, expected 65535 counts at most");
    }
    const auto& temperature = c.io.modbus->inputs.screw_temperature;
    if (temperature && temperature->degC_per_count == 0.0)
      problems.Add("io.modbus.inputs.screw_temperature.degC_per_count",
                   "found 0, expected what a count is worth: the temperature would never change");
  }
  // What else is wrong with a file makes these bounds meaningless.
  if (!problems.empty()) return problems.Take();
  for (const auto& [name, axis] : c.axes) CheckDepartures(c, "axes." + name, axis, problems);
  return problems.Take();
}

}  // namespace contour
