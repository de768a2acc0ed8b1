#include "drivers/cia402/bus_layout.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>

#include "drivers/cia301/messages.h"
#include "drivers/cia402/drive_script.h"
#include "drivers/cia402/pdo_layout.h"

namespace contour {
namespace {

constexpr std::int64_t kSdoPeriod_ns = 2'000'000;  // one transfer every other millisecond at most
constexpr std::int64_t kShortestEmergency_ns = 10'000'000;

std::int64_t Ns(double us) noexcept { return std::llround(us * 1000.0); }
double Us(std::int64_t ns) noexcept { return static_cast<double>(ns) / 1000.0; }

std::uint16_t Id(std::uint16_t base, int node) noexcept { return static_cast<std::uint16_t>(base + node); }

bool IsCyclic(const CanMessage& m) noexcept {
  return m.id == cob::kSync || (m.id > cob::kTpdo1 && m.id < cob::kSdoReply);
}
bool IsRpdo(const CanMessage& m) noexcept { return m.id > cob::kRpdo1 && m.id < cob::kRpdo1 + 0x80; }
bool IsTpdo(const CanMessage& m) noexcept { return IsCyclic(m) && !IsRpdo(m) && m.id != cob::kSync; }

std::optional<double> Worst(std::span<const CanMessage> messages, bool (*of)(const CanMessage&),
                            std::uint32_t bitrate) {
  std::int64_t worst = 0;
  for (std::size_t i = 0; i < messages.size(); ++i) {
    if (!of(messages[i])) continue;
    const std::optional<std::int64_t> response = ResponseTime_ns(messages, i, bitrate);
    if (!response) return std::nullopt;
    worst = std::max(worst, *response);
  }
  return Us(worst);
}

BusResponse Respond(std::span<const BusDrive> drives, const BusConfig& bus, std::uint32_t cycle_us,
                    std::size_t emergencies) {
  const std::vector<CanMessage> messages = BusMessages(drives, bus, cycle_us, emergencies);
  BusResponse r;
  r.tpdo_us = Worst(messages, IsTpdo, bus.bitrate_bit_s);
  r.rpdo_us = Worst(messages, IsRpdo, bus.bitrate_bit_s);
  if (r.rpdo_us) r.computing_us = cycle_us - *r.rpdo_us;
  return r;
}

/// Time from handing over the batch to the end of its SYNC, and to the last TPDO. The master's queue is first
/// in first out: its RPDOs and SYNC go before any TPDO whatever the identifiers, and nothing of it but the
/// RPDOs delays the SYNC. A lower frame may just have begun; another may slip in while the drives prepare
/// their TPDOs.
void Follow(std::span<const BusDrive> drives, const BusConfig& bus, std::uint32_t cycle_us,
            std::size_t emergencies, double& batch_us, double& feedback_us) {
  std::int64_t lower_ns = 0;
  std::int64_t batch_ns = 0;
  std::int64_t answers_ns = 0;
  for (const CanMessage& m : BusMessages(drives, bus, cycle_us, emergencies)) {
    const std::int64_t time_ns = TransmissionTime_ns(m, bus.bitrate_bit_s);
    if (IsRpdo(m) || m.id == cob::kSync) {
      batch_ns += time_ns;
    } else if (IsTpdo(m)) {
      answers_ns += time_ns;
    } else if (m.id < cob::kTpdo1) {
      batch_ns += time_ns;  // an emergency message
    } else {
      lower_ns = std::max(lower_ns, time_ns);
    }
  }
  double delay_us = 0.0;
  for (const BusDrive& d : drives) delay_us = std::max(delay_us, d.drive.tpdo_delay_us);
  batch_us = Us(lower_ns + batch_ns);
  feedback_us = batch_us + Us(answers_ns) + (delay_us > 0.0 ? delay_us + Us(lower_ns) : 0.0);
}

std::string Fixed(double value, int decimals) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

std::string Verdict(const BusAnalysis& a, std::uint32_t cycle_us, double send_deadline_us) {
  if (a.total_load >= 1.0) {
    return "the bus is overloaded: its messages take " + Fixed(100.0 * a.total_load, 1) +
           " % of it (SYNC and PDOs alone " + Fixed(100.0 * a.load, 1) + " %) at a cycle of " +
           std::to_string(cycle_us) + " us; use a longer cycle, more buses or a higher bit rate";
  }
  const std::string when = Fixed(a.feedback_latest_us, 0) + " us after the grid point (frames sent by " +
                           Fixed(send_deadline_us, 0) + " us)";
  if (!a.holds) {
    return "feedback can arrive " + when + ", later than the next grid point at " + std::to_string(cycle_us) +
           " us; use a longer cycle, more buses, a higher bit rate or a shorter send_deadline_us";
  }
  return "feedback arrives at the latest " + when + ", before the next one at " + std::to_string(cycle_us) +
         " us";
}

}  // namespace

std::vector<CanMessage> BusMessages(std::span<const BusDrive> drives, const BusConfig& bus,
                                    std::uint32_t cycle_us, std::size_t emergencies) {
  const std::int64_t cycle_ns = std::int64_t{cycle_us} * 1000;
  std::vector<CanMessage> messages{{"SYNC", cob::kSync, 0, cycle_ns, 0}};
  double notice_ms = 1e9;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const DriveConfig& d = drives[i].drive;
    const std::string& name = drives[i].axis;
    const std::int64_t emergency_ns = std::max(kShortestEmergency_ns, Ns(d.emergency_inhibit_ms * 1000.0));
    if (i < emergencies)
      messages.push_back({"EMCY " + name, Id(cob::kEmergency, d.node_id), 8, emergency_ns, 0});
    messages.push_back({"RPDO1 " + name, Id(cob::kRpdo1, d.node_id), PdoLength(RpdoMapping(d)), cycle_ns, 0});
    messages.push_back({"TPDO1 " + name, Id(cob::kTpdo1, d.node_id), PdoLength(kTpdoFeedback), cycle_ns, 0});
    if (d.linear_scale) {
      messages.push_back(
          {"TPDO2 " + name, Id(cob::kTpdo1 + 0x100, d.node_id), PdoLength(kTpdoScale), cycle_ns, 0});
    }
    messages.push_back(
        {"heartbeat " + name, Id(cob::kHeartbeat, d.node_id), 1, Ns(d.heartbeat_ms * 1000.0), 0});
    notice_ms = std::min(notice_ms, d.notice_ms);
  }
  if (!drives.empty()) {
    // One client: a request and its reply in turn, whichever node it talks to.
    messages.push_back({"SDO reply", Id(cob::kSdoReply, drives[0].drive.node_id), 8, kSdoPeriod_ns, 0});
    messages.push_back({"SDO request", Id(cob::kSdoRequest, drives[0].drive.node_id), 8, kSdoPeriod_ns, 0});
    const auto heartbeat_cycles = static_cast<std::int64_t>(MasterHeartbeatCycles(notice_ms, cycle_us));
    messages.push_back({"heartbeat of the master", Id(cob::kHeartbeat, bus.master_node_id), 1,
                        heartbeat_cycles * cycle_ns, 0});
  }
  return messages;
}

