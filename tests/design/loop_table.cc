// Searches the loop of every axis of the family and prints what was found, as docs/laboratory/loop_designs.md
// has it: loop_table [--scale] [AXIS...]
#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

#include <algorithm>

#include "design/loop_search.h"
#include "tests/design/family_axes.h"

namespace contour {
namespace {

void Print(const std::string& name, const FoundLoop& f, const LoopMargins& m, double seconds) {
  const LoopTuning& t = f.tuning;
  std::printf(
      "| %s | %.1f | %.2f | %.2f | %.0f | %.0f | %.0f | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f %.2f %.2f |",
      name.c_str(), t.regulator_Hz, t.windup_weight, t.velocity_weight, t.disturbance_Hz, t.motor_force_Hz,
      t.table_force_Hz, t.notch_ratio, t.notch_pole_damping, t.notch_zero_damping, t.scale_noise_ratio,
      t.bias_Hz, f.verdict.worst[0].peak, f.verdict.worst[1].peak, f.verdict.worst[2].peak);
  std::printf(" %s | %.1f | %.1f | %.0f | %.1f | %.1f | %.2f | %s | %.1f | %d %.2f\n",
              Binding(f.verdict).name.c_str(), m.bandwidth_Hz, m.gain_up, m.phase_deg,
              1e6 * f.verdict.step.peak_m, 1e6 * f.verdict.step.mean_m, 100.0 * f.verdict.torque_noise,
              Acceptable(f.verdict) ? "yes" : "NO", seconds, f.evaluations, f.cost);
  std::fflush(stdout);
}

}  // namespace
}  // namespace contour

int main(int argc, char** argv) {
  using namespace contour;
  bool scale = false;
  std::vector<std::string> names;
  LoopSearchOptions options;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--scale")
      scale = true;
    else if (argument == "--runs")
      options.runs = std::stoi(argv[++i]);
    else if (argument == "--evaluations")
      options.evaluations_per_run = std::stoi(argv[++i]);
    else if (argument == "--starts")
      options.random_starts = std::stoi(argv[++i]);
    else
      names.push_back(argument);
  }
  for (const FamilyAxis& f : kFamily) {
    if (!names.empty() && std::find(names.begin(), names.end(), f.name) == names.end()) continue;
    const LoopAxis axis = AxisOf(f, scale);
    const auto begin = std::chrono::steady_clock::now();
    const FoundLoop found = SearchLoop(axis, 1e-3, options);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const TwoInertiaLoop loop = DesignLoop(axis.axis, found.tuning, 1e-3, scale);
    Print(f.name, found, MarginsOn(SlidingMember(axis), loop, 1e-3), seconds);
  }
}
