#include "tools/faults/supervisor.h"

#include <limits>

namespace contour::faults {
namespace {

constexpr double kNever = std::numeric_limits<double>::max();

void NoFollowingError(CycleConfig& c) {
  for (CycleAxisConfig& a : c.axes) a.limits.following_error_mm = kNever;
}

void NoStaleness(CycleConfig& c) { c.control.guard.stale_cycles = std::numeric_limits<std::int32_t>::max(); }

template <Reason... kReasons>
void Unsupervised(CycleConfig& c) {
  c.unsupervised.insert(c.unsupervised.end(), {kReasons...});
}

}  // namespace

const std::vector<Supervisor>& Supervisors() {
  using R = Reason;
  static const std::vector<Supervisor> all{
      {"frozen", "the motion monitor's check of a standing encoder",
       [](CycleConfig& c) { c.control.monitor.frozen = false; }, Fault::kEncoderFrozen, Phase::kConstant,
       1.0},
      {"jump", "its check of a reading against its prediction",
       [](CycleConfig& c) { c.control.monitor.jump = false; }, Fault::kEncoderJump},
      {"momentum", "its check of motion against torque",
       [](CycleConfig& c) { c.control.monitor.momentum = false; }, Fault::kEncoderReversed, Phase::kConstant,
       1.0},
      {"delivery", "its check of the reported torque",
       [](CycleConfig& c) { c.control.monitor.delivery = false; }, Fault::kTorqueLost, Phase::kConstant, 50.0,
       false},
      {"following_error", "the guard's distance to the path", NoFollowingError, Fault::kTorqueLostSilently,
       Phase::kConstant, 50.0, false},
      {"stale_feedback", "the guard's count of cycles without feedback", NoStaleness,
       Fault::kFeedbackFramesLost},
      {"emergencies", "emergency messages of drives that go on", Unsupervised<R::kDriveEmergency>,
       Fault::kEmergencyTemperature},
      {"drive_states", "drives in Fault or not enabled any more",
       Unsupervised<R::kDriveFault, R::kDriveLeftEnabled>, Fault::kDriveDropsOut},
      {"not_following", "statusword bit 12 and the mode shown (0x6061)",
       Unsupervised<R::kDriveNotFollowing, R::kModeChanged>, Fault::kDriveWrongMode},
      {"lost_drives", "boot-up, NMT state, heartbeat, and drives that lost their master",
       Unsupervised<R::kDriveRestarted, R::kDriveLeftOperational, R::kHeartbeatLost, R::kDriveLostMaster>,
       Fault::kDriveRestarts, Phase::kIdle, 50.0, false},
      {"bus", "interfaces that are down or take no frames", Unsupervised<R::kBusDown, R::kSendFailed>,
       Fault::kBusDown},
  };
  return all;
}

const Supervisor* FindSupervisor(std::string_view name) {
  for (const Supervisor& s : Supervisors())
    if (s.name == name) return &s;
  return nullptr;
}

}  // namespace contour::faults
