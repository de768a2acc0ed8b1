#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/axis.h"
#include "core/cycle_input.h"
#include "core/cycle_record.h"
#include "core/reference.h"
#include "core/state_keeper.h"
#include "drivers/cia301/bring_up.h"
#include "drivers/cia301/messages.h"
#include "drivers/cia402/answer_probe.h"
#include "drivers/cia402/drive_config.h"
#include "drivers/cia402/drive_patrol.h"
#include "drivers/cia402/drive_walk.h"
#include "drivers/cia402/scaling.h"
#include "drivers/cia402/torque_rounding.h"

namespace contour {

/// One axis as the master needs it.
struct AxisDriveConfig {
  std::string name;
  std::uint8_t bus = 0;  ///< index into MasterConfig::buses
  DriveConfig drive;
  double torque_limit_Nm = 0.0;  ///< written to the drive (0x6072); the axis's limit, at most its peak torque
  /// An axis that is found further than this from where it was last seen has lost its count; 0: not looked
  /// at.
  double unseen_travel_rad = 0.0;
  /// How far it coasts without torque, by its speed squared. One with an absolute encoder may have gone so
  /// much further from where it was last seen in motion.
  double coast_s2_rad = 0.0;
};

/// How the drives are found, configured and asked while they run. A log replays as it was recorded: what is
/// sent and waited for must then be what it was.
enum class StartUp : std::uint8_t {
  kOfLogFormat4,
  kOfLogFormat6,  ///< and 5: whether answers come in time is not asked
  kNow,
};

struct MasterConfig {
  std::vector<AxisDriveConfig> axes;
  std::vector<BusConfig> buses;
  std::uint32_t cycle_us = 1000;
  StartUp start_up = StartUp::kNow;
};

/// What is wrong with a drive's answers to SYNC.
enum class AnswerFault : std::uint8_t {
  kNone,
  kTwice,  ///< more of them than SYNCs
  kLate,   ///< each comes a cycle or more late
};

/// What the master knows of a drive beside its feedback.
struct AxisDriveStatus {
  NmtState nmt = NmtState::kUnknown;  ///< by the last heartbeat
  bool configured = false;            ///< brought up and not restarted or lost since
  bool heartbeat_lost = false;        ///< neither heartbeat nor feedback for heartbeat_timeout_ms
  bool restarted = false;             ///< sent a boot-up message since it was brought up
  bool fault = false;                 ///< Fault or Fault Reaction Active
  bool left_enabled = false;     ///< left Operation Enabled without being told to; until the goal changes
  bool transition_late = false;  ///< a transition missed its deadline; until the goal changes
  DriveState stuck_in = DriveState::kUnknown;  ///< the state it stayed in, with transition_late
  std::uint64_t in_state_cycles = 0;           ///< in this state with this goal, at the last Send
  DriveGoal goal = DriveGoal::kDisabled;       ///< of the last Send
  bool at_goal = false;                        ///< the drive's state is what the last goal asked for
  std::uint16_t emergency_code = 0;            ///< last EMCY error code; 0 none, or taken back by the drive
  /// Strongest reaction that an emergency message asks for, until the drive takes it back or StartBringUp. It
  /// acts a cycle after the message: by then the statusword says whether the drive has stopped by itself.
  EmergencyReaction emergency = EmergencyReaction::kNone;
  std::uint16_t emergency_cause = 0;  ///< the code that asks for it
  bool lost_master = false;           ///< said so by an emergency message; until it is brought up or reset
  bool stays_enabled = false;         ///< in Operation Enabled long after it was told to leave that
  AnswerFault answers = AnswerFault::kNone;  ///< until it is brought up
  bool not_following = false;       ///< enabled, but bit 12 or 9 of the statusword is missing for too long
  bool mode_changed = false;        ///< 0x6061 shows another mode than was set; until it is brought up
  std::uint64_t silent_cycles = 0;  ///< since its last sign of life
};

/// The real-time side of CANopen for all axes on all buses: one Receive at the start of a cycle, one Send at
/// its end. Everything is counted in cycles of CycleInput::cycle; no clock, no allocation after construction.
class DriveMaster {
 public:
  using Frames = FixedVector<StampedFrame, kMaxFramesSentPerCycle>;

  /// Sizes everything and writes the SDO scripts. Throws std::invalid_argument with a full message on
  /// nonsense.
  explicit DriveMaster(const MasterConfig& config);

