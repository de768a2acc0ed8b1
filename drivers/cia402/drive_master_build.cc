#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "drivers/cia402/drive_master.h"
#include "drivers/cia402/drive_script.h"
#include "drivers/cia402/drive_state.h"

// What a machine's drives are told of them, checked and sized before the first frame.
namespace contour {
namespace {

[[noreturn]] void Refuse(const AxisDriveConfig& axis, const std::string& what) {
  throw std::invalid_argument("axis " + axis.name + ": " + what);
}

void Check(const AxisDriveConfig& axis, const MasterConfig& config) {
  const DriveConfig& d = axis.drive;
  if (axis.bus >= config.buses.size()) Refuse(axis, "the drive's bus does not exist");
  if (d.node_id < 1 || d.node_id > 127) Refuse(axis, "node_id must be 1 to 127");
  if (d.node_id == config.buses[axis.bus].master_node_id) {
    Refuse(axis, "node_id " + std::to_string(d.node_id) + " is the master's own (master_node_id)");
  }
  if (!(d.rated_torque_Nm > 0.0)) Refuse(axis, "rated_torque_Nm must be greater than 0");
  if (d.encoder_counts_per_rev == 0) Refuse(axis, "encoder_counts_per_rev must not be 0");
  if (!(axis.torque_limit_Nm > 0.0)) Refuse(axis, "the torque limit must be greater than 0");
  if (axis.torque_limit_Nm > d.peak_torque_Nm) {
    Refuse(axis, "the torque limit of " + std::to_string(axis.torque_limit_Nm) +
                     " Nm exceeds peak_torque_Nm " + std::to_string(d.peak_torque_Nm));
  }
  if (axis.torque_limit_Nm > 32.0 * d.rated_torque_Nm) {
    Refuse(axis, "the torque limit is more than 32 times rated_torque_Nm, which 0x6071 cannot carry");
  }
  if (!(d.heartbeat_timeout_ms > d.heartbeat_ms)) {
    Refuse(axis, "heartbeat_timeout_ms must be longer than heartbeat_ms");
  }
  if (d.notice_ms * 1000.0 < 2.0 * config.cycle_us) {
    Refuse(axis,
           "notice_ms must be at least two cycles, or the drive stops between two frames of the master");
  }
}

void CheckNodes(const MasterConfig& config) {
  for (std::size_t i = 0; i < config.axes.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const AxisDriveConfig& a = config.axes[j];
      const AxisDriveConfig& b = config.axes[i];
      if (a.bus == b.bus && a.drive.node_id == b.drive.node_id) {
        Refuse(b, "node_id " + std::to_string(b.drive.node_id) + " is already that of axis " + a.name);
      }
    }
  }
}

}  // namespace

