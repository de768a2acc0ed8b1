// Whole cycles, Cycle::Step: frames in, estimate, control, guard, frames out. The inputs are those of a run
// in virtual time, a circle on every pair of axes, stepped again from the recorded frames.
#include <benchmark/benchmark.h>

#include <memory>
#include <string>
#include <vector>

#include "daemon/make_cycle_config.h"
#include "tools/bench/latencies.h"
#include "tools/machine/load_emulated_machine.h"
#include "tools/simulate/virtual_machine.h"

namespace contour::bench {
namespace {

/// The example's table `pairs` times, each pair on a bus of its own.
EmulatedMachineFile Machine(int pairs, const char* mode) {
  const std::string set = std::string(".drive.mode=") + mode;
  EmulatedMachineFile file = LoadEmulatedMachine(CONTOUR_MACHINE_FILE, {"axes.x" + set, "axes.y" + set});
  const EmulatedMachineFile one = file;
  for (auto* map : {&file.machine.axes}) map->clear();
  file.emulator.axes.clear();
  file.machine.buses.clear();
  for (int p = 0; p < pairs; ++p) {
    const std::string number = std::to_string(p);
    file.machine.buses["bus" + number] = one.machine.buses.begin()->second;
    for (const auto& [name, axis] : one.machine.axes) {
      file.machine.axes[number + name] = axis;
      file.machine.axes[number + name].drive.bus = "bus" + number;
      file.emulator.axes[number + name] = one.emulator.axes.at(name);
    }
  }
  return file;
}

Program Circles(int pairs) {
  std::string text = "together:\n";
  for (int p = 0; p < pairs; ++p) {
    const std::string n = std::to_string(p);
    text +=
        "  - {shape: circle, radius_mm: 10, feed_mm_min: 3000, turns: 2, axes: [" + n + "x, " + n + "y]}\n";
  }
  return ParseProgram(text, "circles", ProgramFormat::kYaml);
}

std::vector<CycleInput> Record(const EmulatedMachineFile& file, int pairs, ControllerName controller,
                               std::size_t& running_from) {
  VirtualMachine machine(file, controller);
  std::vector<CycleInput> inputs;
  running_from = 0;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow*) {
    if (running_from == 0 && entry.output.record.state == MachineState::kRunning)
      running_from = inputs.size();
    inputs.push_back(entry.input);
  });
  machine.BringUp();
  machine.Enable();
  machine.Run(Circles(pairs));
  return inputs;
}

/// `machines` of them one after the other in every cycle: a machine has 8 axes at most.
void WholeCycle(benchmark::State& state, ControllerName controller, const char* mode) {
  const int all = static_cast<int>(state.range(0));
  const int machines = all > 4 ? all / 4 : 1;
  const int pairs = all / machines;
  const EmulatedMachineFile file = Machine(pairs, mode);
  std::size_t running_from = 0;
  const std::vector<CycleInput> inputs = Record(file, pairs, controller, running_from);
  std::vector<std::unique_ptr<Cycle>> cycles;
  auto input = std::make_unique<CycleInput>();
  auto output = std::make_unique<CycleOutput>();
  std::size_t k = inputs.size();
  {
    Latencies latencies(state);
    for (auto _ : state) {
      if (k == inputs.size()) {
        cycles.clear();
        for (int m = 0; m < machines; ++m)
          cycles.push_back(std::make_unique<Cycle>(MakeCycleConfig(file.machine, controller)));
        for (k = 0; k < running_from; ++k)
          for (auto& cycle : cycles) cycle->Step(inputs[k], *output);
      }
      // As after a bus was read: thousands of recorded cycles lie outside the cache.
      *input = inputs[k];
      latencies.Time([&] {
        for (auto& cycle : cycles) cycle->Step(*input, *output);
      });
      benchmark::DoNotOptimize(*output);
      ++k;
    }
  }
  state.counters["median_us_per_pair"] = state.counters["median_us"] / static_cast<double>(all);
}
BENCHMARK_CAPTURE(WholeCycle, full, ControllerName::kFull, "cst")
    ->Name("cycle/full/pairs")
    ->Arg(1)
    ->Arg(2)
    ->Arg(4)
    ->Arg(8)
    ->Arg(16)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(WholeCycle, full_csp, ControllerName::kFull, "csp")
    ->Name("cycle/full_csp/pairs")
    ->Arg(1)
    ->Arg(2)
    ->Arg(4)
    ->Arg(8)
    ->Arg(16)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(WholeCycle, mpc, ControllerName::kMpc, "cst")
    ->Name("cycle/mpc/pairs")
    ->Arg(1)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);

/// A second of the 10 mm circle in virtual time: the cycle and the emulated machine.
void SimulatedSecond(benchmark::State& state) {
  const EmulatedMachineFile file = LoadEmulatedMachine(CONTOUR_MACHINE_FILE);
  VirtualMachine machine(file, ControllerName::kFull);
  machine.BringUp();
  machine.Enable();
  for (auto _ : state)
    for (int i = 0; i < 1000; ++i) machine.Tick();
}
BENCHMARK(SimulatedSecond)->Name("simulate/one_second_holding")->Unit(benchmark::kMillisecond);

void SimulatedCircle(benchmark::State& state) {
  const EmulatedMachineFile file = LoadEmulatedMachine(CONTOUR_MACHINE_FILE);
  const Program circle = ParseProgram("{shape: circle, radius_mm: 10, feed_mm_min: 3000, turns: 4}", "circle",
                                      ProgramFormat::kYaml);
  double seconds = 0.0;
  VirtualMachine machine(file, ControllerName::kFull);
  machine.BringUp();
  machine.Enable();
  for (auto _ : state) {
    machine.Run(circle);
    seconds += machine.plan()->duration_s();
  }
  state.counters["ms_per_simulated_second"] =
      benchmark::Counter(seconds * 1e-3, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(SimulatedCircle)->Name("simulate/circle_10mm")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace contour::bench