BusAnalysis AnalyseBus(std::span<const BusDrive> drives, const BusConfig& bus, std::uint32_t cycle_us,
                       double send_deadline_us) {
  BusAnalysis a;
  const std::vector<CanMessage> all = BusMessages(drives, bus, cycle_us, drives.size());
  std::vector<CanMessage> cyclic;
  std::copy_if(all.begin(), all.end(), std::back_inserter(cyclic), IsCyclic);
  a.load = Load(cyclic, bus.bitrate_bit_s);
  a.total_load = Load(all, bus.bitrate_bit_s);
  a.quiet = Respond(drives, bus, cycle_us, 0);
  a.one_emergency = Respond(drives, bus, cycle_us, 1);
  a.all_emergencies = Respond(drives, bus, cycle_us, drives.size());

  Follow(drives, bus, cycle_us, 0, a.batch_us, a.feedback_us);
  a.feedback_latest_us = send_deadline_us + a.feedback_us;
  for (std::size_t n = 0; n <= drives.size(); ++n) {
    double batch_us = 0.0;
    double feedback_us = 0.0;
    Follow(drives, bus, cycle_us, n, batch_us, feedback_us);
    if (send_deadline_us + feedback_us >= cycle_us) break;
    a.emergencies_carried = static_cast<int>(n);
  }
  a.holds = a.emergencies_carried >= 0 && a.total_load < 1.0;

  a.verdict = Verdict(a, cycle_us, send_deadline_us);
  return a;
}

}  // namespace contour
