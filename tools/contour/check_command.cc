#include "tools/contour/check_command.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "config/config_error.h"
#include "config/idle_keys.h"
#include "config/interfaces.h"
#include "config/key_table.h"
#include "config/load_machine.h"
#include "config/yaml_tree.h"
#include "core/friction_kind.h"
#include "daemon/program/gcode/tool_table.h"
#include "daemon/program/gcode_parser.h"
#include "daemon/program/program.h"
#include "drivers/cia402/mode_for.h"
#include "tools/contour/check_report.h"
#include "tools/contour/loop_section.h"
#include "tools/contour/path_section.h"
#include "tools/machine/load_emulated_machine.h"
#include "tools/simulate/controller_trial.h"

namespace contour {
namespace {

struct Options {
  std::string file;
  bool describe = false;
  bool markdown = false;
  std::string canon;
  bool block_delete = true;
  std::string tool_table;
  std::vector<std::string> set;
};

const std::string kReferenceHead =
    "# Every key of a machine file\n\n"
    "Written by `contour check --markdown`; [configuration.md](configuration.md) explains the whole. "
    "`<name>` stands for "
    "a name of your\nchoice; a range is inclusive unless it says above.\n\n";

std::vector<KeyRow> AllKeys() {
  std::vector<KeyRow> rows = DescribeKeys<MachineConfig>();
  for (KeyRow& row : DescribeKeys<EmulatorConfig>("emulator")) rows.push_back(std::move(row));
  return rows;
}

/// Loops with margins have been judged by them, and drives hold their axes by their own. Why the controller
/// is refused; one whose loops are softened, but which holds, is warned of.
std::string TriedController(const MachineConfig& machine) {
  const ControllerName controller = machine.machine.controller;
  if (KnowsTwoInertias(controller, machine.control.friction)) return {};
  for (const auto& [name, axis] : machine.axes)
    if (ModeFor(controller, axis.drive) != DriveMode::kCst) return {};
  const ControllerTrial trial = TryController(machine);
  const bool full = controller == ControllerName::kFull;
  const std::string found = full ? "control.friction: found " + std::string(Name(machine.control.friction))
                                 : "machine.controller: found " + std::string(Name(controller));
  const std::string help =
      "; what would help: machine.controller: full with control.friction: linear and loops of "
      "`contour tune --from-model`, which are judged by their margins; the drive's own loop (drive.mode: "
      "csp)";
  if (trial.lost.empty()) {
    if (!trial.softened.empty())
      std::cerr << "warning: " << found << ", which swings on this machine in torque mode (" << trial.softened
                << ")" << help << "\n";
    return {};
  }
  return found + ", which does not hold this machine in torque mode (" + trial.lost +
         "); expected one that does" + help;
}

/// A virtual CAN interface is made by software, perhaps after this check; that any other is missing is a
/// finding.
ExitStatus CheckInterfaces(const MachineConfig& config) {
  ExitStatus status = kExitDone;
  for (const auto& [name, bus] : config.buses) {
    try {
      RequireInterface(name, bus.interface);
    } catch (const EnvironmentError& e) {
      const bool later =
          IsVirtualCan(bus.interface) && FindInterface(bus.interface) == InterfaceKind::kAbsent;
      std::cerr << (later ? "note: " : "contour: ") << e.what() << "\n";
      if (!later) status = kExitEnvironment;
    }
  }
  return status;
}

std::string IdleSection(const Options& options, const MachineConfig& machine) {
  std::string text;
  for (const std::string& idle : IdleKeys(OpenMachineFile(options.file, options.set), machine))
    text += "  " + idle + "\n";
  return text.empty() ? text : "\nStated, but without effect\n" + text;
}

int PrintCanonicalMoves(const Options& options) {
  GcodeSettings settings;
  settings.block_delete = options.block_delete;
  settings.tool_table = options.tool_table;
  settings.zero_m.emplace();  // no machine is asked: program zero is its own zero
  std::cout << CanonicalText(ReadProgramText(options.canon), options.canon, settings);
  return kExitDone;
}

int RunCheck(const Options& options) {
  if (!options.canon.empty()) return PrintCanonicalMoves(options);
  if (options.describe || options.markdown) {
    std::cout << (options.markdown ? kReferenceHead + MarkdownReference(AllKeys()) : TextTable(AllKeys()));
    if (options.file.empty()) return kExitDone;
  }
  const MaybeEmulatedMachineFile file = LoadMaybeEmulatedMachine(options.file, options.set);
  // What is wrong with it is said here, not at the first program.
  LoadToolTable(file.machine.machine.tool_table);
  const LoopSection loops = JudgeLoops(file.machine);
  if (!loops.refused.empty()) {
    std::cout << CheckReport(file.machine) << loops.text << std::flush;
    throw ConfigError(WithPlaces(OpenMachineFile(options.file, options.set), loops.refused));
  }
  std::vector<std::string> with_loops = options.set;
  with_loops.insert(with_loops.end(), loops.chosen.begin(), loops.chosen.end());
  // Bounds go by the loop that runs, also where it was chosen just now.
  const MachineConfig whole = LoadMaybeEmulatedMachine(options.file, with_loops).machine;
  std::cout << CheckReport(whole) << loops.text << std::flush;
  if (const std::string lost = TriedController(whole); !lost.empty())
    throw ConfigError(WithPlaces(OpenMachineFile(options.file, options.set), {lost}));
  std::cout << PathSection(whole) << IdleSection(options, whole) << std::flush;
  return CheckInterfaces(file.machine);
}

}  // namespace

void AddCheckCommand(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub =
      app.add_subcommand("check", "Validate a machine file; print limits, stopping bounds and bus timing");
  CLI::Option* file = sub->add_option("file", options->file, "Machine file (YAML)");
  sub->add_flag("--describe", options->describe, "Print the reference table of all keys");
  sub->add_flag("--markdown", options->markdown,
                "Print it as Markdown, as docs/configuration_keys.md holds it");
  sub->add_option("--canon", options->canon,
                  "Print what a G-code program asks for, move by move, as LinuxCNC's rs274 does")
      ->type_name("PROGRAM");
  sub->add_option("--tool-table", options->tool_table,
                  "With --canon: file with the lengths of tools for G43");
  sub->add_flag("--block-delete,!--no-block-delete", options->block_delete,
                "With --canon: leave lines out that begin with a slash (default), or not");
  sub->add_option("--set", options->set, "Put KEY=VALUE on top of the file; any number of times")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  sub->callback([options, file, &action] {
    const bool alone = options->describe || options->markdown || !options->canon.empty();
    if (file->count() == 0 && !alone) throw CLI::RequiredError("file");
    action = [options] { return RunCheck(*options); };
  });
}

}  // namespace contour
