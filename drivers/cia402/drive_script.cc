#include "drivers/cia402/drive_script.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "drivers/cia402/pdo_layout.h"

namespace contour {
namespace {

constexpr std::uint32_t kCia402Profile = 402;  // low half of 0x1000
constexpr std::uint32_t kPdoInvalid = 0x80000000;
constexpr std::uint32_t kNoRtr = 0x40000000;
constexpr std::uint32_t kCobIdMask = ~kNoRtr;  // drives differ in whether they keep the RTR bit
constexpr std::uint8_t kSynchronous = 1;       // transmission type: every SYNC, in and out
constexpr int kPdosPerDirection = 4;           // of the predefined connection set
constexpr std::uint32_t kPreOperationalOnError = 0;

// Marks of a group of steps: what differs.
constexpr std::uint8_t kDiffers = 1;
constexpr std::uint8_t kCommunicationDiffers = 1;
constexpr std::uint8_t kMappingDiffers = 2;

/// Appends steps to a script; one method per kind of thing one does to a drive. What is right already is not
/// written, except by the start-up of logs of format 4.
class Script {
 public:
  explicit Script(bool reads_first) : reads_first_(reads_first) {}
  [[nodiscard]] bool reads_first() const { return reads_first_; }
  void Phase(BringUpPhase phase) { phase_ = phase; }

  void Equal(std::uint16_t index, std::uint8_t sub, std::uint32_t value, BringUpError error,
             Tolerate tolerate = Tolerate::kNothing, std::uint32_t mask = 0xFFFFFFFF) {
    SdoStep s = Make(SdoAction::kEqual, index, sub, value, tolerate);
    s.mask = mask;
    s.error = error;
    steps_.push_back(s);
  }

  /// first / second must equal value.
  void Ratio(std::uint16_t index, std::uint32_t value, Tolerate tolerate) {
    steps_.push_back(Make(SdoAction::kKeep, index, 1, 0, tolerate));
    SdoStep s = Make(SdoAction::kRatio, index, 2, value, tolerate);
    s.error = BringUpError::kUnits;
    steps_.push_back(s);
  }

  void Near(std::uint16_t index, std::uint32_t value, std::uint32_t tolerance, BringUpError error) {
    SdoStep s = Make(SdoAction::kNear, index, 0, value, Tolerate::kNothing);
    s.tolerance = tolerance;
    s.error = error;
    steps_.push_back(s);
  }

  void Bits(std::uint16_t index, std::uint32_t bits, BringUpError error) {
    SdoStep s = Make(SdoAction::kBits, index, 0, bits, Tolerate::kAbsent);
    s.error = error;
    steps_.push_back(s);
  }

  void AtLeast(std::uint16_t index, std::uint32_t value, BringUpError error) {
    SdoStep s = Make(SdoAction::kAtLeast, index, 0, value, Tolerate::kAbsent);
    s.error = error;
    steps_.push_back(s);
  }

  /// Writes, without looking whether it took.
  void Write(std::uint16_t index, std::uint8_t sub, std::uint8_t size, std::uint32_t value,
             Tolerate tolerate = Tolerate::kNothing, bool watchdog = false) {
    SdoStep s = Make(SdoAction::kWrite, index, sub, value, tolerate);
    s.size = size;
    s.watchdog = watchdog;
    steps_.push_back(s);
  }

  /// Reads back what was written before.
  void ReadBack(std::uint16_t index, std::uint8_t sub, std::uint8_t size, std::uint32_t value,
                std::uint32_t mask = 0xFFFFFFFF) {
    const std::uint32_t width = size >= 4 ? 0xFFFFFFFFu : (1u << (8 * size)) - 1u;
    SdoStep s = Make(SdoAction::kEqual, index, sub, value & mask & width, Tolerate::kNothing);
    s.mask = mask & width;
    s.after_write = true;
    steps_.push_back(s);
  }