  /// Takes the frames of this cycle: feedback, emergencies, heartbeats, SDO replies.
  void Receive(const CycleInput& in) noexcept;

  /// Feedback of the SYNC before, all axes in the order of the configuration.
  [[nodiscard]] const PerAxis<AxisFeedback>& feedback() const noexcept { return feedback_; }
  [[nodiscard]] const PerAxis<AxisDriveStatus>& status() const noexcept { return status_; }

  /// Brings all drives up again unless all are operational, configured and heard of. Also for a reset after a
  /// fault.
  void StartBringUp() noexcept;
  /// Whether the axis knows where it is. A drive with an incremental encoder has lost that when it restarted,
  /// or may have without being heard. NMT reset communication, which every bring-up sends, takes nothing but
  /// the communication objects back (CiA 301), so the count goes on; a boot-up message that was not asked for
  /// is that of a power-up or a reset node.
  [[nodiscard]] ReferenceState reference(std::size_t axis) const noexcept { return axes_[axis].reference; }
  /// The axis can be told where it is: it counts, its position is known now, and its encoder is not absolute,
  /// or is not believed, or was told before.
  [[nodiscard]] bool CanTellPosition(std::size_t axis) const noexcept;
  /// Where it stands now; feedback() says so from here on. CanTellPosition() before.
  void TellPosition(std::size_t axis, double position_rad) noexcept;
  /// What it counts cannot be believed any more. Nothing, for an absolute encoder.
  void DoubtPosition(std::size_t axis) noexcept;

  /// Another master commands this machine: from now on not a frame, until StartBringUp.
  void FallSilent() noexcept;
  /// Index of a bus on which another master was seen since it was last brought up; kNoBus when there is none.
  [[nodiscard]] std::uint8_t second_master() const noexcept;
  static constexpr std::uint8_t kNoBus = 0xFF;
  /// Whether these frames say that another master is there, which is not known yet.
  [[nodiscard]] bool NewSecondMaster(const ReceivedFrames& frames) const noexcept;
  /// The master's heartbeat goes out on this bus.
  [[nodiscard]] bool HeartbeatRuns(std::size_t bus) const noexcept {
    return started_ && !buses_[bus].bring_up.silent();
  }
  /// Where bringing up stands: the failed node if there is one, else the one furthest behind.
  [[nodiscard]] BringUpStatus bring_up() const noexcept;
  [[nodiscard]] bool bring_up_failed() const noexcept {
    for (const Bus& bus : buses_)
      if (bus.bring_up.failed()) return true;
    return false;
  }
  /// Drives are being found and configured at this moment.
  [[nodiscard]] bool BringingUp() const noexcept;
  /// It is being found out which SYNC the drives' answers belong to.
  [[nodiscard]] bool ProbesAnswers() const noexcept { return probe_.running(); }
  /// By which the SYNC of the newest positions is known to have come later behind the one before than usual.
  [[nodiscard]] double SyncApart_s(std::size_t axis) const noexcept {
    const Bus& bus = buses_[axes_[axis].bus];
    return bus.sync_told_cycle == cycle_ ? bus.sync_apart_s : 0.0;
  }
  /// All drives are Operational and configured; SYNC and PDOs run.
  [[nodiscard]] bool operational() const noexcept;
  /// The drives have a SYNC to answer, since they were last brought up.
  [[nodiscard]] bool sync_sent() const noexcept { return sync_sent_; }
  /// Bringing up is under way, or a drive is on its way to the last goal.
  [[nodiscard]] bool busy() const noexcept;

  /// SYNCs sent on each bus since construction, this cycle's included after Send.
  [[nodiscard]] std::uint64_t sync_number() const noexcept { return sync_number_; }
  /// Periods since the grid point before this one; more than 1 when grid points were skipped.
  [[nodiscard]] std::uint64_t elapsed_cycles() const noexcept { return elapsed_; }
  /// Number of the SYNC that latched the newest feedback of any axis; 0 none yet. Feedback that an older SYNC
  /// latched is not fresh: it came too late.
  [[nodiscard]] std::uint64_t feedback_sync() const noexcept { return feedback_sync_; }

