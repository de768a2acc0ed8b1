#include "tools/contour/request_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/contour/daemon_link.h"

namespace contour {
namespace {

struct RequestCommand {
  std::string name;
  std::string help;
  std::vector<std::string> under_way;  ///< states on the way there, from the moment the request is accepted
  std::vector<std::string> reached;    ///< states that mean success
};

const std::vector<RequestCommand>& RequestCommands() {
  static const std::vector<RequestCommand> commands{
      {"enable",
       "Enable the drives; the machine then holds its position",
       {"Enabling"},
       {"Ready", "Running"}},
      {"disable",
       "Take the torque off the drives, after a stop when moving",
       {"Stopping", "Enabling"},
       {"Idle", "Off", "Starting", "Faulted"}},
      {"stop",
       "Stop on the path, then hold",
       {"Running", "Stopping", "Enabling"},
       {"Ready", "Idle", "Off", "Starting"}},
      {"reset", "After a fault: bring the drives up again as needed", {"Starting"}, {"Idle"}},
  };
  return commands;
}

/// Longer than any deadline of the machine itself, which then says what is wrong.
constexpr std::chrono::seconds kLimit{60};

bool Contains(const std::vector<std::string>& states, const std::string& state) {
  return std::find(states.begin(), states.end(), state) != states.end();
}

int RunRequest(const RequestCommand& command, const std::string& socket) {
  ControlClient client = ConnectToDaemon(socket);
  if (command.name == "enable") StatusOnceStarted(client);
  AskOrThrow(client, {{"request", command.name}});
  const nlohmann::json status = WaitForStatus(
      client, [&](const nlohmann::json& s) { return !Contains(command.under_way, s.at("state")); }, kLimit);
  if (!Contains(command.reached, status.at("state"))) throw std::runtime_error(StateSentence(status));
  std::cout << StateSentence(status) << "\n";
  return kExitDone;
}

}  // namespace

void AddRequestCommands(CLI::App& app, Action& action) {
  for (const RequestCommand& command : RequestCommands()) {
    auto socket = std::make_shared<std::string>();
    CLI::App* sub = app.add_subcommand(command.name, command.help);
    AddSocketOption(*sub, *socket);
    sub->callback([socket, &command, &action] {
      action = [socket, &command] { return RunRequest(command, *socket); };
    });
  }
}

}  // namespace contour