  /// The object is to hold this value: read, and where it differs written and read back.
  void Set(std::uint16_t index, std::uint8_t sub, std::uint8_t size, std::uint32_t value,
           Tolerate tolerate = Tolerate::kNothing, bool watchdog = false) {
    Ensure(index, sub, size, value, tolerate, watchdog);
    ReadBack(index, sub, size, value);
    if (reads_first_) steps_.back().only_if = kDiffers;
  }

  /// The same without looking whether it took.
  void Ensure(std::uint16_t index, std::uint8_t sub, std::uint8_t size, std::uint32_t value,
              Tolerate tolerate = Tolerate::kNothing, bool watchdog = false) {
    const std::uint32_t width = size >= 4 ? 0xFFFFFFFFu : (1u << (8 * size)) - 1u;
    if (reads_first_) {
      Compare(index, sub, value & width, width, kDiffers, tolerate);
      steps_.back().first = true;
      steps_.back().watchdog = watchdog;
    }
    Write(index, sub, size, value, tolerate, watchdog);
    if (reads_first_) steps_.back().only_if = kDiffers;
  }

  /// The last two steps: 0 is right as well where the object cannot be written.
  void OrZero() {
    if (!reads_first_) return;
    for (std::size_t back = 1; back <= 2; ++back) steps_[steps_.size() - back].or_zero = true;
  }

  void Compare(std::uint16_t index, std::uint8_t sub, std::uint32_t value, std::uint32_t mask,
               std::uint8_t mark, Tolerate tolerate = Tolerate::kNothing) {
    SdoStep s = Make(SdoAction::kCompare, index, sub, value & mask, tolerate);
    s.mask = mask;
    s.mark = mark;
    steps_.push_back(s);
  }

  /// Every step from this one on is skipped unless one of these marks is set.
  [[nodiscard]] std::size_t size() const { return steps_.size(); }
  void OnlyIf(std::size_t from, std::uint8_t marks) {
    for (std::size_t i = from; i < steps_.size(); ++i) steps_[i].only_if = marks;
  }
  SdoStep& last() { return steps_.back(); }

  void Poll(std::uint16_t index, std::uint8_t sub, std::uint32_t value, BringUpError error,
            std::uint64_t deadline) {
    SdoStep s = Make(SdoAction::kPoll, index, sub, value, Tolerate::kNothing);
    s.error = error;
    s.deadline_cycles = deadline;
    steps_.push_back(s);
  }

  void RequireWatchdog() {
    SdoStep s = Make(SdoAction::kRequireWatchdog, 0x1016, 1, 0, Tolerate::kNothing);
    s.error = BringUpError::kNoLossDetection;
    steps_.push_back(s);
  }

  std::vector<SdoStep> Take() { return std::move(steps_); }

 private:
  SdoStep Make(SdoAction action, std::uint16_t index, std::uint8_t sub, std::uint32_t value,
               Tolerate tolerate) const {
    SdoStep s;
    s.phase = phase_;
    s.action = action;
    s.index = index;
    s.sub = sub;
    s.value = value;
    s.tolerate = tolerate;
    return s;
  }

