#include "config/bus_timing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "drivers/can/response_time.h"
#include "drivers/cia301/messages.h"
#include "drivers/cia402/drive_patrol.h"
#include "drivers/cia402/drive_script.h"
#include "drivers/cia402/mode_for.h"
#include "drivers/cia402/pdo_layout.h"

namespace contour {
namespace {

// One expedited transfer in this time: what the master asks of running drives, which is no more often, and
// tools beside it while it is silent.
constexpr std::int64_t kSdoPeriod_ns = 1000 * std::int64_t{kPatrolGap_us};

enum class Kind { kCyclic, kBackground, kEmergency };

struct Planned {
  CanMessage message;
  Kind kind = Kind::kCyclic;
};

std::uint16_t Id(std::uint16_t base, int node) { return static_cast<std::uint16_t>(base + node); }

std::int64_t Ms_ns(double ms) { return std::max<std::int64_t>(1, std::llround(ms * 1e6)); }

void PlanDrive(const std::string& name, DriveConfig drive, ControllerName controller, std::int64_t cycle_ns,
               std::vector<Planned>& plan) {
  drive.mode = ModeFor(controller, drive);
  const int node = drive.node_id;
  const std::int64_t emergency_ns = std::max(cycle_ns, Ms_ns(drive.emergency_inhibit_ms));
  plan.push_back({{name + " emergency", Id(cob::kEmergency, node), 8, emergency_ns, 0}, Kind::kEmergency});
  plan.push_back(
      {{name + " feedback (TPDO1)", Id(cob::kTpdo1, node), kFeedbackLength, cycle_ns, 0}, Kind::kCyclic});
  if (drive.linear_scale)
    plan.push_back(
        {{name + " scale (TPDO2)", Id(cob::kTpdo1 + 0x100, node), kScaleLength, cycle_ns, 0}, Kind::kCyclic});
  plan.push_back(
      {{name + " set-point (RPDO1)", Id(cob::kRpdo1, node), PdoLength(RpdoMapping(drive)), cycle_ns, 0},
       Kind::kCyclic});
  plan.push_back(
      {{name + " heartbeat", Id(cob::kHeartbeat, node), 1, Ms_ns(drive.heartbeat_ms), 0}, Kind::kBackground});
}

std::vector<Planned> PlanBus(const MachineConfig& config, const std::string& bus_name, const BusConfig& bus) {
  const std::int64_t cycle_ns = 1000 * std::int64_t{config.machine.cycle_us};
  const auto cycle_us = static_cast<std::uint32_t>(config.machine.cycle_us);
  std::vector<Planned> plan;
  plan.push_back({{"SYNC", cob::kSync, 0, cycle_ns, 0}, Kind::kCyclic});
  std::uint64_t heartbeat_cycles = 0;
  int first_node = 0;
  for (const auto& [name, axis] : config.axes) {
    if (axis.drive.bus != bus_name) continue;
    PlanDrive(name, axis.drive, config.machine.controller, cycle_ns, plan);
    const std::uint64_t cycles = MasterHeartbeatCycles(axis.drive.notice_ms, cycle_us);
    heartbeat_cycles = heartbeat_cycles == 0 ? cycles : std::min(heartbeat_cycles, cycles);
    first_node = first_node == 0 ? axis.drive.node_id : first_node;
  }
  if (first_node == 0) return {};
  plan.push_back({{"SDO reply", Id(cob::kSdoReply, first_node), 8, kSdoPeriod_ns, 0}, Kind::kBackground});
  plan.push_back({{"SDO request", Id(cob::kSdoRequest, first_node), 8, kSdoPeriod_ns, 0}, Kind::kBackground});
  plan.push_back({{"master heartbeat", Id(cob::kHeartbeat, bus.master_node_id), 1,
                   static_cast<std::int64_t>(heartbeat_cycles) * cycle_ns, 0},
                  Kind::kBackground});
  std::sort(plan.begin(), plan.end(),
            [](const Planned& a, const Planned& b) { return a.message.id < b.message.id; });
  return plan;
}

std::vector<CanMessage> Pick(const std::vector<Planned>& plan, bool emergencies, bool cyclic_only) {
  std::vector<CanMessage> messages;
  for (const Planned& p : plan)
    if (p.kind == Kind::kCyclic || (!cyclic_only && (emergencies || p.kind != Kind::kEmergency)))
      messages.push_back(p.message);
  return messages;
}

std::optional<double> Response_us(const std::vector<CanMessage>& messages, std::uint16_t id,
                                  std::uint32_t bitrate) {
  for (std::size_t i = 0; i < messages.size(); ++i) {
    if (messages[i].id != id) continue;
    const std::optional<std::int64_t> response_ns = ResponseTime_ns(messages, i, bitrate);
    if (response_ns) return 1e-3 * static_cast<double>(*response_ns);
  }
  return std::nullopt;
}

template <class Member>
std::optional<double> Worst(const std::vector<BusMessage>& messages, Member member) {
  std::optional<double> worst = 0.0;
  for (const BusMessage& m : messages) {
    if (!m.cyclic) continue;
    if (!(m.*member)) return std::nullopt;
    worst = std::max(*worst, *(m.*member));
  }
  return worst;
}

BusTiming TimingOf(const MachineConfig& config, const std::string& name, const BusConfig& bus) {
  const std::vector<Planned> plan = PlanBus(config, name, bus);
  const std::vector<CanMessage> usual = Pick(plan, false, false);
  const std::vector<CanMessage> all = Pick(plan, true, false);
  BusTiming timing;
  timing.bus = name;
  timing.cyclic_load = Load(Pick(plan, false, true), bus.bitrate_bit_s);
  timing.load = Load(all, bus.bitrate_bit_s);
  for (const Planned& p : plan) {
    BusMessage m;
    m.name = p.message.name;
    m.id = p.message.id;
    m.length = p.message.length;
    m.period_ms = 1e-6 * static_cast<double>(p.message.period_ns);
    m.cyclic = p.kind == Kind::kCyclic;
    m.response_us = Response_us(usual, p.message.id, bus.bitrate_bit_s);
    m.response_with_emergencies_us = Response_us(all, p.message.id, bus.bitrate_bit_s);
    timing.messages.push_back(std::move(m));
  }
  timing.worst_us = Worst(timing.messages, &BusMessage::response_us);
  timing.worst_with_emergencies_us = Worst(timing.messages, &BusMessage::response_with_emergencies_us);
  return timing;
}

}  // namespace

std::vector<BusTiming> BusTimings(const MachineConfig& config) {
  std::vector<BusTiming> timings;
  for (const auto& [name, bus] : config.buses) timings.push_back(TimingOf(config, name, bus));
  return timings;
}

}  // namespace contour
