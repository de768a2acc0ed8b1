#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tools/simulate/virtual_machine.h"

namespace contour::test {

inline EmulatedMachineFile ExampleMachine(std::vector<std::string> overrides = {}) {
  return LoadEmulatedMachine(std::string(CONTOUR_CONFIG_DIR) + "/xy_emulated.yaml", overrides);
}

inline Program Circle(double radius_mm, int turns, double frequency_hz) {
  return ParseProgram("{shape: circle, radius_mm: " + std::to_string(radius_mm) + ", turns: " +
                          std::to_string(turns) + ", frequency_hz: " + std::to_string(frequency_hz) + "}",
                      "circle of the test", ProgramFormat::kYaml);
}

/// What a run looked like from the outside; the first turn is left out.
struct RunResult {
  double table_peak_m = 0.0;
  double encoder_peak_m = 0.0;
  double largest_m = 0.0;  ///< of the radii at the table, about the commanded centre
  double smallest_m = 1e9;
  double friction_square_N2 = 0.0;
  std::size_t rows = 0;
  std::vector<double> torque_Nm;  ///< every torque sent, axis by axis, cycle by cycle

  [[nodiscard]] double circular_deviation_m() const { return largest_m - smallest_m; }
  [[nodiscard]] double friction_rms_N() const {
    return std::sqrt(friction_square_N2 / static_cast<double>(rows));
  }
};

inline RunResult RunCircle(const EmulatedMachineFile& file, ControllerName controller,
                           const Program& program) {
  VirtualMachine machine(file, controller);
  machine.BringUp();
  machine.Enable();
  RunResult result;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow* truth) {
    const CycleRecord& r = entry.output.record;
    if (r.state != MachineState::kRunning || truth == nullptr || !machine.plan()) return;
    for (const AxisRecord& a : r.axes) result.torque_Nm.push_back(a.torque_Nm);
    if (!machine.plan()->Scored(r.path_time_s)) return;
    const CommandedCircle circle = *machine.plan()->circle();
    const auto radius = [&](double x, double y) {
      return std::hypot(x - circle.centre_m[0], y - circle.centre_m[1]);
    };
    const double table = radius(truth->axes[0].table_position_m, truth->axes[1].table_position_m);
    const double encoder = radius(r.axes[0].position_m, r.axes[1].position_m);
    result.table_peak_m = std::max(result.table_peak_m, std::abs(table - circle.radius_m));
    result.encoder_peak_m = std::max(result.encoder_peak_m, std::abs(encoder - circle.radius_m));
    result.largest_m = std::max(result.largest_m, table);
    result.smallest_m = std::min(result.smallest_m, table);
    const double friction = r.axes[0].estimate.friction_N - truth->axes[0].friction_N;
    result.friction_square_N2 += friction * friction;
    ++result.rows;
  });
  machine.Run(program);
  return result;
}

}  // namespace contour::test
