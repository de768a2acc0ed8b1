#include "tools/validation/commissioning/commissioning_circles.h"

#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "config/loop_axis.h"
#include "design/loop_report.h"
#include "design/loop_search.h"
#include "tools/simulate/simulation_run.h"

namespace contour {

double Peak_um(const EmulatedMachineFile& file, const std::string& program, const std::string& scratch) {
  SimulationRequest request;
  request.file = file;
  request.controller = ControllerName::kFull;
  request.program = LoadProgram(std::string(CONTOUR_CONFIG_DIR) + "/programs/" + program + ".yaml");
  request.out = scratch;
  try {
    RunSimulation(request);
  } catch (const std::runtime_error&) {
    return std::numeric_limits<double>::quiet_NaN();
  } catch (const std::invalid_argument&) {  // an axis in torque mode that no loop holds as catalogued
    return std::numeric_limits<double>::quiet_NaN();
  }
  const auto metrics = nlohmann::json::parse(std::ifstream(request.out / "metrics.json"));
  return metrics.at("contour").at("table").at("peak_um").get<double>();
}

EmulatedMachineFile WithFoundLoops(EmulatedMachineFile file) {
  const double period_s = 1e-6 * file.machine.machine.cycle_us;
  for (auto& [name, axis] : file.machine.axes) {
    const FoundLoop found = SearchLoop(LoopAxisOf(axis), period_s);
    if (const std::string wrong = WhatIsWrong(found.verdict); !wrong.empty())
      throw std::runtime_error("no loop for the model found of axis " + name + ": " + wrong);
    axis.loop = found.tuning;
  }
  return file;
}

}  // namespace contour
