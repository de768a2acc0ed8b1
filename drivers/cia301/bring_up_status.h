#pragma once

#include <cstdint>
#include <string_view>

namespace contour {

/// What is being done while the drives of a bus are brought up, in this order (kListen first).
/// Values are part of the log format: append, never renumber.
enum class BringUpPhase : std::uint8_t {
  kOff = 0,
  kReset = 1,          ///< NMT reset communication
  kBootUp = 2,         ///< waiting for the boot-up message
  kFind = 3,           ///< device type (0x1000)
  kIdentity = 4,       ///< who it is (0x1018)
  kUnits = 5,          ///< resolution, gear, polarity, rated torque, supported modes
  kWatchdogs = 6,      ///< heartbeats both ways, RPDO timeout
  kStopBehaviour = 7,  ///< what the drive does when it stops or loses the master
  kCycleTime = 8,      ///< SYNC and interpolation period
  kLimits = 9,         ///< torque limits
  kPdo = 10,           ///< PDO configuration and its read-back
  kMode = 11,          ///< mode of operation
  kStart = 12,         ///< NMT start, until the heartbeat says Operational
  kOperational = 13,   ///< all drives are up; SYNC runs
  kListen = 14,        ///< comes first: is another master on the bus? Nothing is sent
};

constexpr std::string_view Name(BringUpPhase p) noexcept {
  switch (p) {
    case BringUpPhase::kOff:
      return "off";
    case BringUpPhase::kReset:
      return "reset communication";
    case BringUpPhase::kBootUp:
      return "wait for boot-up";
    case BringUpPhase::kFind:
      return "find the drive";
    case BringUpPhase::kIdentity:
      return "check identity";
    case BringUpPhase::kUnits:
      return "compare units and ratings";
    case BringUpPhase::kWatchdogs:
      return "set up heartbeats";
    case BringUpPhase::kStopBehaviour:
      return "set up stopping";
    case BringUpPhase::kCycleTime:
      return "set up cycle time";
    case BringUpPhase::kLimits:
      return "set up torque limits";
    case BringUpPhase::kPdo:
      return "set up PDOs";
    case BringUpPhase::kMode:
      return "select mode of operation";
    case BringUpPhase::kStart:
      return "wait for Operational";
    case BringUpPhase::kOperational:
      return "operational";
    case BringUpPhase::kListen:
      return "listen for another master";
  }
  return "unknown";
}

/// Whether `a` comes before `b`.
constexpr bool ComesBefore(BringUpPhase a, BringUpPhase b) noexcept {
  const auto place = [](BringUpPhase p) {
    // Between kOff and kReset, whatever its number.
    return p == BringUpPhase::kListen ? 1 : 2 * static_cast<int>(p);
  };
  return place(a) < place(b);
}

/// Why bringing up failed. Values are part of the log format: append, never renumber.
enum class BringUpError : std::uint8_t {
  kNone = 0,
  kNoAnswer = 1,           ///< neither a boot-up message nor a reply to SDO
  kSdoTimeout = 2,         ///< an object was not answered in time
  kSdoAbort = 3,           ///< the drive refused an object; abort_code says why
  kReadBack = 4,           ///< an object does not hold what was written
  kIdentity = 5,           ///< 0x1018 differs from the configuration
  kNotADrive = 6,          ///< 0x1000 is not that of a CiA 402 device
  kRatedTorqueZero = 7,    ///< 0x6076 is 0
  kRatedTorque = 8,        ///< 0x6076 differs from the configuration
  kUnits = 9,              ///< 0x608F, 0x6091 or 0x607E differs from the configuration
  kModeNotSupported = 10,  ///< 0x6502 lacks the mode
  kNoLossDetection = 11,   ///< neither a heartbeat consumer nor an RPDO timeout could be set
  kModeNotTaken = 12,      ///< 0x6061 did not show the mode in time
  kNotOperational = 13,    ///< no heartbeat said Operational in time; found is the state last seen
  kLimitTooLow = 14,       ///< the drive limits torque below the configured limit
  kRestarted = 15,         ///< boot-up message in the middle of it
  kBusDown = 16,           ///< the bus went down in the middle of it
  kSecondMaster = 17,    ///< another master sends on the bus `expected`; `found` is the COB-ID it was seen by
  kSegmentedReply = 18,  ///< an object is longer than the four bytes it should have; found is its size
  kUnexpectedReply = 19,  ///< a reply to something else than was asked; found is its first byte
  kReadOnlyDiffers = 20,  ///< an object cannot be written and holds something else than it must
};

}  // namespace contour
