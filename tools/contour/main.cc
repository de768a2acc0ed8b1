// `contour`: everything around the daemon, by subcommand. command.h says how to add one.
#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <string>

#include "config/config_error.h"
#include "core/exit_status.h"
#include "core/version.h"
#include "tools/contour/check_command.h"
#include "tools/contour/circle_test_command.h"
#include "tools/contour/command.h"
#include "tools/contour/commission_command.h"
#include "tools/contour/contest_command.h"
#include "tools/contour/diagnose_command.h"
#include "tools/contour/doctor_command.h"
#include "tools/contour/emps_command.h"
#include "tools/contour/emulate_command.h"
#include "tools/contour/export_command.h"
#include "tools/contour/identify_command.h"
#include "tools/contour/improve_command.h"
#include "tools/contour/pace_command.h"
#include "tools/contour/reference_command.h"
#include "tools/contour/reload_command.h"
#include "tools/contour/replay_command.h"
#include "tools/contour/request_command.h"
#include "tools/contour/run_command.h"
#include "tools/contour/simulate_command.h"
#include "tools/contour/status_command.h"
#include "tools/contour/tune_command.h"

namespace {

void AddVersionFlags(CLI::App& app) {
  app.set_version_flag("--version", "contour " + std::string(contour::kVersion),
                       "Print the version and leave");
  for (CLI::App* sub : app.get_subcommands([](CLI::App*) { return true; })) AddVersionFlags(*sub);
}

/// The library would only say that a subcommand is missing.
bool NamesNoCommand(const CLI::App& app, const std::string& name) {
  if (name.empty() || name.front() == '-') return false;
  return app.get_subcommands([&](const CLI::App* sub) { return sub->check_name(name); }).empty();
}

int Run(const contour::Action& action) {
  try {
    return action();
  } catch (const contour::ConfigError& e) {
    std::cerr << e.what() << "\n";
    return contour::kExitBadUsage;
  } catch (const contour::EnvironmentError& e) {
    std::cerr << "contour: " << e.what() << "\n";
    return contour::kExitEnvironment;
  } catch (const std::exception& e) {
    std::cerr << "contour: " << e.what() << "\n";
    return contour::kExitFailed;
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Companion of contourd, the contouring servo daemon.", "contour"};
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 done, 1 ran and failed, 2 bad usage or configuration, 3 the environment lacks "
      "something.");
  contour::Action action;

  contour::AddCheckCommand(app, action);
  contour::AddEmulateCommand(app, action);
  contour::AddDiagnoseCommand(app, action);
  contour::AddEmpsCommand(app, action);
  contour::AddSimulateCommand(app, action);
  contour::AddRunCommand(app, action);
  contour::AddStatusCommand(app, action);
  contour::AddWatchCommand(app, action);
  contour::AddRequestCommands(app, action);
  contour::AddPaceCommands(app, action);
  contour::AddExportCommand(app, action);
  contour::AddIdentifyCommand(app, action);
  contour::AddCircleTestCommand(app, action);
  contour::AddCommissionCommand(app, action);
  contour::AddImproveCommand(app, action);
  contour::AddContestCommand(app, action);
  contour::AddTuneCommand(app, action);
  contour::AddReferenceCommand(app, action);
  contour::AddReloadCommand(app, action);
  contour::AddDoctorCommand(app, action);
  contour::AddReplayCommand(app, action);

  AddVersionFlags(app);
  if (argc > 1 && NamesNoCommand(app, argv[1])) {
    std::cerr << "contour: '" << argv[1] << "' is no command; contour --help lists them\n";
    return contour::kExitBadUsage;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? contour::kExitDone : contour::kExitBadUsage;
  }
  return Run(action);
}
