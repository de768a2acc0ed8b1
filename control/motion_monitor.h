#pragma once

#include <array>
#include <cstdint>

#include "control/drive_push.h"
#include "control/motion_thresholds.h"
#include "control/report_turns.h"
#include "control/screw_swing.h"
#include "control/swing_ahead.h"
#include "control/torque_constant_watch.h"
#include "core/reason.h"
#include "core/state_keeper.h"
#include "core/watch.h"

namespace contour {

/// What one axis showed at one SYNC, and what acted on it.
struct MotionSample {
  bool enabled = false;  ///< the axis is held: torque acts
  bool fresh = false;
  bool late = false;          ///< the SYNC of this sample was sent late
  std::uint32_t periods = 1;  ///< since the sample before; more than 1 when SYNCs were left out between them
  double position_m = 0.0;    ///< R theta
  double sent_force_N = 0.0;  ///< of the cycle before: it begins to act at this sample
  double reported_force_N = 0.0;  ///< 0x6077 of this sample
  double reference_m = 0.0;       ///< of this sample
  double lead_m = 0.0;            ///< csp: by which the drive was told to be ahead of it
  double spring_N_m = 0.0;        ///< above 0: an experiment holds the axis by this stiffness
  bool has_scale = false;
  double table_position_m = 0.0;
};

/// Holds motion against torque, one axis. It knows mass, friction and encoder within stated bounds and asks
/// whether what the encoder says can be true under the torque that acted. It is no estimator: what it takes
/// for granted does not learn, so nothing can teach it a fault.
///
/// - frozen: the reading stands, or only flickers, although the reference went further than the loop can
/// bear, and where a drive closes the loop what it is told has, too: the wind-up that it is told to lead by
/// may change against the path;
///   or it stands under a torque that changed by more than friction and outside forces explain;
/// - jump: the reading is further from its prediction than any force can take the motor, and no swing of
///   motor and table that was under way does (SwingAhead);
/// - momentum: u - m a, low-passed, is the force that neither torque nor motion explain (De Luca et al.,
///   collision detection by generalised momentum); beyond friction, outside forces and what motor and table
///   swing by against each other (ScrewSwing) it is torque without motion, or motion against the torque, or
///   a loop that swings where the readings come back (SwingAhead);
/// - delivery: the drive reports another torque than it was sent;
/// - scale: table and motor are further apart than the screw can wind up.
class MotionMonitor {
 public:
  MotionMonitor(const MonitoredAxis& axis, const MonitorConfig& config, double period_s,
                WatchesOff off = {}) noexcept;

  /// Once per cycle. kNone, or what cannot be.
  Reason Step(const MotionSample& sample) noexcept;

  /// Another loop holds the axis from now on: other gains, softened ones, or another controller.
  void UseLoop(double loop_Hz) noexcept { contour::UseLoop(loop_Hz, axis_, period_s_, t_); }

  /// What has been seen; what is known of the axis stays as constructed, and the loop as last told.
  void Keep(StateKeeper& keep) noexcept {
    keep(watch_, until_learning_, readings_, position_m_, velocity_m_s_, waited_periods_, last_gap_periods_,
         believed_, late_readings_, held_, forces_N_, report_before_N_, peak_N_, slow_force_N_,
         slower_force_N_, rest_least_N_, rest_most_N_, drive_push_, same_turns_, near_turns_, turns_N_,
         settling_N_, least_N_, most_N_, same_, same_reference_m_, same_lead_m_, near_, near_position_m_,
         near_reference_m_, near_lead_m_, near_periods_, least_lead_m_, most_lead_m_, near_braked_,
         near_least_N_, near_most_N_, same_gone_, near_gone_, pushed_least_N_, pushed_most_N_,
         pushed_periods_, on_its_way_N_, ringing_N_, swing_, swing_ahead_, force_N_, unexplained_N_,
         jitter_N_, beyond_, beyond_rigid_, contradiction_, sent_N_, reported_N_, report_seen_, undelivered_,
         tells_none_, doubt_, doubt_lasts_, doubt_hidden_, astray_m_, scale_seen_, scale_apart_,
         scale_offset_m_, scale_begin_m_);
  }

  /// The newest reading lies where forces can have taken the axis. One that does not, by a little, may come
  /// of a SYNC that came late: nothing should be learnt from it.
  [[nodiscard]] bool believed() const noexcept { return believed_; }

  [[nodiscard]] const MotionThresholds& thresholds() const noexcept { return t_; }
  /// Why the encoder is in doubt, for an axis that exceeds a limit: torque_without_motion, feedback_reversed,
  /// oscillation or kNone.
  [[nodiscard]] Reason Doubt() const noexcept;
  /// Torque constant or mass are not what was stated. To be told, not to be acted upon.
  [[nodiscard]] bool torque_constant_changed() const noexcept { return watch_.changed(); }
  /// Force per acceleration, over what was stated.
  [[nodiscard]] double torque_ratio() const noexcept { return watch_.ratio(); }

