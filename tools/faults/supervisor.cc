#include "tools/faults/supervisor.h"

namespace contour::faults {
namespace {

constexpr std::size_t kRuns = 8;

}  // namespace

const std::vector<Supervisor>& Supervisors() {
  using F = Fault;
  using R = Reason;
  using W = Watch;
  using enum Phase;
  constexpr WatchesOff kOfMotion{W::kJump, W::kMomentum, W::kDelivery, W::kFrozen};
  constexpr WatchesOff kOfReadings{W::kJump, W::kMomentum, W::kDelivery, W::kFrozen, W::kFollowingError};
  static const std::vector<Supervisor> all{
      {W::kFrozen, "a reading that stands", F::kEncoderFrozen, kConstant, 1.0, R::kFeedbackFrozen, {}},
      {W::kJump, "a reading against its prediction", F::kEncoderJump, kConstant, 50.0, R::kFeedbackJump, {}},
      {W::kMomentum, "motion against torque", F::kEncoderReversed, kConstant, 1.0, R::kFeedbackReversed, {}},
      {W::kDelivery,
       "the torque that the drive reports",
       F::kTorqueLost,
       kConstant,
       50.0,
       R::kTorqueNotDelivered,
       {}},
      {W::kScale,
       "motor against linear scale",
       F::kEncoderJump,
       kConstant,
       50.0,
       R::kScaleDisagrees,
       {W::kJump, W::kMomentum, W::kFollowingError},
       true},
      {W::kStaleFeedback,
       "cycles without feedback",
       F::kFeedbackFramesLost,
       kConstant,
       50.0,
       R::kStaleFeedback,
       {}},
      {W::kVelocityLimit, "speed", F::kPositionBitTop, kConstant, 50.0, R::kVelocityLimit, kOfMotion},
      {W::kPositionLimit,
       "travel",
       F::kPositionBitTop,
       kConstant,
       50.0,
       R::kPositionLimit,
       {W::kJump, W::kMomentum, W::kDelivery, W::kFrozen, W::kVelocityLimit, W::kFollowingError}},
      {W::kFollowingError, "distance to the path", F::kTorqueLostSilently, kConstant, 50.0,
       R::kFollowingError, kOfMotion},
      {W::kDriveFault, "a drive in Fault", F::kDriveFault, kConstant, 50.0, R::kDriveFault, {}},
      {W::kDriveLeftEnabled,
       "a drive that is not enabled any more",
       F::kDriveDropsOut,
       kConstant,
       50.0,
       R::kDriveLeftEnabled,
       {}},
      {W::kDriveNotFollowing,
       "statusword bit 12",
       F::kDriveWrongMode,
       kConstant,
       50.0,
       R::kDriveNotFollowing,
       {}},
      {W::kModeChanged,
       "the mode shown (0x6061)",
       F::kDriveWrongMode,
       kReady,
       50.0,
       R::kModeChanged,
       {W::kDriveNotFollowing, W::kMomentum, W::kDelivery}},
      {W::kDriveEmergency,
       "emergency messages of drives that go on",
       F::kEmergencyTemperature,
       kConstant,
       50.0,
       R::kDriveEmergency,
       {}},
      {W::kDriveLostMaster,
       "drives that say that they lost their master",
       F::kSetpointsLost,
       kConstant,
       50.0,
       R::kDriveLostMaster,
       {}},
      {W::kDriveRestarted, "boot-up messages", F::kDriveRestarts, kIdle, 50.0, R::kDriveRestarted, {}},
      {W::kDriveLeftOperational,
       "NMT states",
       F::kDriveLeavesOperational,
       kIdle,
       50.0,
       R::kDriveLeftOperational,
       {}},
      {W::kHeartbeatLost,
       "drives that are silent",
       F::kFlood,
       kIdle,
       50.0,
       R::kHeartbeatLost,
       {W::kSendFailed}},
      {W::kBusDown, "interfaces that are down", F::kBusDown, kConstant, 50.0, R::kBusDown, {}},
      {W::kSendFailed,
       "interfaces that take no frames",
       F::kBusDown,
       kConstant,
       50.0,
       R::kSendFailed,
       {W::kBusDown}},
      {W::kSecondMaster,
       "frames that only a master sends",
       F::kForeignSync,
       kConstant,
       50.0,
       R::kSecondMaster,
       {}},
      {W::kGridPointsSkipped, "grid points at which nothing was sent", F::kGridPointsSkipped, kConstant, 50.0,
       R::kGridPointsSkipped, kOfReadings},
      {W::kSelfWatch, "the cycle's eye on itself", F::kCyclesLate, kConstant, 2.0, R::kCyclesLate, {}},
  };
  return all;
}

const Supervisor* FindSupervisor(std::string_view name) {
  for (const Supervisor& s : Supervisors())
    if (Name(s.watch) == name) return &s;
  return nullptr;
}

PlanRequest ProofOf(const Supervisor& supervisor) {
  PlanRequest plan;
  plan.runs = kRuns;
  plan.feed_mm_s = supervisor.feed_mm_s;
  plan.only = {std::string(Name(supervisor.fault)), std::string(Name(supervisor.phase)), "cst"};
  return plan;
}

}  // namespace contour::faults
