// instruction_probe WHAT COUNT MACHINE_FILE [FROM]: does one thing COUNT times, for instructions.py and
// cycle_profile.py to count. With FROM callgrind counts from that time on alone: what comes before takes most
// of the time, and callgrind makes it forty times as long.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <unistd.h>
#include <yaml-cpp/yaml.h>

#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#else  // without valgrind nothing is counted
#define CALLGRIND_START_INSTRUMENTATION
#define CALLGRIND_STOP_INSTRUMENTATION
#endif

#include "daemon/make_cycle_config.h"
#include "estimator/axis_estimator.h"
#include "tools/bench/contour_problems.h"
#include "tools/machine/load_emulated_machine.h"
#include "tools/simulate/virtual_machine.h"

namespace contour {
namespace {

/// Whether callgrind, begun with --instr-atstart=no, counts what follows.
class Counting {
 public:
  explicit Counting(bool counts) : counts_(counts) {
    if (counts_) {
      CALLGRIND_START_INSTRUMENTATION;
    }
  }
  ~Counting() {
    if (counts_) {
      CALLGRIND_STOP_INSTRUMENTATION;
    }
  }
  Counting(const Counting&) = delete;
  Counting& operator=(const Counting&) = delete;

 private:
  bool counts_;
};

void Estimate(EstimatorKind kind, int count) {
  FrictionConfig f;
  f.Fs_plus_N = f.Fs_minus_N = 52;
  f.Fc_plus_N = f.Fc_minus_N = 42;
  f.vs_mm_s = 2;
  f.sigma0_N_m = 5e6;
  f.sigma1_Ns_m = 3000;
  f.sigma2_Ns_m = 500;
  AxisEstimator estimator(kind, ToSi(MechanicsConfig{5.0, 5e-5, 10.0, 40.0, 1100.0}), f, {}, 1e-3, 0.2e-3,
                          5e-3 / 1048576);
  AxisEstimatorInput in;
  in.fresh = in.enabled = true;
  in.at_rest = false;
  for (int k = 0; k < count; ++k) {
    const double t = 1e-3 * k;
    in.position_m = 1e-4 * std::sin(5.0 * t);
    in.commanded_velocity_m_s = 5e-4 * std::cos(5.0 * t);
    in.force_N = {42.0 * std::tanh(4.0 * std::cos(5.0 * t)), in.force_N[0], in.force_N[1]};
    estimator.Update(in);
  }
}

void SolveQps(int count) {
  // Making the problems solves each of them once, with the same start.
  bench::MakeContourProblems(20, static_cast<std::size_t>(count));
}

/// The same machine four times over: eight axes, two on each of four buses.
std::string EightAxes(const std::string& file) {
  YAML::Node machine = YAML::LoadFile(file);
  const YAML::Node bus = machine["buses"]["main"];
  const std::vector<std::string> names{"x", "y", "z", "u", "v", "w", "a", "b"};
  for (std::size_t i = 2; i < names.size(); ++i) {
    const std::string& like = names[i % 2];
    const std::string on = "bus" + std::to_string(i / 2);
    machine["axes"][names[i]] = YAML::Clone(machine["axes"][like]);
    machine["axes"][names[i]]["drive"]["bus"] = on;
    machine["emulator"]["axes"][names[i]] = YAML::Clone(machine["emulator"]["axes"][like]);
    machine["buses"][on] = YAML::Clone(bus);
  }
  const std::string to =
      std::filesystem::temp_directory_path() / ("eight_axes_" + std::to_string(::getpid()) + ".yaml");
  std::ofstream(to) << machine << "\n";
  return to;
}

/// The filter of 7 states, whatever machine files without a word about it have.
std::vector<std::string> Filter(const std::string& mode) {
  return {"control.friction=srukf", "axes.x.drive.mode=" + mode, "axes.y.drive.mode=" + mode};
}

/// Friction along the reference, and in torque mode the loop of two inertias.
std::vector<std::string> Linear(const std::string& mode) {
  std::vector<std::string> set{"control.friction=linear"};
  for (const std::string axis : {"axes.x.", "axes.y."}) {
    set.push_back(axis + "drive.mode=" + mode);
    set.push_back(axis +
                  "loop={regulator_Hz: 20, windup_weight: 0.4, velocity_weight: 0.18, disturbance_Hz: 200, "
                  "motor_force_Hz: 400, table_force_Hz: 400, notch_ratio: 0.77, notch_pole_damping: 0.7, "
                  "notch_zero_damping: 0.3}");
  }
  return set;
}

constexpr int kMostCycles = 400;

/// The last cycles of a circle, or of a machine that holds all its axes, stepped from the recorded inputs. By
/// the bus's time, in which SYNCs come late and the buses say so, as on a machine.
void StepCycles(const std::string& file, const std::vector<std::string>& overrides, int count, int from,
                bool moves) {
  const EmulatedMachineFile machine_file = LoadEmulatedMachine(file, overrides);
  VirtualMachine machine(machine_file, ControllerName::kFull, EmulatedClock::kWall);
  std::vector<CycleInput> inputs;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow*) { inputs.push_back(entry.input); });
  machine.BringUp();
  machine.Enable();
  if (moves) {
    machine.Run(ParseProgram("{shape: circle, radius_mm: 0.1, frequency_hz: 2, turns: 1}", "circle",
                             ProgramFormat::kYaml));
  } else {
    for (int k = 0; k < kMostCycles; ++k) machine.Tick();
  }
  Cycle cycle(MakeCycleConfig(machine_file.machine, ControllerName::kFull));
  auto output = std::make_unique<CycleOutput>();
  const std::size_t begin = inputs.size() - kMostCycles;
  const std::size_t first = begin + static_cast<std::size_t>(std::max(from, 0));
  const std::size_t last = begin + static_cast<std::size_t>(count);
  for (std::size_t k = 0; k < first && k < last; ++k) cycle.Step(inputs[k], *output);
  const Counting counting(from >= 0);
  for (std::size_t k = first; k < last && k < inputs.size(); ++k) cycle.Step(inputs[k], *output);
}