  bool reads_first_;
  BringUpPhase phase_ = BringUpPhase::kOff;
  std::vector<SdoStep> steps_;
};

std::uint32_t MilliNewtonMetres(double torque_Nm) {
  return static_cast<std::uint32_t>(std::llround(torque_Nm * 1000.0));
}

/// Whole milliseconds for the objects that are given in them: what the drive watches may only be shorter.
std::uint32_t WholeMilliseconds(double time_ms) {
  return static_cast<std::uint32_t>(std::clamp(std::floor(time_ms), 1.0, 65535.0));
}

void Identify(Script& script, const DriveConfig& drive) {
  script.Phase(BringUpPhase::kFind);
  script.Equal(0x1000, 0, kCia402Profile, BringUpError::kNotADrive, Tolerate::kNothing, 0xFFFF);
  if (!drive.identity) return;
  script.Phase(BringUpPhase::kIdentity);
  script.Equal(0x1018, 1, drive.identity->vendor_id, BringUpError::kIdentity);
  script.Equal(0x1018, 2, drive.identity->product_code, BringUpError::kIdentity);
  if (drive.identity->revision) script.Equal(0x1018, 3, *drive.identity->revision, BringUpError::kIdentity);
  if (drive.identity->serial_number)
    script.Equal(0x1018, 4, *drive.identity->serial_number, BringUpError::kIdentity);
}

void CompareUnits(Script& script, const DriveConfig& drive) {
  script.Phase(BringUpPhase::kUnits);
  script.Ratio(0x608F, drive.encoder_counts_per_rev, Tolerate::kAbsent);
  script.Ratio(0x6091, 1, Tolerate::kAbsent);  // positions in counts of the motor, no gear in between
  script.Equal(0x607E, 0, static_cast<std::uint32_t>(drive.polarity), BringUpError::kUnits,
               Tolerate::kAbsent);
  // Drives hold it in whole mNm, and some only in steps of the motor's data sheet.
  const std::uint32_t rated_mNm = MilliNewtonMetres(drive.rated_torque_Nm);
  script.Near(0x6076, rated_mNm, 1 + rated_mNm / 500, BringUpError::kRatedTorque);
  script.Bits(0x6502, drive.mode == DriveMode::kCst ? 1u << 9 : 1u << 7, BringUpError::kModeNotSupported);
}

void SetWatchdogs(Script& script, const DriveConfig& drive, int master_node_id) {
  script.Phase(BringUpPhase::kWatchdogs);
  const std::uint32_t notice_ms = WholeMilliseconds(drive.notice_ms);
  script.Set(0x1016, 1, 4, (static_cast<std::uint32_t>(master_node_id) << 16) | notice_ms,
             Tolerate::kReadOnly, true);
  if (drive.rpdo_timeout) script.Set(0x1400, 5, 2, notice_ms, Tolerate::kAnyAbort, true);
  script.RequireWatchdog();
  script.Set(0x1017, 0, 2, WholeMilliseconds(drive.heartbeat_ms));
  script.Ensure(0x1015, 0, 2, static_cast<std::uint32_t>(std::lround(drive.emergency_inhibit_ms * 10.0)),
                Tolerate::kAnyAbort);
}

void SetStopBehaviour(Script& script, const DriveConfig& drive) {
  script.Phase(BringUpPhase::kStopBehaviour);
  script.Set(0x1029, 1, 1, kPreOperationalOnError, Tolerate::kReadOnly);
  script.Set(0x6007, 0, 2, static_cast<std::uint32_t>(drive.abort_connection_option));
  script.Set(0x605A, 0, 2, static_cast<std::uint32_t>(drive.quick_stop_option), Tolerate::kAbsent);
  script.Ensure(0x605B, 0, 2, 0, Tolerate::kAnyAbort);  // shutdown: disable
  script.Ensure(0x605C, 0, 2, 1, Tolerate::kAnyAbort);  // disable operation: slow down, then disable
  script.Ensure(0x605D, 0, 2, 1, Tolerate::kAnyAbort);  // halt: slow down
  // Fault reaction: quick-stop ramp. How far an axis goes whose drive faults is promised by it.
  if (script.reads_first()) {
    script.Set(0x605E, 0, 2, 2, Tolerate::kAbsent);
  } else {
    script.Ensure(0x605E, 0, 2, 2, Tolerate::kAnyAbort);
  }
  if (drive.quick_stop_deceleration_rad_s2 > 0.0) {
    const double counts_s2 =
        drive.quick_stop_deceleration_rad_s2 / (2.0 * std::numbers::pi) * drive.encoder_counts_per_rev;
    script.Set(0x6085, 0, 4, static_cast<std::uint32_t>(std::clamp(counts_s2, 1.0, 4294967295.0)));
  }
}

void SetCycleTime(Script& script, std::uint32_t cycle_us) {
  script.Phase(BringUpPhase::kCycleTime);
  const InterpolationPeriod period = ToInterpolationPeriod(cycle_us);
  // A period of 0 says that the drive does not watch SYNC.
  script.Set(0x1006, 0, 4, cycle_us, script.reads_first() ? Tolerate::kAbsent : Tolerate::kReadOnly);
  script.OrZero();
  script.Set(0x60C2, 1, 1, period.value, Tolerate::kAbsent);
  script.Set(0x60C2, 2, 1, static_cast<std::uint8_t>(period.exponent), Tolerate::kAbsent);
}

void SetLimits(Script& script, const DriveConfig& drive, double torque_limit_Nm) {
  script.Phase(BringUpPhase::kLimits);
  const auto per_mille =
      static_cast<std::uint32_t>(std::ceil(torque_limit_Nm / drive.rated_torque_Nm * 1000.0 - 1e-9));
  for (const std::uint16_t index : std::array<std::uint16_t, 3>{0x6072, 0x60E0, 0x60E1}) {
    script.Ensure(index, 0, 2, per_mille, Tolerate::kReadOnly);
    script.AtLeast(index, per_mille, BringUpError::kLimitTooLow);
    if (script.reads_first()) script.last().only_if = kDiffers;
  }
}

/// What of a PDO differs. A mapping with another number of entries is not read further.
void ComparePdo(Script& script, std::uint16_t communication, std::uint32_t cob_id,
                std::span<const std::uint32_t> mapping) {
  const auto map = static_cast<std::uint16_t>(communication + 0x200);
  script.Compare(communication, 1, cob_id, kCobIdMask, kCommunicationDiffers);
  script.last().first = true;
  script.Compare(communication, 2, kSynchronous, 0xFF, kCommunicationDiffers);
  script.Compare(map, 0, static_cast<std::uint32_t>(mapping.size()), 0xFF, kMappingDiffers);
  for (std::uint32_t i = 0; i < mapping.size(); ++i) {
    script.Compare(map, static_cast<std::uint8_t>(i + 1), mapping[i], 0xFFFFFFFF, kMappingDiffers);
    script.last().skip_if = kMappingDiffers;
  }
}

/// One PDO in the order CiA 301 asks for: invalid, no entries, the entries, their number, transmission type,
/// valid. Then everything is read back, because what an EDS or a store says is not what the drive holds.
void SetPdo(Script& script, std::uint16_t communication, std::uint32_t cob_id,
            std::span<const std::uint32_t> mapping) {
  const auto map = static_cast<std::uint16_t>(communication + 0x200);
  const auto count = static_cast<std::uint32_t>(mapping.size());
  const std::uint8_t any = kCommunicationDiffers | kMappingDiffers;
  const bool reads_first = script.reads_first();
  if (reads_first) ComparePdo(script, communication, cob_id, mapping);
  const std::size_t begin = script.size();
  script.Write(communication, 1, 4, kPdoInvalid | cob_id);
  const std::size_t entries = script.size();
  script.Write(map, 0, 1, 0);
  for (std::uint32_t i = 0; i < count; ++i)
    script.Write(map, static_cast<std::uint8_t>(i + 1), 4, mapping[i]);
  script.Write(map, 0, 1, count);
  const std::size_t behind = script.size();
  script.Write(communication, 2, 1, kSynchronous);
  script.Write(communication, 1, 4, cob_id);

  script.ReadBack(communication, 1, 4, cob_id, kCobIdMask);
  script.ReadBack(communication, 2, 1, kSynchronous);
  const std::size_t read_entries = script.size();
  script.ReadBack(map, 0, 1, count);
  for (std::uint32_t i = 0; i < count; ++i)
    script.ReadBack(map, static_cast<std::uint8_t>(i + 1), 4, mapping[i]);
  if (!reads_first) return;
  script.OnlyIf(begin, any);
  script.OnlyIf(entries, kMappingDiffers);
  script.OnlyIf(behind, any);
  script.OnlyIf(read_entries, kMappingDiffers);
}

void SwitchOffPdo(Script& script, std::uint16_t communication, std::uint32_t cob_id) {
  if (script.reads_first()) {
    script.Compare(communication, 1, kPdoInvalid, kPdoInvalid, kCommunicationDiffers, Tolerate::kAbsent);
    script.last().first = true;
  }
  script.Write(communication, 1, 4, kPdoInvalid | cob_id, Tolerate::kAbsent);
  if (script.reads_first()) script.last().only_if = kCommunicationDiffers;
}

void SetPdos(Script& script, const DriveConfig& drive) {
  script.Phase(BringUpPhase::kPdo);
  const auto node = static_cast<std::uint32_t>(drive.node_id);
  SetPdo(script, 0x1400, cob::kRpdo1 + node, RpdoMapping(drive));
  SetPdo(script, 0x1800, kNoRtr | (cob::kTpdo1 + node), kTpdoFeedback);
  if (drive.linear_scale) SetPdo(script, 0x1801, kNoRtr | (cob::kTpdo1 + 0x100 + node), kTpdoScale);
  // The other PDOs are switched off: the bus carries what was reckoned with, nothing else.
  for (int i = 1; i < kPdosPerDirection; ++i) {
    const auto offset = static_cast<std::uint32_t>(0x100 * i);
    const auto rpdo = static_cast<std::uint16_t>(0x1400 + i);
    const auto tpdo = static_cast<std::uint16_t>(0x1800 + i);
    SwitchOffPdo(script, rpdo, cob::kRpdo1 + offset + node);
    if (i == 1 && drive.linear_scale) continue;
    SwitchOffPdo(script, tpdo, kNoRtr | (cob::kTpdo1 + offset + node));
  }
}

void SetMode(Script& script, const DriveConfig& drive, std::uint32_t cycle_us) {
  script.Phase(BringUpPhase::kMode);
  const std::uint32_t mode = ModeOfOperation(drive.mode);
  script.Ensure(0x6060, 0, 1, mode);
  script.Poll(0x6061, 0, mode, BringUpError::kModeNotTaken, CyclesOf(drive.mode_ms, cycle_us));
}

}  // namespace

InterpolationPeriod ToInterpolationPeriod(std::uint32_t cycle_us) {
  std::uint32_t value = cycle_us;
  int exponent = -6;
  while (value % 10 == 0 && exponent < -3 && value > 0) {
    value /= 10;
    ++exponent;
  }
  if (value < 1 || value > 255) {
    throw std::invalid_argument("a cycle of " + std::to_string(cycle_us) +
                                " us cannot be told to a drive: 0x60C2 holds 1 to 255 times a power of ten");
  }
  return {static_cast<std::uint8_t>(value), static_cast<std::int8_t>(exponent)};
}

std::uint64_t CyclesOf(double time_ms, std::uint32_t cycle_us) noexcept {
  const double cycles = std::ceil(time_ms * 1000.0 / cycle_us - 1e-9);
  return cycles < 1.0 ? 1 : static_cast<std::uint64_t>(cycles);
}

std::uint64_t MasterHeartbeatCycles(double notice_ms, std::uint32_t cycle_us) noexcept {
  const double cycles = std::floor(notice_ms * 1000.0 / 3.0 / cycle_us);
  return cycles < 1.0 ? 1 : static_cast<std::uint64_t>(cycles);
}

BringUpNode DriveScript(const DriveConfig& drive, std::uint8_t axis, double torque_limit_Nm,
                        int master_node_id, std::uint32_t cycle_us, bool reads_first) {
  Script script(reads_first);
  Identify(script, drive);
  CompareUnits(script, drive);
  SetWatchdogs(script, drive, master_node_id);
  SetStopBehaviour(script, drive);
  SetCycleTime(script, cycle_us);
  SetLimits(script, drive, torque_limit_Nm);
  SetPdos(script, drive);
  SetMode(script, drive, cycle_us);

  BringUpNode node;
  node.axis = axis;
  node.node_id = static_cast<std::uint8_t>(drive.node_id);
  node.boot_up_cycles = CyclesOf(drive.boot_up_ms, cycle_us);
  node.sdo_cycles = CyclesOf(drive.sdo_ms, cycle_us);
  node.operational_cycles = CyclesOf(drive.operational_ms, cycle_us);
  node.steps = script.Take();
  return node;
}

}  // namespace contour
