#include "daemon/machine_buses.h"

#include <spdlog/spdlog.h>

#include <cstring>

#include "config/config_error.h"
#include "config/interfaces.h"
#include "drivers/can/loopback_bus.h"
#include "drivers/can/socketcan_bus.h"
#include "tools/machine/placements.h"

namespace contour {
namespace {

constexpr const char* kLoopback = "loopback";
/// One under way, and one behind it for what has come since.
constexpr std::size_t kDrainsWaiting = 2;

std::size_t LoopbackCount(const MachineConfig& machine) {
  std::size_t count = 0;
  for (const auto& [name, bus] : machine.buses) count += bus.interface == kLoopback ? 1U : 0U;
  return count;
}

std::vector<int> NodesOn(const MachineConfig& machine, const std::string& bus) {
  std::vector<int> nodes;
  for (const auto& [name, axis] : machine.axes)
    if (axis.drive.bus == bus) nodes.push_back(axis.drive.node_id);
  return nodes;
}

}  // namespace

MachineBuses::MachineBuses(const MachineConfig& machine, const std::optional<EmulatorConfig>& emulator,
                           const std::string& truth_file) {
  const std::size_t loopbacks = LoopbackCount(machine);
  if (loopbacks != 0 && loopbacks != machine.buses.size())
    throw ConfigError(
        {"buses: some are loopback and some are not; expected all or none, the emulated machine is one"});
  if (loopbacks == 0) {
    if (!truth_file.empty())
      throw ConfigError(
          {"--truth: only the in-process emulated machine (bus loopback) tells its truth here; expected "
           "--truth "
           "at `contour emulate`"});
    RequireInterfaces(machine);
    for (const auto& [name, bus] : machine.buses) {
      all_virtual_ = all_virtual_ && IsVirtualCan(bus.interface);
      locks_.push_back(std::make_unique<InterfaceLock>(bus.interface));
      buses_.push_back(std::make_unique<SocketCanBus>(bus.interface, NodesOn(machine, name)));
      pointers_.push_back(buses_.back().get());
    }
    return;
  }
  if (!emulator)
    throw ConfigError({"buses: loopback needs the section emulator: in the machine file; found none"});
  emulated_ = std::make_unique<EmulatedMachine>(*emulator, EmulatedPlacements(machine),
                                                static_cast<std::uint32_t>(machine.machine.cycle_us));
  if (emulator->io) io_server_ = std::make_unique<ModbusIoServer>(*emulator->io);
  if (!truth_file.empty()) {
    relay_ = std::make_shared<TruthRelay>(truth_file, AxisNames(machine));
    truth_lane_ = std::make_unique<SlowLane>("contour-truth", SlowLane::Limits{kDrainsWaiting, {}});
    emulated_->SetTruthSink(relay_.get());
  }
  std::size_t index = 0;
  for (const auto& [name, bus] : machine.buses) {
    std::vector<BusNode*> nodes;
    if (index < emulated_->bus_count()) nodes.push_back(&emulated_->node(index));
    // Of SYNC it tells nothing: the plant is stepped by it, as if none came late.
    buses_.push_back(std::make_unique<LoopbackBus>(bus.bitrate_bit_s, std::move(nodes)));
    pointers_.push_back(buses_.back().get());
    ++index;
  }
}

MachineBuses::~MachineBuses() {
  if (emulated_) emulated_->SetTruthSink(nullptr);
}

bool MachineBuses::FinishTruth(std::chrono::steady_clock::time_point deadline) {
  DrainTruth();
  return !truth_lane_ || truth_lane_->Finish(deadline);
}

void MachineBuses::DrainTruth() {
  // While the file takes nothing, rows wait with the relay; one look at it is enough then.
  if (relay_) truth_lane_->Post(1, [relay = relay_] { relay->Drain(); });
  if (relay_ && relay_->lost() != reported_lost_) {
    reported_lost_ = relay_->lost();
    spdlog::warn("{} rows of truth were lost, in all", reported_lost_);
  }
  if (relay_ && relay_->error() != 0 && !reported_failure_) {
    reported_failure_ = true;
    spdlog::warn("cannot write the truth: {}; it ends here", std::strerror(relay_->error()));
  }
}

}  // namespace contour