void HoldEightAxes(const std::string& file, int count, int from) {
  const std::string eight = EightAxes(file);
  StepCycles(eight, {}, count, from, false);
  std::filesystem::remove(eight);
}

/// For callgrind to begin and end at.
[[gnu::noinline]] void MeasuredStep(Cycle& cycle, const CycleInput& input, CycleOutput& output) {
  cycle.Step(input, output);
  asm volatile("" ::: "memory");  // no tail call
}

/// Cycles of a run that holds for a while and draws a circle of 100 um, one line each with what it finds:
/// rest, reversal (of an axis, up to 10 cycles ago) or motion. As many cycles as COUNT, from shortly before
/// the circle begins.
void ProfileCycles(const std::string& file, const std::string& mode, int count) {
  const EmulatedMachineFile machine_file =
      LoadEmulatedMachine(file, {"axes.x.drive.mode=" + mode, "axes.y.drive.mode=" + mode});
  VirtualMachine machine(machine_file, ControllerName::kFull, EmulatedClock::kWall);
  std::vector<CycleInput> inputs;
  std::vector<CycleRecord> records;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow*) {
    inputs.push_back(entry.input);
    records.push_back(entry.output.record);
  });
  machine.BringUp();
  machine.Enable();
  for (int k = 0; k < 100; ++k) machine.Tick();
  const std::size_t from = inputs.size() - 50;
  machine.Run(ParseProgram("{shape: circle, radius_mm: 0.1, frequency_hz: 2, turns: 1}", "circle",
                           ProgramFormat::kYaml));
  Cycle cycle(MakeCycleConfig(machine_file.machine, ControllerName::kFull));
  auto output = std::make_unique<CycleOutput>();
  const std::size_t to = std::min(inputs.size(), from + static_cast<std::size_t>(count));
  std::size_t reversed = 0;
  for (std::size_t k = 0; k < to; ++k) {
    if (k < from) {
      cycle.Step(inputs[k], *output);
      continue;
    }
    MeasuredStep(cycle, inputs[k], *output);
    bool moves = false;
    for (std::size_t i = 0; i < records[k].axes.size(); ++i) {
      const double now = records[k].axes[i].reference.velocity_m_s;
      const double before = records[k - 1].axes[i].reference.velocity_m_s;
      moves = moves || now != 0.0;
      if (now * before < 0.0) reversed = k;
    }
    std::puts(!moves ? "rest" : reversed != 0 && k < reversed + 10 ? "reversal" : "motion");
  }
}

int Probe(const std::string& what, int count, const std::string& file, int from) {
  if (what == "srukf4")
    Estimate(EstimatorKind::kSrukf4, count);
  else if (what == "srukf7")
    Estimate(EstimatorKind::kSrukf7, count);
  else if (what == "mpc20")
    SolveQps(count);
  else if (what == "cycle" || what == "cycle_csp")
    StepCycles(file, Filter(what == "cycle" ? "cst" : "csp"), count, from, true);
  else if (what == "cycle_linear" || what == "cycle_linear_csp")
    StepCycles(file, Linear(what == "cycle_linear" ? "cst" : "csp"), count, from, true);
  else if (what == "hold_two")
    StepCycles(file, {}, count, from, false);
  else if (what == "hold_eight")
    HoldEightAxes(file, count, from);
  else if (what == "cst" || what == "csp")
    ProfileCycles(file, what, count);
  else
    return 2;
  return 0;
}

}  // namespace
}  // namespace contour

int main(int argc, char** argv) {
  if (argc != 4 && argc != 5) return 2;
  return contour::Probe(argv[1], std::atoi(argv[2]), argv[3], argc == 5 ? std::atoi(argv[4]) : -1);
}