  /// Appends this cycle's frames: per bus RPDOs then SYNC (once operational), then NMT, heartbeat and SDO.
  /// Torque goes out only to a drive in Operation Enabled whose goal is kEnabled; it is 0 otherwise (and for
  /// NaN).
  void Send(const PerAxis<AxisSetpoint>& setpoints, Frames& out) noexcept;
  /// Torque of the last Send as the drives understand it: limited, in whole per mille.
  [[nodiscard]] const PerAxis<double>& sent_torque_Nm() const noexcept { return sent_torque_Nm_; }

  void Keep(StateKeeper& keep) noexcept {
    keep(axes_, buses_, feedback_, status_, sent_torque_Nm_, goal_, cycle_, elapsed_, sync_number_,
         feedback_sync_, sync_grid_ns_, started_, pdos_run_, sync_sent_, seen_cycle_, probe_, settled_);
  }

 private:
  static constexpr std::int64_t kNeverAnswered = INT64_MAX;
  static constexpr std::uint8_t kNoAxis = 0xFF;
  static constexpr std::size_t kNodes = 128;
  struct StrongerReaction {
    EmergencyClass codes;
    EmergencyReaction reaction;
  };
  struct Axis {
    /// What is configured stays as constructed.
    void Keep(StateKeeper& keep) noexcept {
      keep(rounding, unwrap, scale_unwrap, walk, shown_bits, not_following_cycles, let_go_cycles, reported,
           reported_cycle, alive_cycle, answer_cycle, behind, earliest_answer_ns, usual_answer_ns, reference,
           was_enabled, boot_up_due, seen_before, last_seen_rad, last_step_rad, offset_rad, answered_sync,
           unasked, unasked_since, stays_seen_cycles);
    }
    std::uint8_t bus = 0;
    std::uint8_t node_id = 0;
    DriveMode mode = DriveMode::kCst;
    bool torque_offset = false;
    bool has_scale = false;
    TorqueScale torque;
    TorqueRounding rounding;
    PositionScale position;
    double scale_m_per_count = 0.0;
    double torque_limit_Nm = 0.0;
    Unwrap unwrap;
    Unwrap scale_unwrap;
    DriveWalk walk;
    std::vector<StrongerReaction> stronger;  ///< as configured
    std::size_t patrolled = 0;               ///< its place in the patrol of its bus
    std::uint16_t follow_bits = 0;    ///< of the statusword, that an enabled drive has to show, as configured
    std::uint16_t shown_bits = 0;     ///< those, and what it has shown since it is enabled that may not go
    std::uint64_t follow_cycles = 0;  ///< one of them may be missing that long
    std::uint64_t not_following_cycles = 0;
    std::uint64_t obeys_cycles = 0;       ///< from a controlword to the statusword that shows it
    std::uint64_t stays_cycles = 0;       ///< within which it has left Operation Enabled when told to
    std::uint64_t stays_seen_cycles = 0;  ///< for which it has been there longer than that
    std::uint64_t let_go_cycles = 0;      ///< since the goal is not kEnabled any more
    EmergencyReaction reported = EmergencyReaction::kNone;
    std::uint64_t reported_cycle = 0;  ///< when `reported` last grew
    std::uint64_t heartbeat_timeout_cycles = 0;
    std::uint64_t alive_cycle = 0;                     ///< cycle of the last heartbeat or feedback
    std::uint64_t answer_cycle = 0;                    ///< cycle of the last feedback
    bool behind = false;                               ///< that was an answer to the SYNC before
    std::int64_t earliest_answer_ns = kNeverAnswered;  ///< after the grid point whose SYNC it answers
    std::int64_t usual_answer_ns = kNeverAnswered;     ///< the same lately
    ReferenceState reference = ReferenceState::kAbsolute;
    bool absolute = true;        ///< its encoder, as configured
    bool was_enabled = false;    ///< ever, in this daemon's life
    bool boot_up_due = false;    ///< NMT reset communication was sent: its boot-up message is no restart
    bool seen_before = false;    ///< last_seen_rad is there to compare with
    double last_seen_rad = 0.0;  ///< before it was brought up anew
    double last_step_rad = 0.0;  ///< per cycle, between the last two readings
    double unseen_travel_rad = 0.0;
    double coast_cycles2_rad = 0.0;   ///< way of coasting by the square of such a step
    std::uint64_t answered_sync = 0;  ///< as many answers as SYNCs up to this one have come or are lost
    std::uint32_t unasked = 0;        ///< answers that came while no SYNC was unanswered, since the one below
    std::uint64_t unasked_since = 0;
    double offset_rad = 0.0;  ///< from the drive's count to where the axis is
  };
  struct Bus {
    BringUp bring_up;
    DrivePatrol patrol;
    std::uint8_t master_node_id = 127;
    std::uint64_t heartbeat_cycles = 1;
    std::uint64_t heartbeat_due = 0;
    std::int64_t usual_sync_ns = kNeverAnswered;  ///< after its grid point, lately
    double sync_late_s = 0.0;                     ///< beyond that, of the newest
    double sync_apart_s = 0.0;                    ///< beyond a cycle, of the newest and the one before it
    std::uint64_t sync_told_cycle = 0;            ///< in which that was told
    void Keep(StateKeeper& keep) noexcept {
      keep(bring_up, patrol, heartbeat_due, usual_sync_ns, sync_late_s, sync_apart_s, sync_told_cycle);
    }
  };

