#include "tools/contour/commission_record.h"

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <utility>

#include "analysis/recording/record_axis.h"
#include "daemon/control_socket/base64.h"
#include "design/drive_motions.h"
#include "drivers/cia402/mode_for.h"
#include "drivers/lcm/cycle_messages.h"
#include "tools/contour/daemon_link.h"
#include "tools/contour/stop_signals.h"

namespace contour {
namespace {

using nlohmann::json;

constexpr std::chrono::milliseconds kLookEvery{100};
constexpr std::chrono::seconds kEnableLimit{60};
constexpr std::chrono::seconds kLastRows{5};

/// Takes every cycle from the daemon and watches that the axis keeps to what the operator allowed.
class Watchman {
 public:
  Watchman(ControlClient& client, std::size_t axis, double period_s, const RecordedTorque& torque,
           CommissionPlan plan, double radius_m_rad)
      : axis_(axis),
        reported_(torque.reported),
        plan_(std::move(plan)),
        recorder_(axis, period_s, torque),
        drive_recorder_(axis, radius_m_rad) {
    client.OnMessage([this](const json& message) { OnMessage(message); });
    AskOrThrow(client, {{"request", "rows"}, {"on", true}});
  }
  [[nodiscard]] const std::string& offence() const { return offence_; }
  [[nodiscard]] std::uint64_t newest_cycle() const { return newest_cycle_; }
  [[nodiscard]] std::uint64_t lost() const { return lost_; }
  AxisRecorder& recorder() { return recorder_; }
  [[nodiscard]] const std::vector<DriveSample>& drive_samples() const { return drive_recorder_.samples(); }

 private:
  void OnMessage(const json& message) {
    if (!message.contains("rows")) return;
    lost_ = message.at("lost");
    for (const json& text : message.at("rows")) {
      const auto row = FromBase64(text.get<std::string>());
      contour_lcm::cycle_entry raw{};
      if (!row || !Decode(*row, raw) || !FromMessage(raw, entry_))
        throw std::runtime_error(
            "contourd sends rows that this program cannot read; are they of one version?");
      newest_cycle_ = entry_.output.record.cycle;
      recorder_.Add(entry_.output.record);
      drive_recorder_.Add(entry_.output.record);
      Watch(entry_.output.record);
    }
  }
  void Watch(const CycleRecord& record) {
    if (axis_ >= record.axes.size() || record.state != MachineState::kRunning) return;
    const AxisRecord& a = record.axes[axis_];
    char text[160];
    text[0] = '\0';
    const double torque_Nm = reported_ ? a.feedback.torque_Nm : a.torque_Nm;
    if (std::fabs(torque_Nm) > plan_.limits.max_torque_Nm)
      std::snprintf(text, sizeof text, "torque of %.3f Nm is beyond --max_torque_Nm", torque_Nm);
    if (a.position_m < plan_.low_mm * 1e-3 || a.position_m > plan_.high_mm * 1e-3)
      std::snprintf(text, sizeof text, "position %.3f mm is beyond --travel_mm", a.position_m * 1e3);
    if (std::fabs(a.reference.velocity_m_s) > plan_.limits.max_speed_mm_s * 1.001e-3)
      std::snprintf(text, sizeof text, "speed of %.3f mm/s is beyond --max_speed_mm_s",
                    a.reference.velocity_m_s * 1e3);
    if (offence_.empty()) offence_ = text;
  }

