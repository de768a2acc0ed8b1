#include "tools/contour/mode_stay.h"

#include <algorithm>
#include <chrono>
#include <iostream>
#include <stdexcept>
#include <vector>

#include "config/config_error.h"
#include "config/load_machine.h"
#include "config/yaml_writer.h"
#include "tools/contour/daemon_link.h"
#include "tools/contour/new_daemon.h"

namespace contour {
namespace {

constexpr std::chrono::seconds kIdleLimit{60};
constexpr std::chrono::seconds kBeginAnew{120};

bool IsIdle(const nlohmann::json& status) { return status.at("state") == "Idle"; }

template <class T>
std::map<std::string, std::string> Texts(const std::map<std::string, T>& by_axis) {
  std::map<std::string, std::string> texts;
  for (const auto& [axis, value] : by_axis) texts[axis] = WriteYaml(value);
  return texts;
}

}  // namespace

bool HasLoops(const MachineConfig& machine, const std::map<std::string, LoopTuning>& loops) {
  return std::ranges::all_of(machine.axes, [&](const auto& named) {
    const auto& [name, axis] = named;
    const auto wanted = loops.find(name);
    return axis.drive.mode == DriveMode::kCst && axis.loop && wanted != loops.end() &&
           WriteYaml(*axis.loop) == WriteYaml(wanted->second);
  });
}

bool ModeStay::EnterTorqueMode(const std::map<std::string, LoopTuning>& loops,
                               const std::map<std::string, ModelConfig>& models) {
  return Enter({{"request", "torque_mode"}, {"loops", Texts(loops)}, {"models", Texts(models)}},
               [&](const MachineConfig& now) { return HasLoops(now, loops); });
}

bool ModeStay::EnterCsp() {
  return Enter({{"request", "csp_mode"}}, [](const MachineConfig& now) {
    return std::ranges::all_of(now.axes,
                               [](const auto& axis) { return axis.second.drive.mode == DriveMode::kCsp; });
  });
}

bool ModeStay::Enter(const nlohmann::json& request, const std::function<bool(const MachineConfig&)>& is_so) {
  if (!IsIdle(Status(*client_))) {
    AskOrThrow(*client_, {{"request", "disable"}});
    WaitForStatus(*client_, IsIdle, kIdleLimit);
  }
  const bool was = entered_;
  entered_ = true;  // also where it does not answer any more
  try {
    Begin(request);
  } catch (const BeginRefused&) {
    entered_ = was;
    throw;
  }
  Attend(*client_, true);
  entered_ = is_so(AskForMachine(*client_));
  if (!entered_) Attend(*client_, false);
  return entered_;
}

void ModeStay::Leave() {
  if (!entered_) return Attend(*client_, false);
  const nlohmann::json status = WaitForStatus(
      *client_, [](const nlohmann::json& s) { return IsIdle(s) || s.at("state") == "Faulted"; }, kIdleLimit);
  // For whoever looks at the fault.
  if (!IsIdle(status)) throw std::runtime_error(StateSentence(status));
  Begin({{"request", "torque_mode"}, {"loops", nlohmann::json::object()}});
  entered_ = false;
}

void ModeStay::LeaveOrSay() {
  if (!entered_) return;
  try {
    Leave();
  } catch (const std::exception& e) {
    std::cerr << "contourd is still in another mode, for commissioning alone (" << e.what()
              << "): restart it for the machine file's own\n";
  }
}

void ModeStay::Begin(const nlohmann::json& request) {
  BeginAnew(
      client_, request, [this] { return ConnectToDaemon(socket_); },
      std::chrono::steady_clock::now() + kBeginAnew);
}

MachineConfig AskForMachine(ControlClient& client) {
  const nlohmann::json reply = AskOrThrow(client, {{"request", "machine_file"}});
  std::vector<std::string> errors;
  MachineConfig machine =
      ReadMachine(ParseYamlText(reply.at("yaml").get<std::string>(), "the daemon's machine file"), errors);
  if (!errors.empty()) throw ConfigError(errors);
  return machine;
}

}  // namespace contour