  void OnFrame(const StampedFrame& frame) noexcept;
  void OnHeartbeat(std::size_t axis, const CanFrame& frame) noexcept;
  void OnEmergency(std::size_t axis, const CanFrame& frame) noexcept;
  void ForgetEmergency(std::size_t axis) noexcept;
  void WatchFollowing(std::size_t axis) noexcept;
  void CountBeganAnew(std::size_t axis) noexcept;
  void FindElsewhere(std::size_t axis, double found_rad) noexcept;
  void CountAnswer(Axis& axis, std::size_t index, bool answered_before) noexcept;
  void WatchAnswers(std::size_t axis) noexcept;
  void WatchStaying(std::size_t axis) noexcept;
  [[nodiscard]] bool Heard(std::size_t axis) const noexcept;
  void OnFeedback(std::size_t axis, const StampedFrame& stamped) noexcept;
  bool AnswersNewestSync(Axis& axis, const AxisFeedback& feedback, std::int64_t stamp_ns) const noexcept;
  void OnOwnSync(Bus& bus, std::int64_t stamp_ns) noexcept;
  void TellLateness(std::size_t axis, std::int64_t stamp_ns) noexcept;
  [[nodiscard]] bool AfterSync(std::int64_t stamp_ns) const noexcept {
    return stamp_ns > sync_grid_ns_ && stamp_ns <= sync_grid_ns_ + period_ns_;
  }
  [[nodiscard]] double Late_s(std::int64_t& usual_ns, std::int64_t stamp_ns) const noexcept;
  void Supervise(std::size_t axis) noexcept;
  void StartPdos() noexcept;
  void StopPdos() noexcept;
  void Settle() noexcept;
  CanFrame SetpointFrame(std::size_t axis, const AxisSetpoint& setpoint) noexcept;
  [[nodiscard]] bool Healthy(std::size_t axis) const noexcept;
  [[nodiscard]] bool IgnoresUs(std::size_t axis) const noexcept;

  std::size_t axis_count_;  ///< what axes_.size() would divide for, in every loop
  std::vector<Axis> axes_;
  std::vector<Bus> buses_;
  PerAxis<AxisFeedback> feedback_;
  PerAxis<AxisDriveStatus> status_;
  PerAxis<double> sent_torque_Nm_;
  std::array<DriveGoal, kMaxAxes> goal_{};  ///< of the last Send
  std::vector<std::uint8_t> axis_of_node_;  ///< [bus * 128 + node]; kNoAxis where none
  std::uint64_t cycle_ = 0;
  std::uint64_t elapsed_ = 1;  ///< cycles since the one before; more than 1 when grid points were skipped
  std::uint64_t sync_number_ = 0;
  std::uint64_t feedback_sync_ = 0;
  std::int64_t grid_ns_ = 0;       ///< this grid point
  std::int64_t sync_grid_ns_ = 0;  ///< the grid point of the newest SYNC
  std::int64_t period_ns_;
  AnswerProbe probe_;
  bool probes_;           ///< by it
  bool patrols_;          ///< drives are asked while they run
  bool started_ = false;  ///< ever brought up: the master's heartbeat runs
  bool pdos_run_ = false;
  bool sync_sent_ = false;
  bool seen_cycle_ = false;
  bool settled_ = false;  ///< PDOs run, and it is known which SYNC each drive answers
};

}  // namespace contour
