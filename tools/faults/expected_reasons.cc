#include "tools/faults/expected_reasons.h"

namespace contour::faults {
namespace {

using F = Fault;
using R = Reason;
using enum Outcome;

// clang-format off
constexpr std::array kRows{
    //          fault                        at rest   moving    reasons, warning
    Expectation{F::kFeedbackFrameLost,       kGoesOn,  kGoesOn,  {}},
    Expectation{F::kFeedbackFramesLost,      kStops,   kStops,   {R::kStaleFeedback}},
    Expectation{F::kFeedbackFrameLate,       kGoesOn,  kGoesOn,  {}},
    Expectation{F::kFeedbackFramesLate,      kStops,   kStops,   {R::kStaleFeedback, R::kAnswersLate}},
    Expectation{F::kFeedbackFrameTwice,      kGoesOn,  kGoesOn,  {}},
    Expectation{F::kPositionBitLow,          kGoesOn,  kGoesOn,  {}},
    Expectation{F::kPositionBitHigh,         kMayStop, kMayStop, {R::kFeedbackJump, R::kVelocityLimit}},
    Expectation{F::kStatusBitEnabled,        kMayStop, kMayStop, {R::kDriveLeftEnabled, R::kDriveNotFollowing}},
    Expectation{F::kStatusBitFault,          kMayStop, kMayStop, {R::kDriveFault, R::kDriveLeftEnabled}},
    Expectation{F::kSetpointLost,            kGoesOn,  kGoesOn,  {}},
    Expectation{F::kSetpointsLost,           kStops,   kStops,   {R::kDriveLostMaster, R::kDriveLeftEnabled}},
    Expectation{F::kHeartbeatsLost,          kMayStop, kMayStop,  {R::kHeartbeatLost}},
    Expectation{F::kBusDown,                 kStops,   kStops,   {R::kBusDown, R::kSendFailed}},
    Expectation{F::kFloodBurst,              kMayStop, kMayStop, {R::kStaleFeedback, R::kFeedbackJump}},
    Expectation{F::kFlood,                   kStops,   kStops,   {R::kStaleFeedback, R::kSendFailed}},
    Expectation{F::kForeignReset,            kStops,   kStops,   {R::kSecondMaster, R::kDriveRestarted}},
    Expectation{F::kForeignSync,             kStops,   kStops,   {R::kSecondMaster}},
    Expectation{F::kForeignNmt,              kStops,   kStops,   {R::kSecondMaster}},
    Expectation{F::kForeignSetpoint,         kStops,   kStops,   {R::kSecondMaster}},
    Expectation{F::kForeignHeartbeat,        kStops,   kStops,   {R::kSecondMaster}},
    Expectation{F::kForeignSdo,              kGoesOn,  kGoesOn,  {}},
    Expectation{F::kDriveRestarts,           kStops,   kStops,   {R::kDriveRestarted, R::kStaleFeedback}},
    Expectation{F::kDriveLeavesOperational,  kStops,   kStops,   {R::kDriveLeftOperational, R::kStaleFeedback}},
    Expectation{F::kDriveDropsOut,           kStops,   kStops,   {R::kDriveLeftEnabled, R::kDriveNotFollowing}},
    Expectation{F::kDriveWrongMode,          kStops,   kStops,   {R::kModeChanged, R::kDriveNotFollowing}},
    Expectation{F::kDriveFault,              kStops,   kStops,   {R::kDriveFault, R::kDriveEmergency}},
    Expectation{F::kEmergencyTemperature,    kStops,   kStops,   {R::kDriveEmergency}},
    Expectation{F::kEmergencyCurrent,        kStops,   kStops,   {R::kDriveEmergency}},
    Expectation{F::kEmergencyVoltage,        kStops,   kStops,   {R::kDriveEmergency}},
    Expectation{F::kEmergencyEncoder,        kStops,   kStops,   {R::kDriveEmergency}},
    Expectation{F::kEmergencyLostMaster,     kStops,   kStops,   {R::kDriveLostMaster, R::kDriveEmergency}},
    Expectation{F::kEmergencyExternal,       kMayStop, kMayStop, {R::kDriveEmergency}},
    Expectation{F::kEmergencyMaker,          kMayStop, kMayStop, {R::kDriveEmergency}},
    Expectation{F::kEmergencyCleared,        kGoesOn,  kGoesOn,  {}},
    Expectation{F::kEncoderReversed,         kMayStop, kStops,   {R::kFeedbackReversed, R::kFeedbackJump}},
    Expectation{F::kEncoderJumpTiny,         kGoesOn,  kGoesOn,  {}},
    Expectation{F::kEncoderJump,             kStops,   kStops,   {R::kFeedbackJump, R::kFollowingError}},
    Expectation{F::kEncoderJumpLarge,        kStops,   kStops,   {R::kFeedbackJump, R::kFollowingError}},
    Expectation{F::kEncoderFrozen,           kMayStop, kStops,   {R::kFeedbackFrozen, R::kTorqueWithoutMotion}},
    Expectation{F::kEncoderFlickers,         kMayStop, kStops,   {R::kFeedbackFrozen, R::kTorqueWithoutMotion}},
    Expectation{F::kTorqueLost,              kMayStop, kStops,   {R::kTorqueNotDelivered, R::kTorqueWithoutMotion}},
    Expectation{F::kTorqueLostSilently,      kMayStop, kStops,   {R::kTorqueWithoutMotion, R::kFollowingError}},
    Expectation{F::kTorqueHalved,            kGoesOn,  kGoesOn,  {}},
    Expectation{F::kLogBlocked,              kGoesOn,  kGoesOn,  {}},
    Expectation{F::kBusTraffic,              kGoesOn,  kGoesOn,  {}},
    Expectation{F::kGridPointsSkipped,       kMayStop, kStops,   {R::kGridPointsSkipped, R::kFeedbackJump}},
    Expectation{F::kCyclesLate,              kStops,   kStops,   {R::kCyclesLate, R::kFollowingError}},
    Expectation{F::kPositionBitTop,          kMayStop, kMayStop, {R::kFeedbackJump, R::kVelocityLimit}},
    Expectation{F::kScaleSilent,             kStops,   kStops,   {R::kScaleLost}},
    Expectation{F::kScaleFrozen,             kMayStop, kMayStop, {R::kScaleDoubted, R::kScaleDisagrees}},
    Expectation{F::kScaleReversed,           kMayStop, kMayStop, {R::kScaleDoubted, R::kScaleDisagrees}},
    Expectation{F::kScaleJump,               kStops,   kStops,   {R::kScaleDoubted, R::kScaleDisagrees}},
    Expectation{F::kScaleCountsLess,         kMayStop, kMayStop, {R::kScaleDoubted, R::kScaleDisagrees}},
    Expectation{F::kEncoderCountsLess,       kMayStop, kMayStop, {R::kScaleDoubted, R::kScaleDisagrees}},
};
// clang-format on

constexpr bool InOrder() {
  for (std::size_t i = 0; i < kRows.size(); ++i)
    if (kRows[i].fault != kFaults[i].fault || kFaults[i].fault != static_cast<Fault>(i)) return false;
  return true;
}
static_assert(kRows.size() == kFaultCount && InOrder(), "a row for each fault, in their order");

}  // namespace

const Expectation& ExpectationOf(Fault fault) noexcept { return kRows[static_cast<std::size_t>(fault)]; }

ExpectedHere ExpectedIn(Fault fault, Phase phase, bool crawls) noexcept {
  Expectation row = ExpectationOf(fault);
  if (crawls && fault == F::kTorqueLostSilently) row.reasons = {R::kTorqueWithoutMotion, R::kFeedbackFrozen};
  // A stop on the path may be over before its motion shows what shows at rest only by chance.
  // Nor need one that only just begins again.
  if (phase == Phase::kStopping || phase == Phase::kResuming)
    return {row.at_rest == kMayStop ? kMayStop : row.moving, row.reasons};
  if (Holds(phase)) return {Moves(phase) ? row.moving : row.at_rest, row.reasons};
  // A tool that speaks to a drive before we do may be another master: the start is refused.
  if (fault == F::kForeignSdo && phase == Phase::kBringUp)
    return {kMayStop, {R::kSecondMaster}, R::kBringUpFailed};
  // What nothing may stop for in motion stops nothing here either.
  if (row.moving == kGoesOn) return {kGoesOn, {}};
  switch (phase) {
    case Phase::kBringUp:
    case Phase::kReset:
      return {kMayStop, row.reasons, R::kBringUpFailed};
    case Phase::kEnabling:
      return {kMayStop, row.reasons, R::kEnableTimeout};
    default:
      return {kMayStop, row.reasons};
  }
}

}  // namespace contour::faults
