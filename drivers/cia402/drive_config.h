#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "core/visit.h"
#include "drivers/cia301/emergency_table.h"

namespace contour {

/// Cyclic synchronous mode in which a drive is run.
enum class DriveMode : std::uint8_t {
  kCst = 0,  ///< cyclic synchronous torque, mode of operation 10
  kCsp = 1,  ///< cyclic synchronous position, mode 8: the drive closes its own position cascade
};

constexpr std::string_view Name(DriveMode m) noexcept { return m == DriveMode::kCst ? "cst" : "csp"; }
/// As 0x6060 and 0x6061 hold it.
constexpr std::uint8_t ModeOfOperation(DriveMode m) noexcept { return m == DriveMode::kCst ? 10 : 8; }
constexpr std::string_view Choices(DriveMode) noexcept { return "cst, csp"; }
constexpr bool FromName(std::string_view name, DriveMode& mode) noexcept {
  if (name == "cst") mode = DriveMode::kCst;
  if (name == "csp") mode = DriveMode::kCsp;
  return name == "cst" || name == "csp";
}

/// Who the drive must say it is (0x1018). What is not given is not compared.
struct IdentityConfig {
  std::uint32_t vendor_id = 0;
  std::uint32_t product_code = 0;
  std::optional<std::uint32_t> revision;
  std::optional<std::uint32_t> serial_number{};

  template <class Visitor>
  void Visit(Visitor& v) {
    constexpr Range kU32{0, 4294967295.0};
    v.Required("vendor_id", vendor_id, kU32, "expected 0x1018:01");
    v.Required("product_code", product_code, kU32, "expected 0x1018:02");
    v.Optional("revision", revision, kU32, "expected 0x1018:03; not compared when left out");
    v.Optional("serial_number", serial_number, kU32,
               "expected 0x1018:04, which tells drives of one type apart; not compared when left out");
  }
};

/// A linear scale read by the drive itself (0x60E4:01, sent in TPDO2).
struct LinearScaleConfig {
  double counts_per_mm = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("counts_per_mm", counts_per_mm, kPositive,
               "counts of 0x60E4:01 per millimetre of table travel");
  }
};

/// One CiA 402 drive, `axes.<name>.drive` of a machine file. Field names are the YAML keys.
struct DriveConfig {
  std::string bus;
  int node_id = 0;
  DriveMode mode = DriveMode::kCst;
  double rated_torque_Nm = 0.0;
  double peak_torque_Nm = 0.0;
  std::uint32_t encoder_counts_per_rev = 0;
  bool absolute_encoder = false;
  std::optional<IdentityConfig> identity;
  std::optional<LinearScaleConfig> linear_scale;
  int delay_cycles = 1;
  double lag_ms = 0.2;

  double notice_ms = 10.0;
  bool rpdo_timeout = true;
  double heartbeat_ms = 50.0;
  double heartbeat_timeout_ms = 150.0;
  double emergency_inhibit_ms = 100.0;
  std::map<std::string, EmergencyReaction> emergency_reaction;
  bool follows_target_bit = true;

  double quick_stop_deceleration_rad_s2 = 0.0;
  int quick_stop_option = 2;
  int abort_connection_option = 3;
  int polarity = 0;
  bool csp_torque_offset = true;
  double csp_acceleration_share = 0.0;

  double boot_up_ms = 1000.0;
  double sdo_ms = 200.0;
  double mode_ms = 500.0;
  double operational_ms = 500.0;
  double transition_ms = 500.0;
  double quick_stop_ms = 1000.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    constexpr Range kDeadline_ms{1, 60000};
    v.Required("bus", bus, "name of the bus, a key under buses:");
    v.Required("node_id", node_id, Range{1, 127}, "CANopen node of the drive");
    v.Optional("mode", mode,
               "cst: target torque every cycle; csp: target position, the drive closes its own cascade");
    v.Required("rated_torque_Nm", rated_torque_Nm, kPositive,
               "rated torque of the motor; must agree with 0x6076, the unit of all torques on the bus");
    v.Required("peak_torque_Nm", peak_torque_Nm, kPositive, "largest torque drive and motor can give");
    v.Required("encoder_counts_per_rev", encoder_counts_per_rev, Range{1, 4294967295.0},
               "counts of 0x6064 per motor turn; must agree with 0x608F");
    v.Optional("absolute_encoder", absolute_encoder,
               "the drive knows after power-up where the axis is; without, it has to be told (contour "
               "reference), and "
               "a place learnt before means nothing");
    v.Optional("identity", identity, "who the drive must say it is (0x1018)");
    v.Optional("linear_scale", linear_scale, "scale at the table, read by the drive (0x60E4:01)");
    v.Optional("delay_cycles", delay_cycles, Range{1, 3},
               "periods from latching a position to the torque computed from it");
    v.Optional("lag_ms", lag_ms, Range{0, 20}, "time constant of the drive's current loop");

