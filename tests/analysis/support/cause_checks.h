#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "daemon/program/program.h"
#include "tests/analysis/support/known_axis.h"
#include "tools/plant_emulator/emulator_config.h"

// What a cause says, put to those who must understand it: the model, the reader of the configuration, that
// of the emulated machine, that of programs.
namespace contour::diagnosis::test {

/// The cause's effects on their grid.
std::vector<SharedEffect> GridOf(const KnownAxis& axis, std::string_view cause);
/// The one whose label begins so.
SharedEffect OnGrid(const KnownAxis& axis, std::string_view cause, std::string_view label);

/// The nominal model with an effect in it.
AxisModel With(const KnownAxis& axis, const SharedEffect& effect, const std::vector<double>& amplitudes);
/// The parameters that its cause tells of it, the base as stated.
NamedValues Told(const KnownAxis& axis, const SharedEffect& effect, const std::vector<double>& amplitudes);

/// Mean of a model's signal over a row, whether it is straight between rows or inside them; 0 without one.
double MeanOverRow(const SharedSignal& signal, std::size_t row);
/// Of amplitude sin(order angle + phase), by many points of the row; the angle turns evenly inside it.
double MeanOfWave(const KnownAxis& axis, std::size_t row, double amplitude, double order, double phase_rad);

/// A cause with these parameters and, where there is one, a table over the stroke.
Cause CauseWith(std::string_view kind, const NamedValues& parameters,
                const std::vector<double>& position_mm = {}, const std::vector<double>& ordinate = {});
/// What a model is extended by, one cause after the other, the log's first temperature 20 degC.
ExtensionsConfig ExtendedBy(const std::vector<Cause>& causes);

/// Written as YAML and read back by the reader of machine files.
struct ReadBack {
  ExtensionsConfig extensions;
  std::vector<std::string> errors;
};
ReadBack ThroughYaml(const ExtensionsConfig& extensions);

/// An axis of the emulated machine with assignments as `--set` takes them, below its name.
struct Emulated {
  EmulatedAxisConfig axis;
  std::vector<std::string> errors;
};
Emulated EmulatedWith(const Assignments& assignments);
/// What the cause makes of a model's extensions there, of a model with the given mechanics.
Emulated SimulatedWith(std::string_view cause, const ExtensionsConfig& extensions,
                       const ModelConfig& stated = {});

/// The deciding experiment as `contour run` reads it.
Program DecidingProgram(const KnownAxis& axis, std::string_view cause,
                        const std::vector<std::string>& hypotheses = {});

/// A specimen as it is drawn from a row of numbers, one after the other and over again; friction 0.05 Nm,
/// vs 2 rad/s, at most 300 rad/s, stroke 200 mm emulated, 100 mm travelled, the other axis y.
SpecimenMachine MachineToDrawFor();
UniformNumbers Numbers(std::vector<double> row);

}  // namespace contour::diagnosis::test
