#include "tools/contour/torque_mode_stay.h"

#include <chrono>
#include <iostream>
#include <nlohmann/json.hpp>
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

bool TorqueModeStay::Enter(const std::map<std::string, LoopTuning>& loops,
                           const std::map<std::string, ModelConfig>& models) {
  if (!IsIdle(Status(*client_))) {
    AskOrThrow(*client_, {{"request", "disable"}});
    WaitForStatus(*client_, IsIdle, kIdleLimit);
  }
  entered_ = true;  // also where it does not answer any more
  try {
    Begin(Texts(loops), Texts(models));
  } catch (const BeginRefused&) {
    entered_ = false;
    throw;
  }
  entered_ = AskForMachine(*client_).axes.begin()->second.drive.mode == DriveMode::kCst;
  return entered_;
}

void TorqueModeStay::Leave() {
  if (!entered_) return;
  WaitForStatus(*client_, IsIdle, kIdleLimit);
  Begin({}, {});
  entered_ = false;
}

void TorqueModeStay::LeaveOrSay() {
  try {
    Leave();
  } catch (const std::exception& e) {
    std::cerr << "contourd is still in torque mode, for commissioning alone (" << e.what()
              << "): restart it for the machine file's own\n";
  }
}

void TorqueModeStay::Begin(const std::map<std::string, std::string>& loops,
                           const std::map<std::string, std::string>& models) {
  BeginAnew(
      client_, {{"request", "torque_mode"}, {"loops", loops}, {"models", models}},
      [this] { return ConnectToDaemon(socket_); }, std::chrono::steady_clock::now() + kBeginAnew);
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
