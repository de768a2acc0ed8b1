#include "tools/contour/reload_command.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "tools/contour/daemon_link.h"

namespace contour {
namespace {

int RunReload(const std::string& socket) {
  ControlClient client = ConnectToDaemon(socket);
  std::cout << AskOrThrow(client, {{"request", "reload"}}).value("text", "") << "\n";
  return kExitDone;
}

}  // namespace

void AddReloadCommand(CLI::App& app, Action& action) {
  auto socket = std::make_shared<std::string>();
  CLI::App* sub =
      app.add_subcommand("reload", "Let contourd read its machine file again: gains change while it runs");
  AddSocketOption(*sub, *socket);
  sub->callback([socket, &action] { action = [socket] { return RunReload(*socket); }; });
}

}  // namespace contour