    v.Optional("notice_ms", notice_ms, Range{2, 100},
               "within this time the drive notices that the master is silent and stops by itself");
    v.Optional("rpdo_timeout", rpdo_timeout, "also watch RPDO1 in the drive (0x1400:05) where the drive can");
    v.Optional("heartbeat_ms", heartbeat_ms, Range{2, 1000}, "period of the drive's heartbeat (0x1017)");
    v.Optional("heartbeat_timeout_ms", heartbeat_timeout_ms, Range{3, 10000},
               "without a heartbeat for this long the drive counts as lost");
    v.Optional("emergency_inhibit_ms", emergency_inhibit_ms, Range{0, 6000},
               "shortest time between two emergency messages of the drive (0x1015)");
    v.Optional("emergency_reaction", emergency_reaction,
               "by error code (0x4210) or class of codes (0x42xx, 0x4xxx): what an emergency message of the "
               "enabled drive leads to; only stronger than docs/canopen.md has it");
    v.Optional("follows_target_bit", follows_target_bit,
               "the enabled drive sets bit 12 of the statusword while it follows its target, and bit 9, once "
               "shown, while it obeys; false where its bits say something else, then neither is watched");

    v.Optional("quick_stop_deceleration_rad_s2", quick_stop_deceleration_rad_s2, kNotNegative,
               "deceleration of the drive's quick stop (0x6085); 0 leaves the drive's own");
    v.Optional("quick_stop_option", quick_stop_option, Range{0, 8}, "what a quick stop does (0x605A)");
    v.Optional("abort_connection_option", abort_connection_option, Range{0, 3},
               "what the drive does when the master is gone (0x6007); 3 is quick stop");
    v.Optional("polarity", polarity, Range{0, 255},
               "0x607E, to be found in the drive: 0, or in csp 192, positions and velocities turned round");
    v.Optional("csp_torque_offset", csp_torque_offset,
               "send a torque offset (0x60B2) with the target position in csp");
    v.Optional(
        "csp_acceleration_share", csp_acceleration_share, Range{0, 1},
        "share of the torque of acceleration that goes into the torque offset (0x60B2), because the drive "
        "does not feed it forward itself: 0, it does all of it; 1, it does none");

    v.Optional("boot_up_ms", boot_up_ms, kDeadline_ms, "deadline for the boot-up message after a reset");
    v.Optional("sdo_ms", sdo_ms, kDeadline_ms, "deadline for an SDO reply");
    v.Optional("mode_ms", mode_ms, kDeadline_ms,
               "deadline for the drive to show the mode of operation (0x6061)");
    v.Optional("operational_ms", operational_ms, kDeadline_ms,
               "deadline for the heartbeat to say Operational");
    v.Optional("transition_ms", transition_ms, Range{1, 10000},
               "deadline for one transition of the CiA 402 state machine");
    v.Optional("quick_stop_ms", quick_stop_ms, Range{1, 10000},
               "deadline for a quick stop; then the voltage is disabled");
  }
};

/// One CAN bus, `buses.<name>` of a machine file.
struct BusConfig {
  std::string interface;
  std::uint32_t bitrate_bit_s = 1'000'000;
  int master_node_id = 127;
  double listen_ms = 1200.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("interface", interface,
               "SocketCAN interface (can0, vcan0, ...), or loopback for the emulated machine in-process");
    v.Optional("bitrate_bit_s", bitrate_bit_s, Range{10'000, 1'000'000},
               "bit rate; the interface itself is set up outside");
    v.Optional("master_node_id", master_node_id, Range{1, 127},
               "node number under which the master sends its heartbeat");
    // Three heartbeats of a master that sends one every 400 ms, and one of a master that does every second.
    v.Optional("listen_ms", listen_ms, Range{0, 60000},
               "before the first frame is sent, the bus is heard for this long; another master's heartbeat, "
               "SYNC or "
               "command refuses the start. Longer than the longest heartbeat period of any master that could "
               "be there; 0 does not listen");
  }
};

}  // namespace contour
