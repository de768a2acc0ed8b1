#pragma once

#include <optional>
#include <string>

#include "analysis/diagnosis/causes/extensions_of.h"
#include "analysis/diagnosis/report/contour_gain.h"
#include "analysis/diagnosis/result/finding.h"
#include "config/machine_config.h"
#include "daemon/program/program.h"

namespace contour::diagnosis {

/// What extending the model will do for the path, by simulation of the machine that the diagnosis describes:
/// the model's numbers as fitted, with the causes found. On it, the controller `full` draws the program once
/// with the model as stated and once with the extended one. The machine file's own `emulator:` is never
/// looked at; extensions that the model has already are part of it. Temperature stands where the log had it
/// farthest from its first; the extended model follows it where the machine file names a sensor. Causes of a
/// kind that no model is extended by are left out on both sides; nothing where no other was found, or where
/// the machine has one axis only (a path is then never left). Throws std::runtime_error when the simulated
/// machine stops.
std::optional<ContourGain> PredictContourGain(const MachineConfig& machine, const std::string& axis,
                                              const Diagnosis& found, const LogTemperature& temperature,
                                              const Program& program);

/// A circle of 10 mm at 3 m/min, or what the axes' limits allow of it.
Program UsualCircle(const MachineConfig& machine);

}  // namespace contour::diagnosis