  std::size_t axis_;
  bool reported_;  ///< the drive makes the torque
  const CommissionPlan plan_;
  AxisRecorder recorder_;
  DriveRecorder drive_recorder_;
  CycleEntry entry_;
  std::string offence_;
  std::uint64_t newest_cycle_ = 0;
  std::uint64_t lost_ = 0;
};

/// What a loop in torque mode may have brought about, and a drive's own loop does not.
bool MayBeTheLoops(const std::string& reason) {
  for (const char* one : {"following_error", "velocity_limit", "oscillation", "feedback_reversed"})
    if (reason == one) return true;
  return false;
}

/// Runs one motion to its end; stops the machine and throws when something is not as it should be.
void RunMotion(ControlClient& client, Watchman& watchman, const CommissionMotion& motion,
               const std::string& progress) {
  const json reply = RunProgram(client, {{"request", "run"},
                                         {"name", "commissioning: " + motion.what},
                                         {"format", "yaml"},
                                         {"from_here", true},
                                         {"text", motion.yaml}});
  const std::uint32_t id = reply.at("program_id");
  const bool terminal = ::isatty(STDERR_FILENO) != 0;
  bool stopping = false;
  for (;;) {
    const json status = Status(client);
    const std::string state = status.at("state");
    const json& program = status.at("program");
    const bool ours = program.at("id") == id;
    if (!ours || (state == "Ready" && status.at("reason") != "none") ||
        (state != "Ready" && state != "Running" && state != "Stopping")) {
      if (ours && status.at("reason") == "program_end") return;
      if (!watchman.offence().empty()) throw std::runtime_error("stopped: " + watchman.offence());
      const std::string message = "\"" + motion.what + "\" did not end by itself: " + StateSentence(status);
      if (state == "Faulted" && !stopping && MayBeTheLoops(status.at("reason")))
        throw MachineStopped(message);
      throw std::runtime_error(message);
    }
    if (terminal && program.at("time_s").is_number() && program.at("duration_s").is_number())
      std::fprintf(stderr, "\r\x1b[K%s  %s  %.1f of %.1f s", progress.c_str(), motion.what.c_str(),
                   program.at("time_s").get<double>(), program.at("duration_s").get<double>());
    if ((StopRequested() || !watchman.offence().empty()) && !stopping) {
      stopping = true;
      client.Ask({{"request", "stop"}});
      // A second one is the shortest stop there is.
      if (!watchman.offence().empty()) client.Ask({{"request", "stop"}});
    }
    const auto until = std::chrono::steady_clock::now() + kLookEvery;
    while (std::chrono::steady_clock::now() < until)
      client.Listen(std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now()));
  }
}

/// The place of the axis among those of the status.
std::size_t NumberOf(const json& status, const std::string& axis) {
  std::size_t number = 0;
  while (status.at("axes").at(number).at("name") != axis) ++number;
  return number;
}

/// Enables, moves, takes the torque off; the record is the watchman's.
void MoveAxis(ControlClient& client, Watchman& watchman, const CommissionPlan& plan) {
  Attend(client, true);
  AskOrThrow(client, {{"request", "enable"}});
  const json status = WaitForStatus(
      client, [](const json& s) { return s.at("state") != "Enabling" && s.at("state") != "Idle"; },
      kEnableLimit);
  if (status.at("state") != "Ready")
    throw std::runtime_error("could not be enabled: " + StateSentence(status));
  std::exception_ptr failure;
  try {
    for (std::size_t i = 0; i < plan.motions.size(); ++i)
      RunMotion(client, watchman, plan.motions[i],
                std::to_string(i + 1) + " of " + std::to_string(plan.motions.size()));
  } catch (const std::exception&) {
    failure = std::current_exception();
  }
  if (::isatty(STDERR_FILENO) != 0) std::fputs("\r\x1b[K", stderr);
  // Whatever happened, the torque goes off again.
  const std::uint64_t last = Status(client).at("cycle");
  client.Ask({{"request", "disable"}});
  if (failure) std::rethrow_exception(failure);
  const auto deadline = std::chrono::steady_clock::now() + kLastRows;
  while (watchman.newest_cycle() < last && std::chrono::steady_clock::now() < deadline)
    client.Listen(kLookEvery);
  AskOrThrow(client, {{"request", "rows"}, {"on", false}});
  std::printf("%.1f s of motion recorded", watchman.recorder().seconds());
  if (watchman.lost() > 0)
    std::printf("; %llu cycles LOST on the way: this computer is too slow",
                static_cast<unsigned long long>(watchman.lost()));
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace

void ThrowIfInterrupted(const std::string& what) {
  if (StopRequested()) throw std::runtime_error("interrupted; " + what);
}

bool DriveLeads(const MachineConfig& machine, const std::string& axis) {
  return ModeFor(machine.machine.controller, machine.axes.at(axis).drive) == DriveMode::kCsp;
}

CommissionLimits LimitsFor(const MachineConfig& machine, const std::string& name,
                           const CommissionOptions& options) {
  CommissionLimits limits = DefaultCommissionLimits(machine.axes.at(name));
  if (name == options.axis) {
    if (options.travel_mm) limits.travel_mm = *options.travel_mm;
    if (options.max_speed_mm_s) limits.max_speed_mm_s = *options.max_speed_mm_s;
    if (options.max_torque_Nm) limits.max_torque_Nm = *options.max_torque_Nm;
  }
  return limits;
}

CommissionPlan PlanFor(const MachineConfig& machine, const json& status, const std::string& name,
                       const CommissionOptions& options) {
  const CommissionLimits limits = LimitsFor(machine, name, options);
  const json& axis = status.at("axes").at(NumberOf(status, name));
  const double position_mm = 1e3 * axis.at("position_m").get<double>();
  CommissionPlan plan = PlanCommissioning(machine, name, position_mm, limits);
  if (options.drive)
    plan.motions = DriveMotions(plan, machine.axes.at(name), position_mm, machine.machine.cycle_us);
  return plan;
}

CommissionRecord Record(ControlClient& client, const MachineConfig& machine, const CommissionPlan& plan) {
  ThrowIfInterrupted();
  const AxisConfig& axis = machine.axes.at(plan.axis);
  const RecordedTorque torque{DriveLeads(machine, plan.axis),
                              static_cast<std::size_t>(axis.drive.delay_cycles), 1e-3 * axis.drive.lag_ms};
  Watchman watchman(client, NumberOf(Status(client), plan.axis), machine.machine.cycle_us * 1e-6, torque,
                    plan, ToSi(axis.model.mechanics).radius_m_rad);
  // The connection outlives it.
  const auto leave_alone = [&client] { client.OnMessage([](const json&) {}); };
  try {
    MoveAxis(client, watchman, plan);
  } catch (const std::exception&) {
    leave_alone();
    throw;
  }
  leave_alone();
  return {watchman.recorder().Take(), watchman.drive_samples(), watchman.lost()};
}

}  // namespace contour
