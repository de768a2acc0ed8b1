// The long form of the commissioning test: seeds of the example machine, each with a model that is wrong by
// 50 % in friction and 30 % in inertia (or the example's own model, with --nominal), commissioned in virtual
// time. Prints a table of errors, whether the 95 % intervals hold the truth, and with --contour what `full`
// in either mode, csp and mpc_observer then make of three circles.
//
//   commission_table [--seeds N] [--first N] [--controller NAME] [--nominal] [--contour] [--twice]
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "analysis/axis_model/read_stated_axis.h"
#include "analysis/identification/result_files.h"
#include "tools/simulate/simulation_run.h"
#include "tools/validation/commissioning/virtual_commissioning.h"

namespace contour::test {
namespace {

struct Score {
  std::map<std::string, double> worst_rel;
  std::map<std::string, int> held;
  int intervals = 0, holding = 0;
};

void Compare(const EmulatedMachineFile& file, const std::string& axis, const identify::Identification& id,
             Score& score) {
  const auto truth = Truth(file, axis, id.fit.axis.variation.low_m, id.fit.axis.variation.high_m);
  const auto found = Found(id);
  for (const auto& [key, is] : truth) {
    const auto at = found.find(key);
    if (at == found.end()) {
      std::printf("  %-22s not identified\n", key.c_str());
      continue;
    }
    const identify::FittedParameter& p = at->second;
    const double error = p.value / is - 1.0;
    const double z = std::log(p.value / is) / p.sigma;
    std::printf("  %-22s %12.5g truth %12.5g  error %+6.2f %%  sigma %5.2f %%  z %+5.1f\n", key.c_str(),
                p.value, is, 100.0 * error, 100.0 * p.sigma, z);
    score.worst_rel[key] = std::max(score.worst_rel[key], std::fabs(error));
    ++score.intervals;
    if (std::fabs(z) < 1.96) {
      ++score.holding;
      ++score.held[key];
    }
  }
}

double Peak_um(EmulatedMachineFile file, const char* program, ControllerName controller, DriveMode mode) {
  for (auto& [name, axis] : file.machine.axes) axis.drive.mode = mode;
  SimulationRequest request;
  request.file = file;
  request.controller = controller;
  request.program = LoadProgram(std::string(CONTOUR_CONFIG_DIR) + "/programs/" + program + ".yaml");
  request.out = std::filesystem::temp_directory_path() / "contour_commission_table";
  RunSimulation(request);
  const auto metrics = nlohmann::json::parse(std::ifstream(request.out / "metrics.json"));
  return metrics.at("contour").at("table").at("peak_um").get<double>();
}

void Contour(const EmulatedMachineFile& file) {
  for (const char* program : {"circle_100um_slow", "circle_100um", "circle_10mm"})
    std::printf("  %-20s peak at the table, um: full %.3f, full in csp %.3f, csp %.3f, mpc_observer %.3f\n",
                program, Peak_um(file, program, ControllerName::kFull, DriveMode::kCst),
                Peak_um(file, program, ControllerName::kFull, DriveMode::kCsp),
                Peak_um(file, program, ControllerName::kCsp, DriveMode::kCsp),
                Peak_um(file, program, ControllerName::kMpcObserver, DriveMode::kCst));
}

int Run(unsigned first, unsigned seeds, const std::string& controller, bool nominal, bool contour,
        bool twice) {
  Score score;
  double longest_s = 0.0;
  for (unsigned seed = first; seed < first + seeds; ++seed) {
    EmulatedMachineFile file =
        nominal ? LoadEmulatedMachine(std::string(CONTOUR_CONFIG_DIR) + "/xy_emulated.yaml",
                                      {"emulator.seed=" + std::to_string(seed)})
                : WrongMachine(seed, 0.5, 0.3);
    const MachineConfig before = file.machine;
    for (const char* axis : {"x", "y"}) {
      if (!contour && std::string(axis) == "y") continue;
      EmulatedMachineFile fresh{before, file.emulator};
      if (twice) {
        const VirtualCommissioning first_run = Commission(fresh, axis, controller);
        const auto id = identify::Identify(diagnosis::ToStatedAxis(fresh.machine, axis), {first_run.log}, {});
        fresh.machine.axes.at(axis).model = identify::ToModel(id, before.axes.at(axis).model);
      }
      const MachineConfig stated = fresh.machine;
      VirtualCommissioning run = Commission(fresh, axis, controller);
      std::printf(
          "seed %u axis %s: %.1f s of machine time, %.3f to %.3f mm (allowed %.3f to %.3f), %.1f mm/s, %.3f "
          "Nm\n",
          seed, axis, run.machine_time_s, run.low_m * 1e3, run.high_m * 1e3, run.plan.low_mm,
          run.plan.high_mm, run.largest_speed_m_s * 1e3, run.largest_torque_Nm);
      longest_s = std::max(longest_s, run.machine_time_s);
      const identify::Identification id =
          identify::Identify(diagnosis::ToStatedAxis(stated, axis), {run.log}, {});
      Compare(file, axis, id, score);
      std::fflush(stdout);
      file.machine.axes.at(axis).model = identify::ToModel(id, before.axes.at(axis).model);
    }
    if (contour) Contour(file);
    std::fflush(stdout);
  }
  std::printf("\nlargest error, intervals that hold the truth\n");
  for (const auto& [key, worst] : score.worst_rel)
    std::printf("  %-22s %6.2f %%  %d\n", key.c_str(), 100.0 * worst, score.held[key]);
  std::printf("%d of %d intervals hold the truth (%.1f %%); longest machine time %.1f s\n", score.holding,
              score.intervals, 100.0 * score.holding / std::max(1, score.intervals), longest_s);
  return 0;
}

}  // namespace
}  // namespace contour::test

int main(int argc, char** argv) {
  CLI::App app{"Commissioning of emulated machines in virtual time: a table of errors."};
  unsigned seeds = 10;
  unsigned first = 1;
  std::string controller = "mpc_observer";
  bool nominal = false;
  bool contour = false;
  bool twice = false;
  app.add_option("--seeds", seeds, "How many");
  app.add_option("--first", first, "The first of them");
  app.add_option("--controller", controller, "Controller during commissioning");
  app.add_flag("--nominal", nominal, "Begin from the example's own model");
  app.add_flag("--contour", contour, "Both axes, then circles with what was identified");
  app.add_flag("--twice", twice, "Once more, beginning from what the first run found");
  CLI11_PARSE(app, argc, argv);
  return contour::test::Run(first, seeds, controller, nominal, contour, twice);
}
