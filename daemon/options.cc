#include "daemon/options.h"

#include <CLI/CLI.hpp>

#include "core/version.h"

namespace contour {

ParseResult ParseOptions(int argc, char** argv, DaemonOptions& o) {
  CLI::App app{"Contouring servo daemon: CANopen drives, friction estimation, model predictive control.",
               "contourd"};
  app.set_version_flag("--version", std::string("contourd ") + std::string(kVersion),
                       "Print the version and leave");
  app.add_option("--config", o.config, "Machine file (YAML)")->required();
  app.add_option("--bus", o.buses,
                 "Interfaces instead of the machine file's, in the order of its buses: can0, vcan0, loopback")
      ->delimiter(',');
  app.add_option("--clock", o.clock,
                 "wall: real time; lockstep: as fast as feedback comes (vcan and loopback only)")
      ->check(CLI::IsMember({"wall", "lockstep"}));
  app.add_option("--controller", o.controller, "Controller instead of the machine file's");
  app.add_option("--set", o.set, "KEY=VALUE: override a key of the machine file; repeatable")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--model", o.models,
                 "AXIS=KEYS: a model, as YAML, in place of the machine file's; contourd gives it to itself "
                 "when it is handed a model on the control socket; repeatable")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--torque-loop", o.torque_loops,
                 "AXIS=KEYS: torque mode with this loop, as YAML, whatever the machine file says; contourd "
                 "gives it to itself when commissioning asks for it on the control socket; one for each axis")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--torque-model", o.torque_models,
                 "AXIS=KEYS: the model that such a loop was found for, in place of the axis's own")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option(
         "--csp-axis", o.csp_axes,
         "AXIS: in csp, whatever the machine file says; contourd gives it to itself when commissioning "
         "asks for it on the control socket; each axis")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--log", o.log, "Record every cycle, inputs and outputs, in this LCM log");
  app.add_option("--truth", o.truth,
                 "Write what the emulated machine really did to this CSV (loopback only)");
  app.add_option("--socket", o.socket, "Control socket");
  app.footer(
      "Exit status: 0 ended as asked, 1 a fault at start-up, 2 bad usage or configuration, 3 the environment "
      "lacks "
      "something.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? ParseResult::kDone : ParseResult::kBadUsage;
  }
  return ParseResult::kRun;
}

}  // namespace contour
