#include "tools/contour/status_command.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "tools/contour/daemon_link.h"
#include "tools/contour/status_text.h"

namespace contour {
namespace {

struct Options {
  std::string socket;
  bool json = false;
  int period_ms = 200;
};

int RunStatus(const Options& options) {
  ControlClient client = ConnectToDaemon(options.socket);
  const nlohmann::json status = Status(client);
  std::cout << (options.json ? status.dump(2) + "\n" : StatusText(status));
  return kExitDone;
}

/// Until the daemon goes or the reader of our output does.
int RunWatch(const Options& options) {
  ControlClient client = ConnectToDaemon(options.socket);
  const bool terminal = ::isatty(STDOUT_FILENO) != 0;
  client.OnMessage([&](const nlohmann::json& message) {
    if (!message.contains("watch")) return;
    const nlohmann::json& status = message.at("watch");
    if (options.json) {
      std::cout << status.dump() << std::endl;
    } else if (terminal) {
      std::cout << "\x1b[H\x1b[J" << StatusText(status)
                << std::flush;  // from the top left, over the last one
    } else {
      std::cout << StatusLine(status) << std::endl;
    }
  });
  AskOrThrow(client, {{"request", "watch"}, {"period_ms", options.period_ms}});
  while (std::cout) client.Listen(std::chrono::seconds(60));
  return kExitDone;
}

}  // namespace

void AddStatusCommand(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand("status", "What a running contourd is doing");
  AddSocketOption(*sub, options->socket);
  sub->add_flag("--json", options->json, "For programs: everything, as JSON");
  sub->callback([options, &action] { action = [options] { return RunStatus(*options); }; });
}

void AddWatchCommand(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand("watch", "The status of a running contourd again and again");
  AddSocketOption(*sub, options->socket);
  sub->add_flag("--json", options->json, "For programs: one JSON object per line");
  sub->add_option("--period", options->period_ms, "Milliseconds between two looks")
      ->check(CLI::Range(20, 60000))
      ->capture_default_str();
  sub->callback([options, &action] { action = [options] { return RunWatch(*options); }; });
}

}  // namespace contour
