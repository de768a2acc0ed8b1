#include "drivers/cia301/bring_up_text.h"

#include <array>
#include <cstdio>

#include "drivers/cia301/bring_up_status.h"
#include "drivers/cia301/master_watch.h"
#include "drivers/cia301/messages.h"
#include "drivers/cia301/sdo_transfer.h"

namespace contour {
namespace {

struct Named {
  std::uint32_t code;
  std::string_view name;
};

constexpr std::array kObjects{
    Named{0x1000, "device type"},
    Named{0x1006, "SYNC period"},
    Named{0x1015, "emergency inhibit time"},
    Named{0x1016, "heartbeat consumer"},
    Named{0x1017, "heartbeat producer"},
    Named{0x1018, "identity"},
    Named{0x1029, "error behaviour"},
    Named{0x6007, "abort connection option"},
    Named{0x605A, "quick stop option"},
    Named{0x605B, "shutdown option"},
    Named{0x605C, "disable operation option"},
    Named{0x605D, "halt option"},
    Named{0x605E, "fault reaction option"},
    Named{0x6060, "mode of operation"},
    Named{0x6061, "mode of operation display"},
    Named{0x6072, "maximum torque"},
    Named{0x6076, "rated torque"},
    Named{0x607E, "polarity"},
    Named{0x6085, "quick stop deceleration"},
    Named{0x608F, "encoder resolution"},
    Named{0x6091, "gear ratio"},
    Named{0x60C2, "interpolation period"},
    Named{0x60E0, "positive torque limit"},
    Named{0x60E1, "negative torque limit"},
    Named{0x6502, "supported drive modes"},
};

template <std::size_t N>
std::string_view Find(const std::array<Named, N>& table, std::uint32_t code) noexcept {
  for (const Named& n : table) {
    if (n.code == code) return n.name;
  }
  return {};
}

std::string Hex(std::uint32_t value, int digits) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "0x%0*X", digits, value);
  return text.data();
}

std::string_view ObjectName(std::uint16_t index) noexcept {
  if (index >= 0x1400 && index < 0x1600) return "RPDO parameter";
  if (index >= 0x1600 && index < 0x1800) return "RPDO mapping";
  if (index >= 0x1800 && index < 0x1A00) return "TPDO parameter";
  if (index >= 0x1A00 && index < 0x1C00) return "TPDO mapping";
  return Find(kObjects, index);
}

std::string Object(const BringUpStatus& s) {
  std::array<char, 8> sub{};
  std::snprintf(sub.data(), sub.size(), ":%02X", unsigned{s.sub_index});
  const std::string_view name = ObjectName(s.index);
  return (name.empty() ? std::string("object ") : std::string(name) + " ") + Hex(s.index, 4) + sub.data();
}

std::string Waited(const BringUpStatus& s) { return std::to_string((s.waited_us + 500) / 1000) + " ms"; }

std::string Both(const BringUpStatus& s, std::string_view unit = {}) {
  const std::string u = unit.empty() ? std::string() : " " + std::string(unit);
  return "expected " + std::to_string(s.expected) + u + " (" + Hex(s.expected, 1) + "), found " +
         std::to_string(s.found) + u + " (" + Hex(s.found, 1) + ")";
}

/// The key of the machine file that says what an object must hold.
std::string_view KeyOf(std::uint16_t index) noexcept {
  switch (index) {
    case 0x1006:
    case 0x60C2:
      return "machine.cycle_us";
    case 0x1015:
      return "drive.emergency_inhibit_ms";
    case 0x1016:
      return "drive.notice_ms";
    case 0x1017:
      return "drive.heartbeat_ms";
    case 0x6007:
      return "drive.abort_connection_option";
    case 0x605A:
      return "drive.quick_stop_option";
    case 0x6085:
      return "drive.quick_stop_deceleration_rad_s2";
    case 0x6060:
      return "drive.mode";
    case 0x6072:
    case 0x60E0:
    case 0x60E1:
      return "limits.torque_Nm";
    default:
      return {};
  }
}

std::string WhatToDo(std::uint16_t index) {
  const std::string_view key = KeyOf(index);
  if (!key.empty())
    return "change it with the maker's tool, or make " + std::string(key) + " of the machine file agree";
  if (index >= 0x1400 && index < 0x1C00)
    return "this drive's PDO is fixed and is not the one that is used here; change it with the maker's tool, "
           "or take a drive whose PDOs can be set up";
  return "change it with the maker's tool";
}

std::string NmtName(std::uint32_t state) {
  switch (static_cast<NmtState>(state)) {
    case NmtState::kBootUp:
      return "its boot-up message was the last";
    case NmtState::kStopped:
      return "its heartbeat says Stopped";
    case NmtState::kOperational:
      return "its heartbeat says Operational";
    case NmtState::kPreOperational:
      return "its heartbeat says Pre-operational";
    case NmtState::kUnknown:
      return "it sends no heartbeat";
  }
  return "its heartbeat says state " + Hex(state, 2);
}

