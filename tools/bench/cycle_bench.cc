// Whole cycles, Cycle::Step: frames in, estimate, control, guard, frames out. The inputs are those of a run
// in virtual time, a circle on every pair of axes, stepped again from the recorded frames.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "daemon/make_cycle_config.h"
#include "tools/bench/latencies.h"
#include "tools/machine/load_emulated_machine.h"
#include "tools/simulate/virtual_machine.h"

namespace contour::bench {
namespace {

constexpr std::array<int, 5> kPairs{1, 2, 4, 8, 16};

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

/// So many pairs that draw circles. More than 4 are machines of 4 pairs one after the other in every cycle: a
/// machine has 8 axes at most.
class Drawing {
 public:
  Drawing(int all, ControllerName controller, const char* mode)
      : machines_(all > 4 ? all / 4 : 1),
        controller_(controller),
        file_(Machine(all / machines_, mode)),
        inputs_(Record(file_, all / machines_, controller, running_from_)),
        next_(inputs_.size()) {}

  /// Makes the next cycle ready: at the end of the circles from their beginning.
  void Prepare() {
    if (next_ == inputs_.size()) {
      cycles_.clear();
      for (int m = 0; m < machines_; ++m)
        cycles_.push_back(std::make_unique<Cycle>(MakeCycleConfig(file_.machine, controller_)));
      for (next_ = 0; next_ < running_from_; ++next_) {
        *input_ = inputs_[next_];
        Step();
      }
    }
    // As after a bus was read: thousands of recorded cycles lie outside the cache.
    *input_ = inputs_[next_++];
  }

  void Step() {
    for (auto& cycle : cycles_) cycle->Step(*input_, *output_);
    benchmark::DoNotOptimize(*output_);
  }

 private:
  int machines_;
  ControllerName controller_;
  EmulatedMachineFile file_;
  std::size_t running_from_ = 0;
  std::vector<CycleInput> inputs_;
  std::size_t next_;
  std::vector<std::unique_ptr<Cycle>> cycles_;
  std::unique_ptr<CycleInput> input_ = std::make_unique<CycleInput>();
  std::unique_ptr<CycleOutput> output_ = std::make_unique<CycleOutput>();
};

void WholeCycle(benchmark::State& state, ControllerName controller, const char* mode) {
  const int all = static_cast<int>(state.range(0));
  Drawing drawing(all, controller, mode);
  {
    Latencies latencies(state);
    for (auto _ : state) {
      drawing.Prepare();
      latencies.Time([&] { drawing.Step(); });
    }
  }
  state.counters["median_us_per_pair"] = state.counters["median_us"] / static_cast<double>(all);
}

/// Cost per pair by the number of pairs, side by side: a machine with other work to do is now fast and now
/// slow, for seconds on end, and rows measured one after the other do not compare. Here they take turns, 50
/// cycles each (the first of them bring the state back into the cache; the median knows nothing of those).
void CostPerPair(benchmark::State& state, const char* mode) {
  constexpr int kTurn = 50;
  std::vector<Drawing> drawings;
  for (const int pairs : kPairs) drawings.emplace_back(pairs, ControllerName::kFull, mode);
  std::array<std::vector<double>, kPairs.size()> per_pair_us;
  for (auto _ : state) {
    for (std::size_t i = 0; i < kPairs.size(); ++i) {
      for (int turn = 0; turn < kTurn; ++turn) {
        drawings[i].Prepare();
        per_pair_us[i].push_back(MicrosecondsOf([&] { drawings[i].Step(); }) / kPairs[i]);
      }
    }
  }
  double least = std::numeric_limits<double>::max(), most = 0.0;
  for (std::size_t i = 0; i < kPairs.size(); ++i) {
    const double median = Median(per_pair_us[i]);
    state.counters["us_per_pair_of_" + std::to_string(kPairs[i])] = median;
    least = std::min(least, median);
    most = std::max(most, median);
  }
  state.counters["most_over_least"] = most / least;
}
BENCHMARK_CAPTURE(CostPerPair, cst, "cst")->Name("cycle/full/cost_per_pair");
BENCHMARK_CAPTURE(CostPerPair, csp, "csp")->Name("cycle/full_csp/cost_per_pair");

void Timed(benchmark::internal::Benchmark* benchmark) {
  benchmark->UseManualTime()->Unit(benchmark::kMicrosecond);
}
void EveryNumberOfPairs(benchmark::internal::Benchmark* benchmark) {
  for (const int pairs : kPairs) benchmark->Arg(pairs);
}

BENCHMARK_CAPTURE(WholeCycle, full, ControllerName::kFull, "cst")
    ->Name("cycle/full/pairs")
    ->Apply(EveryNumberOfPairs)
    ->Apply(Timed);
BENCHMARK_CAPTURE(WholeCycle, full_csp, ControllerName::kFull, "csp")
    ->Name("cycle/full_csp/pairs")
    ->Apply(EveryNumberOfPairs)
    ->Apply(Timed);
BENCHMARK_CAPTURE(WholeCycle, mpc, ControllerName::kMpc, "cst")
    ->Name("cycle/mpc/pairs")
    ->Arg(1)
    ->Apply(Timed);

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
