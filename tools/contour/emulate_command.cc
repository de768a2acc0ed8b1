#include "tools/contour/emulate_command.h"

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/config_error.h"
#include "drivers/can/socketcan_bus.h"
#include "tools/machine/load_emulated_machine.h"
#include "tools/machine/placements.h"
#include "tools/plant_emulator/emulator_process.h"

namespace contour {
namespace {

struct Options {
  std::string file;
  std::vector<std::string> buses;
  std::string clock = "sync";
  std::optional<std::string> truth;
  std::optional<std::uint64_t> seed;
  std::vector<std::string> set;
};

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

void OnSignal(int /*signal*/) { stop_requested.store(true); }

/// The interface of every bus: as --bus says, else as the file does.
std::vector<std::string> Interfaces(const MachineConfig& machine, const std::vector<std::string>& asked) {
  const std::vector<std::string> names = BusNames(machine);
  if (!asked.empty() && asked.size() != names.size())
    throw ConfigError({"--bus: found " + std::to_string(asked.size()) +
                       " interfaces, expected one for each of the " + std::to_string(names.size()) +
                       " buses of the machine"});
  std::vector<std::string> interfaces = asked;
  if (interfaces.empty())
    for (const std::string& name : names) interfaces.push_back(machine.buses.at(name).interface);
  for (const std::string& interface : interfaces)
    if (interface == "loopback")
      throw ConfigError(
          {"emulate: found interface loopback, expected a SocketCAN interface (--bus vcan0): on loopback "
           "contourd runs the emulated machine itself"});
  return interfaces;
}

void PrintReady(const EmulatorProcessOptions& options) {
  std::cout << "contour emulate: ready:";
  for (const std::string& axis : options.axis_names) std::cout << " " << axis;
  std::cout << " on";
  for (const std::string& interface : options.interfaces) std::cout << " " << interface;
  if (options.io) std::cout << ", Modbus on " << options.io->host << ":" << options.io->port;
  std::cout << (options.clock == EmulatedClock::kSync ? ", stepped by SYNC" : ", on the wall clock")
            << std::endl;
}

int RunEmulate(const Options& options) {
  EmulatedMachineFile file = LoadEmulatedMachine(options.file, options.set);
  if (options.seed) file.emulator.seed = *options.seed;
  EmulatorProcessOptions process;
  process.interfaces = Interfaces(file.machine, options.buses);
  process.axis_names = AxisNames(file.machine);
  process.clock = options.clock == "wall" ? EmulatedClock::kWall : EmulatedClock::kSync;
  process.truth_path = options.truth;
  process.io = file.emulator.io;
  const std::vector<EmulatedAxisPlacement> placements = EmulatedPlacements(file.machine);
  EmulatedMachine machine(file.emulator, placements,
                          static_cast<std::uint32_t>(file.machine.machine.cycle_us), process.clock);
  std::signal(SIGTERM, OnSignal);
  std::signal(SIGINT, OnSignal);
  try {
    RunEmulatorProcess(machine, process, stop_requested, PrintReady);
  } catch (const BusUnavailable& e) {
    throw EnvironmentError(e.what());
  }
  return kExitDone;
}

}  // namespace

void AddEmulateCommand(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub =
      app.add_subcommand("emulate", "Run the emulated machine on SocketCAN buses, until SIGTERM or SIGINT");
  sub->add_option("--config", options->file,
                  "Machine file; its section emulator: says what the machine really is")
      ->required()
      ->type_name("FILE");
  sub->add_option("--bus", options->buses,
                  "SocketCAN interface of each bus, in the order of their names; default: the file's")
      ->delimiter(',')
      ->type_name("NAME,...");
  sub->add_option("--clock", options->clock,
                  "sync: every SYNC advances the machine by one period; wall: it follows the clock")
      ->check(CLI::IsMember({"sync", "wall"}))
      ->capture_default_str();
  sub->add_option("--truth", options->truth,
                  "Write true positions, velocities and friction to this file, a row per SYNC")
      ->type_name("FILE");
  sub->add_option("--seed", options->seed, "Vary noise, ripple phases, start and parameters by this number")
      ->check(CLI::NonNegativeNumber)
      ->type_name("N");
  sub->add_option("--set", options->set, "Override a key of the machine file, any number of times")
      ->type_name("KEY=VALUE");
  sub->callback([options, &action] { action = [options] { return RunEmulate(*options); }; });
}

}  // namespace contour