std::string Failure(const BringUpStatus& s) {
  switch (static_cast<BringUpError>(s.error)) {
    case BringUpError::kNone:
      break;
    case BringUpError::kNoAnswer:
      return "no boot-up message within " + std::to_string(s.expected) +
             " ms (drive.boot_up_ms) and no reply to SDO within " + std::to_string(s.found) +
             " ms (drive.sdo_ms); check its supply, its node number, the wiring and the bit rate, or how "
             "long "
             "the drive takes to boot";
    case BringUpError::kSdoTimeout:
      return "no reply to SDO for " + Object(s) + " within " + Waited(s) + " (drive.sdo_ms)";
    case BringUpError::kSdoAbort:
      return "the drive refused " + Object(s) + ": " + std::string(SdoAbortText(s.abort_code)) +
             " (abort code " + Hex(s.abort_code, 8) + ")";
    case BringUpError::kReadBack:
      return Object(s) + " does not hold what was written: " + Both(s);
    case BringUpError::kIdentity:
      return Object(s) + " differs from the configuration: " + Both(s) +
             (s.sub_index == 4 ? "; this is another drive of the same type: look whether the node numbers or "
                                 "the cables of two drives are exchanged. After a drive was replaced state "
                                 "its serial_number"
                               : "; this is another drive than the machine file says");
    case BringUpError::kNotADrive:
      return Object(s) + " is not that of a CiA 402 drive: expected profile 402, found " +
             std::to_string(s.found);
    case BringUpError::kRatedTorqueZero:
      return Object(s) + " is 0 in the drive, so its torques have no unit; expected " +
             std::to_string(s.expected) + " mNm. Set up the motor in the drive first";
    case BringUpError::kRatedTorque:
      return Object(s) + " differs from rated_torque_Nm: " + Both(s, "mNm");
    case BringUpError::kUnits:
      return Object(s) + " differs from the configuration: " + Both(s);
    case BringUpError::kModeNotSupported:
      return Object(s) + " lacks the mode of the configuration: bits " + Hex(s.expected, 1) + " expected, " +
             Hex(s.found, 1) + " found";
    case BringUpError::kNoLossDetection:
      return "the drive has neither a heartbeat consumer (0x1016) nor an RPDO timeout (0x1400:05), so it "
             "would not notice that the master is gone" +
             (s.expected == 0 ? std::string()
                              : "; 0x1016:01 cannot be written: " + Both(s) + ", " + WhatToDo(0x1016));
    case BringUpError::kModeNotTaken:
      return Object(s) + " shows mode " + std::to_string(s.found) + " instead of " +
             std::to_string(s.expected) + " after " + Waited(s) + " (drive.mode_ms)";
    case BringUpError::kNotOperational:
      return "the drive did not become Operational within " + Waited(s) +
             " (drive.operational_ms) after NMT start: " + NmtName(s.found);
    case BringUpError::kLimitTooLow:
      return Object(s) + " in the drive is lower than the axis's torque limit: " + Both(s, "per mille");
    case BringUpError::kRestarted:
      return "the drive restarted (boot-up message) while it was brought up";
    case BringUpError::kBusDown:
      return "the bus went down while the drive was brought up";
    case BringUpError::kSecondMaster:
      return "another master sends on this bus: " + SecondMasterText(s) +
             ". Only one may command these drives: end it, or disconnect it";
    case BringUpError::kSegmentedReply:
      return "the drive wants to send " + Object(s) + " in segments" +
             (s.found == 0 ? std::string() : " (" + std::to_string(s.found) + " bytes)") +
             ", but this object has at most four bytes; the transfer was aborted. Look whether its "
             "dictionary "
             "has something else there";
    case BringUpError::kUnexpectedReply:
      return "the drive answered something else than was asked to SDO for " + Object(s) + " (first byte " +
             Hex(s.found, 2) +
             "); the transfer was aborted. Look for another program that talks to this drive";
    case BringUpError::kReadOnlyDiffers:
      return Object(s) + " cannot be written in this drive and differs: " + Both(s) + "; " +
             WhatToDo(s.index);
  }
  return "unknown error " + std::to_string(s.error);
}

}  // namespace

std::string BringUpText(const BringUpStatus& s, std::span<const std::string> axis_names) {
  const auto phase = static_cast<BringUpPhase>(s.phase);
  if (s.error == 0 && phase == BringUpPhase::kOff) return "drives not brought up yet";
  if (s.error == 0 && phase == BringUpPhase::kOperational) return "all drives operational";
  const std::string name = s.axis < axis_names.size() ? axis_names[s.axis] : std::to_string(s.axis);
  const std::string who =
      "axis " + name + " (node " + std::to_string(s.node_id) + "), " + std::string(Name(phase)) + ": ";
  if (s.error != 0) return who + Failure(s);
  return who + (s.index != 0 ? Object(s) + ", " : std::string()) + "waiting for " + Waited(s);
}

std::string SecondMasterText(const BringUpStatus& s) {
  if (s.error != static_cast<std::uint8_t>(BringUpError::kSecondMaster)) return {};
  // For a set-point or an SDO request any drive is one of ours here.
  MasterWatch watch(static_cast<std::uint8_t>(s.found & 0x7F));
  watch.Add(static_cast<std::uint8_t>(s.found & 0x7F));
  CanFrame frame;
  frame.id = static_cast<std::uint16_t>(s.found);
  const MasterSign sign = watch.SignOf(frame);
  const bool to_drive = sign == MasterSign::kSetpoint || sign == MasterSign::kSdoRequest;
  return std::string(Name(sign)) + (to_drive ? " to node " + std::to_string(s.found & 0x7F) : "") +
         " (COB-ID " + Hex(s.found, 3) + ")";
}

}  // namespace contour
