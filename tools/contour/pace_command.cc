#include "tools/contour/pace_command.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>

#include "tools/contour/daemon_link.h"

namespace contour {
namespace {

/// A change of pace takes some tenths of a second, longer where the limits are low.
constexpr std::chrono::seconds kLimit{120};

bool Running(const nlohmann::json& status) { return status.at("state") == "Running"; }

int RunPause(const std::string& socket) {
  ControlClient client = ConnectToDaemon(socket);
  AskOrThrow(client, {{"request", "pause"}});
  const nlohmann::json status = WaitForStatus(
      client, [](const nlohmann::json& s) { return !Running(s) || s.at("program").at("paused") == true; },
      kLimit);
  if (!Running(status)) throw std::runtime_error("the program did not pause: " + StateSentence(status));
  std::cout << "paused\n";
  return kExitDone;
}

/// Single block may have it at rest again before anybody looks: that the program's time has gone on is what
/// tells.
int RunResume(const std::string& socket) {
  ControlClient client = ConnectToDaemon(socket);
  const nlohmann::json rested = Status(client).at("program");
  AskOrThrow(client, {{"request", "resume"}});
  const nlohmann::json status = WaitForStatus(
      client,
      [&](const nlohmann::json& s) {
        const nlohmann::json& program = s.at("program");
        return !Running(s) || program.at("id") != rested.at("id") ||
               program.at("time_s") != rested.at("time_s") || program.at("halt") != rested.at("halt") ||
               program.at("feed_percent") == 0.0;
      },
      kLimit);
  const bool ended = status.at("reason") == "program_end";
  if (!Running(status) && !ended)
    throw std::runtime_error("the program did not go on: " + StateSentence(status));
  std::cout << StateSentence(status) << "\n";
  return kExitDone;
}

int RunZero(const std::string& socket) {
  ControlClient client = ConnectToDaemon(socket);
  AskOrThrow(client, {{"request", "zero"}});
  std::cout << "program zero is where the machine stands\n";
  return kExitDone;
}

int RunFeed(const std::string& socket, double percent) {
  ControlClient client = ConnectToDaemon(socket);
  const nlohmann::json reply = AskOrThrow(client, {{"request", "feed"}, {"percent", percent}});
  std::cout << reply.value("text", "done") << "\n";
  return kExitDone;
}

CLI::App* AddOne(CLI::App& app, const char* name, const char* help, Action& action,
                 int (*run)(const std::string&)) {
  auto socket = std::make_shared<std::string>();
  CLI::App* sub = app.add_subcommand(name, help);
  AddSocketOption(*sub, *socket);
  sub->callback([socket, run, &action] { action = [socket, run] { return run(*socket); }; });
  return sub;
}

}  // namespace

void AddPaceCommands(CLI::App& app, Action& action) {
  AddOne(app, "pause", "Bring a program to rest on its path; it stays there until it is resumed", action,
         RunPause)
      ->footer("The drives stay on and hold. A stop ends the program, in a pause too.");
  AddOne(app, "resume", "Go on with a program that is paused", action, RunResume);
  AddOne(app, "zero", "Programs count from where the machine stands now", action, RunZero)
      ->footer(
          "It stays until it is set anew or contourd ends. Where an axis loses count or is told where it is, "
          "programs are refused until it is set again.");
  struct Options {
    std::string socket;
    double percent = 100.0;
  };
  auto options = std::make_shared<Options>();
  CLI::App* feed = app.add_subcommand("feed", "Run programs at so many percent of the programmed feed");
  feed->add_option("percent", options->percent, "0 to 200; it stays for the programs to come")->required();
  AddSocketOption(*feed, options->socket);
  feed->callback(
      [options, &action] { action = [options] { return RunFeed(options->socket, options->percent); }; });
}

}  // namespace contour
