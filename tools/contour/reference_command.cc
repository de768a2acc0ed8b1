#include "tools/contour/reference_command.h"

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "tools/contour/daemon_link.h"

namespace contour {
namespace {

struct Options {
  std::string socket;
  std::vector<std::string> positions;
};

int RunReference(const Options& options) {
  nlohmann::json position_mm = nlohmann::json::object();
  for (const std::string& text : options.positions) {
    const std::size_t equals = text.find('=');
    const std::string axis = text.substr(0, equals);
    const std::string number = equals == std::string::npos ? "" : text.substr(equals + 1);
    char* end = nullptr;
    const double at_mm = std::strtod(number.c_str(), &end);
    if (axis.empty() || number.empty() || *end != '\0' || position_mm.contains(axis)) {
      std::cerr << "found '" << text << "', expected AXIS=MM, each axis once: x=12.5\n";
      return kExitBadUsage;
    }
    position_mm[axis] = at_mm;
  }
  ControlClient client = ConnectToDaemon(options.socket);
  StatusOnceStarted(client);
  AskOrThrow(client, {{"request", "reference"}, {"position_mm", position_mm}});
  std::cout << "done\n";
  return kExitDone;
}

}  // namespace

void AddReferenceCommand(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand("reference", "Tell axes whose place is not known where they stand");
  sub->add_option("positions", options->positions, "AXIS=MM, such as x=12.5; as many as there are")
      ->required();
  AddSocketOption(*sub, options->socket);
  sub->footer(
      "For axes without an absolute encoder, and for those whose absolute encoder came back too far from "
      "where it was last seen. The machine must be Idle. A drive that restarts forgets it: programs are "
      "refused until it is told anew.");
  sub->callback([options, &action] { action = [options] { return RunReference(*options); }; });
}

}  // namespace contour
