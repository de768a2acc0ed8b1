#include "daemon/telemetry/foreign_traffic.h"

#include <utility>

namespace contour {
namespace {

/// A tool that asks all the time is told of this rarely.
constexpr std::uint64_t kCyclesBetweenLines = 60'000;

}  // namespace

void ForeignTraffic::Watch(std::vector<BusParties> buses) {
  buses_.clear();
  for (BusParties& b : buses) {
    Bus bus;
    bus.name = std::move(b.name);
    bus.watch = MasterWatch(b.master_node_id);
    bus.ours.set(b.master_node_id & 0x7F);
    for (const std::uint8_t node : b.nodes) {
      bus.watch.Add(node);
      bus.ours.set(node & 0x7F);
    }
    bus.quiet_cycles = kCyclesBetweenLines;
    buses_.push_back(std::move(bus));
  }
}

void ForeignTraffic::Add(const CycleInput& in) {
  for (Bus& b : buses_) ++b.quiet_cycles;
  for (const StampedFrame& f : in.frames) {
    if (f.bus >= buses_.size()) continue;
    Bus& bus = buses_[f.bus];
    if (bus.watch.SignOf(f.frame) == MasterSign::kSdoRequest) ++bus.sdo_requests;
    const std::size_t node = f.frame.id & 0x7F;
    if ((f.frame.id & 0x780) == cob::kHeartbeat && node != 0 && !bus.ours.test(node)) bus.others.set(node);
  }
}

std::vector<std::uint8_t> ForeignTraffic::Nodes(const std::bitset<128>& set) {
  std::vector<std::uint8_t> nodes;
  for (std::size_t n = 0; n < set.size(); ++n)
    if (set.test(n)) nodes.push_back(static_cast<std::uint8_t>(n));
  return nodes;
}

std::vector<ForeignTraffic::OnBus> ForeignTraffic::summary() const {
  std::vector<OnBus> out;
  for (const Bus& b : buses_) out.push_back({b.sdo_requests, Nodes(b.others)});
  return out;
}

std::optional<std::string> ForeignTraffic::TakeMessage() {
  for (Bus& b : buses_) {
    if (b.sdo_requests != b.sdo_requests_told && b.quiet_cycles >= kCyclesBetweenLines) {
      b.quiet_cycles = 0;
      const std::uint64_t more = b.sdo_requests - std::exchange(b.sdo_requests_told, b.sdo_requests);
      return "bus " + b.name + ": somebody else asked our drives by SDO, " + std::to_string(more) +
             " requests (foreign_sdo); what a service tool writes may change how they stop";
    }
    if (b.others.count() != b.others_told) {
      b.others_told = b.others.count();
      std::string list;
      for (const std::uint8_t n : Nodes(b.others)) list += (list.empty() ? "" : ", ") + std::to_string(n);
      return "bus " + b.name + ": nodes that are none of this machine's drives send heartbeats: " + list;
    }
  }
  return std::nullopt;
}

}  // namespace contour
