#include "tools/faults/expected_reasons.h"

namespace contour::faults {
namespace {

using enum Fault;
using enum Outcome;
using enum Reason;

// clang-format off
constexpr std::array kRows{
    //           fault                    at rest   moving    reasons                                          warning
    Expectation{kFeedbackFrameLost,      kGoesOn,  kGoesOn,  {}},
    Expectation{kFeedbackFramesLost,     kStops,   kStops,   {kStaleFeedback}},
    Expectation{kFeedbackFrameLate,      kGoesOn,  kGoesOn,  {}},
    Expectation{kFeedbackFramesLate,     kStops,   kStops,   {kStaleFeedback}},
    Expectation{kFeedbackFrameTwice,     kGoesOn,  kGoesOn,  {}},
    Expectation{kPositionBitLow,         kGoesOn,  kGoesOn,  {}},
    Expectation{kPositionBitHigh,        kMayStop, kMayStop, {kFeedbackJump, kVelocityLimit}},
    Expectation{kStatusBitEnabled,       kMayStop, kMayStop, {kDriveLeftEnabled, kDriveNotFollowing}},
    Expectation{kStatusBitFault,         kMayStop, kMayStop, {Reason::kDriveFault, kDriveLeftEnabled}},
    Expectation{kSetpointLost,           kGoesOn,  kGoesOn,  {}},
    Expectation{kSetpointsLost,          kStops,   kStops,   {kDriveLostMaster, kDriveLeftEnabled}},
    Expectation{kHeartbeatsLost,         kStops,   kStops,   {kHeartbeatLost}},
    Expectation{Fault::kBusDown,         kStops,   kStops,   {Reason::kBusDown, kSendFailed}},
    Expectation{kFloodBurst,             kMayStop, kMayStop, {kStaleFeedback, kFeedbackJump}},
    Expectation{kFlood,                  kStops,   kStops,   {kStaleFeedback, kSendFailed}},
    Expectation{kForeignReset,           kStops,   kStops,   {kSecondMaster, kDriveRestarted}},
    Expectation{kForeignSync,            kStops,   kStops,   {kSecondMaster}},
    Expectation{kForeignNmt,             kStops,   kStops,   {kSecondMaster}},
    Expectation{kForeignSetpoint,        kStops,   kStops,   {kSecondMaster}},
    Expectation{kForeignHeartbeat,       kStops,   kStops,   {kSecondMaster}},
    Expectation{Fault::kForeignSdo,      kGoesOn,  kGoesOn,  {},                                              Reason::kForeignSdo},
    Expectation{kDriveRestarts,          kStops,   kStops,   {kDriveRestarted, kStaleFeedback}},
    Expectation{kDriveLeavesOperational, kStops,   kStops,   {kDriveLeftOperational, kStaleFeedback}},
    Expectation{kDriveDropsOut,          kStops,   kStops,   {kDriveLeftEnabled, kDriveNotFollowing}},
    Expectation{kDriveWrongMode,         kStops,   kStops,   {kModeChanged, kDriveNotFollowing}},
    Expectation{Fault::kDriveFault,      kStops,   kStops,   {Reason::kDriveFault, kDriveEmergency}},
    Expectation{kEmergencyTemperature,   kStops,   kStops,   {kDriveEmergency}},
    Expectation{kEmergencyCurrent,       kStops,   kStops,   {kDriveEmergency}},
    Expectation{kEmergencyVoltage,       kStops,   kStops,   {kDriveEmergency}},
    Expectation{kEmergencyEncoder,       kStops,   kStops,   {kDriveEmergency}},
    Expectation{kEmergencyLostMaster,    kStops,   kStops,   {kDriveLostMaster, kDriveEmergency}},
    Expectation{kEmergencyExternal,      kMayStop, kMayStop, {kDriveEmergency}},
    Expectation{kEmergencyMaker,         kMayStop, kMayStop, {kDriveEmergency}},
    Expectation{kEmergencyCleared,       kGoesOn,  kGoesOn,  {}},
    Expectation{kEncoderReversed,        kMayStop, kStops,   {kFeedbackReversed, kFeedbackJump}},
    Expectation{kEncoderJumpTiny,        kGoesOn,  kGoesOn,  {}},
    Expectation{kEncoderJump,            kStops,   kStops,   {kFeedbackJump, kFollowingError}},
    Expectation{kEncoderJumpLarge,       kStops,   kStops,   {kFeedbackJump, kFollowingError}},
    Expectation{kEncoderFrozen,          kMayStop, kStops,   {kFeedbackFrozen, kTorqueWithoutMotion}},
    Expectation{kEncoderFlickers,        kMayStop, kStops,   {kFeedbackFrozen, kTorqueWithoutMotion}},
    Expectation{kTorqueLost,             kMayStop, kStops,   {kTorqueNotDelivered, kTorqueWithoutMotion}},
    Expectation{kTorqueLostSilently,     kMayStop, kStops,   {kTorqueWithoutMotion, kFollowingError}},
    Expectation{kTorqueHalved,           kGoesOn,  kGoesOn,  {},                                              kTorqueConstantChanged},
    Expectation{kLogBlocked,             kGoesOn,  kGoesOn,  {}},
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

ExpectedHere ExpectedIn(Fault fault, Phase phase) noexcept {
  const Expectation& row = ExpectationOf(fault);
  if (Holds(phase)) return {Moves(phase) ? row.moving : row.at_rest, row.reasons};
  // What nothing may stop for in motion stops nothing here either.
  if (row.moving == kGoesOn) return {kGoesOn, {}};
  switch (phase) {
    case Phase::kBringUp:
    case Phase::kReset:
      return {kMayStop, {row.reasons[0], kBringUpFailed}};
    case Phase::kEnabling:
      return {kMayStop, {row.reasons[0], kEnableTimeout}};
    default:
      return {kMayStop, row.reasons};
  }
}

}  // namespace contour::faults