 private:
  // Inline: once per axis and cycle, and only from here.
  inline void Push(const MotionSample& s) noexcept;
  inline void SeePeak(double force_N, double spread_N) noexcept;
  [[nodiscard]] double Acting_N() const noexcept { return forces_N_[axis_.delay_cycles]; }
  inline Reason Judge(const MotionSample& s) noexcept;
  inline Reason Jump(const MotionSample& s, double force_N) noexcept;
  inline Reason Frozen(const MotionSample& s) noexcept;
  inline void SeeLead(double lead_m) noexcept;
  inline bool AtRest(const MotionSample& s) noexcept;
  inline bool Pushed(const MotionSample& s, double settling_N) noexcept;
  inline Reason Named(Reason found, const MotionSample& s, double force_N) noexcept;
  inline Reason Momentum(double velocity_m_s, double explained_N, bool stands) noexcept;
  [[nodiscard]] inline Reason Contradiction(double velocity_m_s, bool stands, bool driven) const noexcept;
  inline void KeepDoubt(const MotionSample& s, double velocity_m_s, double explained_N) noexcept;
  inline void Learn(double velocity_m_s) noexcept;
  inline Reason Delivery(const MotionSample& s) noexcept;
  inline Reason DeliveryInCascade(const MotionSample& s) noexcept;
  inline Reason Scale(const MotionSample& s) noexcept;
  void Restart(const MotionSample& s) noexcept;

  MonitoredAxis axis_;
  MonitorConfig config_;
  WatchesOff off_;
  MotionThresholds t_;
  double period_s_;
  TorqueConstantWatch watch_;
  std::uint32_t until_learning_ = 0;

  // Readings, also of an axis that is not held.
  std::uint32_t readings_ = 0;        ///< 0, 1, 2: how many of the two below are there
  double position_m_ = 0.0;           ///< the newest reading
  double velocity_m_s_ = 0.0;         ///< between it and the one before
  std::uint32_t waited_periods_ = 0;  ///< since the newest reading
  std::uint32_t last_gap_periods_ = 1;
  bool believed_ = true;
  std::uint32_t late_readings_ = 0;  ///< that a late SYNC is still part of
  // The rest begins anew whenever the axis is enabled.
  bool held_ = false;
  std::array<double, 8> forces_N_{};  ///< sent, newest first
  double report_before_N_ = 0.0;
  double peak_N_ = 0.0;
  double slow_force_N_ = 0.0;  ///< for the frozen encoder
  double slower_force_N_ = 0.0;
  double rest_least_N_ = 0.0, rest_most_N_ = 0.0;  ///< of the force, at rest, since the reading last changed
  DrivePush drive_push_;                           ///< csp
  ReportTurns same_turns_, near_turns_;            ///< csp: since the reading last changed, left its band
  double turns_N_ = 0.0;                           ///< of either, lately, fading
  double settling_N_ = 0.0;                        ///< largest recent change of the force, fading
  double least_N_ = 0.0, most_N_ = 0.0;            ///< of the force, since the reading last changed
  std::uint32_t same_ = 0;                         ///< periods since then
  double same_reference_m_ = 0.0;                  ///< the reference when that began
  double same_lead_m_ = 0.0;                       ///< and its lead
  bool near_ = false;                              ///< the reading has been near the one below
  double near_position_m_ = 0.0;
  double near_reference_m_ = 0.0;  ///< the reference when that began
  double near_lead_m_ = 0.0;
  std::uint32_t near_periods_ = 0;
  double least_lead_m_ = 0.0, most_lead_m_ = 0.0;  ///< reading less reference, where it moves; soon forgotten
  double near_least_N_ = 0.0, near_most_N_ = 0.0;  ///< of the force, since then
  bool near_braked_ = false;                       ///< and since then it has only come down
  double pushed_least_N_ = 0.0, pushed_most_N_ = 0.0;  ///< the same, fading, once it has stood for a while
  std::uint32_t pushed_periods_ = 0;             ///< that it has changed by more than a standing axis bears
  std::uint32_t same_gone_ = 0, near_gone_ = 0;  ///< periods that the reference has been too far for that
  double on_its_way_N_ = 0.0;                    ///< low-passed: a period's change of the torque
  double ringing_N_ = 0.0;                       ///< csp: that changes of torque leave in the filtered force
  ScrewSwing swing_;                             ///< of motor and table
  SwingAhead swing_ahead_;                       ///< of the next reading
  double force_N_ = 0.0;                         ///< low-passed torque
  double unexplained_N_ = 0.0;                   ///< low-passed u - m a
  double jitter_N_ = 0.0;                        ///< of it, what a SYNC that came late may have made
  std::uint32_t beyond_ = 0;                     ///< readings in a row
  std::uint32_t beyond_rigid_ = 0;               ///< the same, of an axis with no screw
  Reason contradiction_ = Reason::kNone;         ///< what the first of them said
  double sent_N_ = 0.0, reported_N_ = 0.0;       ///< low-passed, for delivery
  bool report_seen_ = false;                     ///< the report has been seen to be one, in this enabling
  bool tells_none_ = false;                      ///< a report that has been seen shows no torque
  Reason doubt_ = Reason::kNone;                 ///< see Doubt()
  std::uint32_t doubt_hidden_ = 0;               ///< periods that a swing of the screw may still hide why
  bool doubt_lasts_ = false;                     ///< until the axis strays no further
  double astray_m_ = 0.0;                        ///< from the reference, at the reading before
  std::uint32_t undelivered_ = 0;                ///< periods in a row
  bool scale_seen_ = false;
  std::uint32_t scale_apart_ = 0;  ///< samples in a row
  double scale_offset_m_ = 0.0, scale_begin_m_ = 0.0;
};

/// Whether after this fault no ramp of the drive's will do: the encoder it would go by cannot be believed, or
/// the torque is not there. Where scale and encoder contradict each other it may be either; our own loop has
/// brought the axis to rest before.
constexpr bool RampInDoubt(Reason r) noexcept {
  return r == Reason::kFeedbackFrozen || r == Reason::kFeedbackJump || r == Reason::kFeedbackReversed ||
         r == Reason::kTorqueWithoutMotion || r == Reason::kTorqueNotDelivered ||
         r == Reason::kScaleDisagrees || r == Reason::kScaleDoubted;
}

}  // namespace contour
