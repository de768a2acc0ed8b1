// Searches the loop of every axis of the family and prints what was found, as docs/laboratory/loop_designs.md
// has it; the last column is processor time: loop_table [--scale] [--start] [AXIS...]
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include "design/loop_search.h"
#include "design/start_set.h"
#include "tests/design/family_axes.h"

namespace contour {
namespace {

double Cpu_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void Print(const std::string& name, const FoundLoop& f, const LoopMargins& m, double seconds) {
  const LoopTuning& t = f.tuning;
  std::printf("| %s | %.1f %.2f %.2f | %.0f %.0f %.0f | %.2f %.2f %.2f | %.2f %.1f ", name.c_str(),
              t.regulator_Hz, t.windup_weight, t.velocity_weight, t.disturbance_Hz, t.motor_force_Hz,
              t.table_force_Hz, t.notch_ratio, t.notch_pole_damping, t.notch_zero_damping,
              t.scale_noise_ratio, t.bias_Hz);
  const auto& w = f.verdict.worst;
  std::printf("| %.2f %.2f %.2f | %s | %.1f | %.1f | %.0f ", w[0].peak, w[1].peak, w[2].peak,
              Binding(f.verdict).name.c_str(), m.bandwidth_Hz, m.gain_up, m.phase_deg);
  std::printf("| %.1f | %.1f | %.2f | %s | %.1f |\n", 1e6 * f.verdict.step.peak_m,
              1e6 * f.verdict.step.mean_m, 100.0 * f.verdict.torque_noise,
              Acceptable(f.verdict, 0.05) ? "yes" : "no", seconds);
  std::fflush(stdout);
}

}  // namespace
}  // namespace contour

int main(int argc, char** argv) {
  using namespace contour;
  bool scale = false;
  bool start = false;
  std::vector<std::string> names;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--scale")
      scale = true;
    else if (argument == "--start")
      start = true;
    else
      names.push_back(argument);
  }
  for (const FamilyAxis& f : kFamily) {
    if (!names.empty() && std::find(names.begin(), names.end(), f.name) == names.end()) continue;
    const LoopAxis axis = AxisOf(f, scale);
    const double begin_s = Cpu_s();
    LoopSearchOptions options;
    if (start) options.members = StartSet(axis, {});
    const FoundLoop found = SearchLoop(axis, 1e-3, options);
    const double seconds = Cpu_s() - begin_s;
    const TwoInertiaLoop loop = DesignLoop(axis.axis, found.tuning, 1e-3, scale);
    Print(f.name, found, MarginsOn(SlidingMember(axis), loop, 1e-3), seconds);
  }
}