DriveMaster::DriveMaster(const MasterConfig& config)
    : axis_count_(config.axes.size()),
      feedback_(config.axes.size()),
      status_(config.axes.size()),
      sent_torque_Nm_(config.axes.size()),
      axis_of_node_(config.buses.size() * kNodes, kNoAxis),
      period_ns_(std::int64_t{config.cycle_us} * 1000),
      probes_(config.start_up == StartUp::kNow),
      patrols_(config.start_up != StartUp::kOfLogFormat4) {
  if (config.axes.empty() || config.axes.size() > kMaxAxes) {
    throw std::invalid_argument("a machine has 1 to " + std::to_string(kMaxAxes) + " axes");
  }
  if (config.buses.empty() || config.buses.size() > kMaxBuses) {
    throw std::invalid_argument("a machine has 1 to " + std::to_string(kMaxBuses) + " buses");
  }
  CheckNodes(config);

  std::vector<std::vector<BringUpNode>> nodes(config.buses.size());
  std::vector<std::vector<PatrolledDrive>> patrols(config.buses.size());
  std::vector<std::uint64_t> heartbeat_cycles(config.buses.size(), ~std::uint64_t{0});
  for (std::size_t i = 0; i < config.axes.size(); ++i) {
    const AxisDriveConfig& a = config.axes[i];
    Check(a, config);
    const DriveConfig& d = a.drive;
    nodes[a.bus].push_back(DriveScript(d, static_cast<std::uint8_t>(i), a.torque_limit_Nm,
                                       config.buses[a.bus].master_node_id, config.cycle_us,
                                       config.start_up != StartUp::kOfLogFormat4));
    heartbeat_cycles[a.bus] =
        std::min(heartbeat_cycles[a.bus], MasterHeartbeatCycles(d.notice_ms, config.cycle_us));
    axis_of_node_[a.bus * kNodes + static_cast<std::size_t>(d.node_id)] = static_cast<std::uint8_t>(i);

    Axis axis;
    axis.bus = a.bus;
    axis.node_id = static_cast<std::uint8_t>(d.node_id);
    axis.mode = d.mode;
    axis.torque_offset = d.csp_torque_offset;
    axis.has_scale = d.linear_scale.has_value();
    axis.torque = {d.rated_torque_Nm};
    axis.position = {static_cast<double>(d.encoder_counts_per_rev)};
    axis.scale_m_per_count = d.linear_scale ? 1e-3 / d.linear_scale->counts_per_mm : 0.0;
    axis.torque_limit_Nm = a.torque_limit_Nm;
    axis.walk =
        DriveWalk(CyclesOf(d.transition_ms, config.cycle_us), CyclesOf(d.quick_stop_ms, config.cycle_us));
    for (const auto& [codes, reaction] : d.emergency_reaction) {
      const std::optional<EmergencyClass> parsed = ParseEmergencyClass(codes);
      if (!parsed) Refuse(a, "emergency_reaction: '" + codes + "' is no error code such as 0x4210 or 0x42xx");
      axis.stronger.push_back({*parsed, reaction});
    }
    axis.patrolled = patrols[a.bus].size();
    patrols[a.bus].push_back({axis.node_id, ModeOfOperation(d.mode), CyclesOf(d.sdo_ms, config.cycle_us)});
    if (d.follows_target_bit) axis.follow_bits = statusword::kFollowsTarget;
    axis.follow_cycles = 2 + static_cast<std::uint64_t>(d.delay_cycles);
    // The statusword in which a controlword shows was latched a SYNC later, and comes another cycle later.
    axis.obeys_cycles = 2 + static_cast<std::uint64_t>(d.delay_cycles);
    axis.stays_cycles = axis.obeys_cycles + std::max(CyclesOf(d.transition_ms, config.cycle_us),
                                                     CyclesOf(d.quick_stop_ms, config.cycle_us));
    axis.heartbeat_timeout_cycles = CyclesOf(d.heartbeat_timeout_ms, config.cycle_us);
    axis.absolute = d.absolute_encoder || config.start_up == StartUp::kOfLogFormat4;
    if (!axis.absolute) axis.reference = ReferenceState::kNeverTold;
    axis.unseen_travel_rad =
        config.start_up == StartUp::kOfLogFormat4 && !d.absolute_encoder ? 0.0 : a.unseen_travel_rad;
    const double cycles_s = 1e6 / config.cycle_us;
    axis.coast_cycles2_rad = a.coast_s2_rad * cycles_s * cycles_s;
    axes_.push_back(axis);
  }
  for (std::size_t b = 0; b < config.buses.size(); ++b) {
    Bus bus;
    if (config.start_up != StartUp::kOfLogFormat4)
      bus.patrol = DrivePatrol(std::move(patrols[b]), config.cycle_us);
    bus.master_node_id = static_cast<std::uint8_t>(config.buses[b].master_node_id);
    const double listen_ms = config.start_up == StartUp::kOfLogFormat4 ? 0.0 : config.buses[b].listen_ms;
    bus.bring_up = BringUp(std::move(nodes[b]), config.cycle_us,
                           {static_cast<std::uint8_t>(b), bus.master_node_id,
                            listen_ms > 0.0 ? CyclesOf(listen_ms, config.cycle_us) : 0});
    bus.heartbeat_cycles = heartbeat_cycles[b];
    buses_.push_back(std::move(bus));
  }
}

}  // namespace contour
