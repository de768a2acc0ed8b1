#include "tests/analysis/support/cause_checks.h"

#include <cmath>
#include <memory>
#include <stdexcept>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "config/yaml_reader.h"
#include "config/yaml_tree.h"
#include "config/yaml_writer.h"

namespace contour::diagnosis::test {
namespace {

constexpr const char* kEmulatedAxis =
    "motor_inertia_kgm2: 5e-5\n"
    "table_mass_kg: 20\n"
    "screw_stiffness_N_um: 40\n"
    "screw_damping_Ns_m: 1500\n"
    "friction: {Fs_plus_N: 60, Fs_minus_N: 60, Fc_plus_N: 40, Fc_minus_N: 40}\n";

}  // namespace

std::vector<SharedEffect> GridOf(const KnownAxis& axis, std::string_view cause) {
  std::vector<SharedEffect> out;
  (*CauseNamed(cause).grid)(axis.problem, out);
  return out;
}

SharedEffect OnGrid(const KnownAxis& axis, std::string_view cause, std::string_view label) {
  for (const SharedEffect& e : GridOf(axis, cause))
    if (e->label.starts_with(label)) return e;
  throw std::out_of_range("no " + std::string(label) + " on the grid of " + std::string(cause));
}

AxisModel With(const KnownAxis& axis, const SharedEffect& effect, const std::vector<double>& amplitudes) {
  AxisModel model = axis.problem.nominal;
  effect->apply(amplitudes, model);
  return model;
}

NamedValues Told(const KnownAxis& axis, const SharedEffect& effect, const std::vector<double>& amplitudes) {
  Point point;
  point.base.assign(axis.problem.terms.size(), 0.0);
  point.effects = {effect};
  point.amplitudes = {amplitudes};
  return (*CauseNamed(effect->kind).parameters)({axis.problem, point, 0});
}

double MeanOverRow(const SharedSignal& signal, std::size_t row) {
  if (!signal) return 0.0;
  const bool inside = signal->size() == 2 * KnownAxis::kRows;
  return 0.5 * ((*signal)[row] + (*signal)[inside ? KnownAxis::kRows + row : row + 1]);
}

double MeanOfWave(const KnownAxis& axis, std::size_t row, double amplitude, double order, double phase_rad) {
  constexpr int kPoints = 2000;
  const Signal& angle = axis.signals().angle_rad;
  double sum = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double at = angle[row] + (i + 0.5) / kPoints * (angle[row + 1] - angle[row]);
    sum += amplitude * std::sin(order * at + phase_rad);
  }
  return sum / kPoints;
}

Cause CauseWith(std::string_view kind, const NamedValues& parameters, const std::vector<double>& position_mm,
                const std::vector<double>& ordinate) {
  Cause cause;
  cause.kind = kind;
  for (const auto& [name, value] : parameters) cause.parameters[name] = {value, value, value};
  if (!position_mm.empty()) cause.shapes.push_back({"position_mm", "ordinate", position_mm, ordinate, {}});
  return cause;
}

ExtensionsConfig ExtendedBy(const std::vector<Cause>& causes) {
  ExtensionsConfig out;
  for (const Cause& c : causes) (*CauseNamed(c.kind).extension->add)(c, 20.0, out);
  return out;
}

ReadBack ThroughYaml(const ExtensionsConfig& extensions) {
  ReadBack out;
  ReadYaml(ParseYamlText(WriteYaml(extensions), "extensions"), out.extensions, "extensions", out.errors);
  return out;
}

Emulated EmulatedWith(const Assignments& assignments) {
  Emulated out;
  YamlValue tree = ParseYamlText(kEmulatedAxis, "axis");
  for (const std::string& a : assignments) ApplyOverride(tree, a);
  ReadYaml(tree, out.axis, "emulator.axes.x", out.errors);
  return out;
}

Emulated SimulatedWith(std::string_view cause, const ExtensionsConfig& extensions,
                       const ModelConfig& stated) {
  return EmulatedWith((*CauseNamed(cause).extension->simulation)(stated, extensions));
}

Program DecidingProgram(const KnownAxis& axis, std::string_view cause,
                        const std::vector<std::string>& hypotheses) {
  return ParseProgram(DecidingExperiment(axis.problem, cause, hypotheses).program, "experiment",
                      ProgramFormat::kYaml);
}

SpecimenMachine MachineToDrawFor() {
  return {.friction_Nm = 0.05,
          .vs_rad_s = 2.0,
          .speed_limit_rad_s = 300.0,
          .emulated_stroke_mm = 200.0,
          .travel_mm = 100.0,
          .other_axis = "y"};
}

UniformNumbers Numbers(std::vector<double> row) {
  return [row = std::move(row), at = std::size_t{0}]() mutable { return row[at++ % row.size()]; };
}

}  // namespace contour::diagnosis::test
