#include "tools/contour/doctor_command.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "config/load_machine.h"
#include "tools/doctor/examination.h"

namespace contour {
namespace {

struct Options {
  std::string config;
  std::string root = "/";
  bool json = false;
};

std::string Line(const Finding& f) {
  const std::string mark = f.level == FindingLevel::kGood     ? "   good  "
                           : f.level == FindingLevel::kChange ? " CHANGE  "
                           : f.level == FindingLevel::kAdvice ? " advice  "
                                                              : "      ?  ";
  std::string text = mark + f.found + "\n";
  if (!f.change.empty()) text += "             " + f.change + "\n";
  return text;
}

int RunDoctor(const Options& options) {
  ExaminationRequest request;
  request.root = options.root;
  if (!options.config.empty()) {
    const MachineConfig machine = LoadMachine(options.config);
    request.cpu = machine.realtime.cpu;
    request.priority = machine.realtime.priority;
    for (const auto& [name, bus] : machine.buses)
      if (bus.interface != "loopback") request.interfaces.push_back(bus.interface);
  }
  nlohmann::json list = nlohmann::json::array();
  std::string text;
  int changes = 0;
  for (const Finding& f : Examine(request)) {
    changes += f.level == FindingLevel::kChange ? 1 : 0;
    list.push_back({{"what", f.what}, {"level", Name(f.level)}, {"found", f.found}, {"change", f.change}});
    text += Line(f);
  }
  if (options.json) {
    std::cout << nlohmann::json{{"findings", list}, {"changes_needed", changes}}.dump(2) << "\n";
  } else {
    std::cout << text
              << (changes == 0 ? "Nothing stands in the way of real time.\n" : "Change what is marked.\n");
  }
  return changes == 0 ? kExitDone : kExitFailed;
}

}  // namespace

void AddDoctorCommand(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub =
      app.add_subcommand("doctor", "Whether this computer can keep real time, and what to change");
  sub->add_option("--config", options->config, "Machine file: its CPU, priority and interfaces");
  sub->add_option("--root", options->root, "")->group("");  // for tests: where /proc, /sys and /boot are
  sub->add_flag("--json", options->json, "For programs");
  sub->footer("Exit status: 0 nothing must be changed, 1 something must.");
  sub->callback([options, &action] { action = [options] { return RunDoctor(*options); }; });
}

}  // namespace contour
