#include "tools/validation/family/learned_circle.h"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>

#include "analysis/circle_test/circle_model.h"
#include "daemon/program/program.h"
#include "tools/simulate/virtual_machine.h"

namespace contour {
namespace {

// As ball bars of machine shops have it.
constexpr double kResolution_m = 0.1e-6;
constexpr char kLargeCircle = 'C';

struct Recorded {
  std::vector<CircleRow> rows;
  std::vector<std::array<double, kCircleAxes>> table_m;
};

Recorded Draw(const EmulatedMachineFile& file, const std::array<CircleAxis, kCircleAxes>& axes) {
  VirtualMachine machine(file, file.machine.machine.controller);
  machine.BringUp();
  machine.Enable();
  Recorded recorded;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow* truth) {
    const CycleRecord& record = entry.output.record;
    if (record.state != MachineState::kRunning || truth == nullptr) return;
    CircleRow row;
    row.time_s = truth->time_s;
    double speed2 = 0.0;
    std::array<double, kCircleAxes> table_m{};
    for (std::size_t i = 0; i < kCircleAxes; ++i) {
      const AxisRecord& a = record.axes[i];
      row.motor_m[i] = a.position_m;
      row.force_N[i] = a.feedback.torque_Nm * 2.0 * std::numbers::pi / axes[i].lead_m;
      speed2 += a.reference.velocity_m_s * a.reference.velocity_m_s;
      table_m[i] = truth->axes[i].TableByEncoder_m();
    }
    row.speed_m_s = std::sqrt(speed2);
    recorded.rows.push_back(row);
    recorded.table_m.push_back(table_m);
  });
  machine.Run(ParseProgram(FamilyProgram(kLargeCircle), "circle", ProgramFormat::kYaml));
  return recorded;
}

std::string Number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

std::vector<CirclePoint> BallBar(const std::vector<std::array<double, kCircleAxes>>& table_m) {
  std::vector<CirclePoint> points = RadiiOf(table_m);
  for (CirclePoint& p : points) p.radius_m = kResolution_m * std::round(p.radius_m / kResolution_m);
  return points;
}

std::vector<std::string> LearnCircle(const std::string& folder, FamilyCell cell) {
  cell.program = kLargeCircle;
  cell.seed = kTuningSeed;
  // The drives alone: what `full` compensates wrongly without this is not to be in the way of finding it.
  cell.entry = {"csp", "csp"};
  const EmulatedMachineFile file = LoadFamilyCell(folder, cell);
  if (file.machine.axes.size() != kCircleAxes) throw std::runtime_error("a circle takes two axes");
  std::array<CircleAxis, kCircleAxes> axes;
  std::size_t i = 0;
  for (const auto& [name, axis] : file.machine.axes) axes[i++] = CircleAxisOf(name, axis.model);
  const Recorded recorded = Draw(file, axes);
  const RowRange turns = TurnsOfCircle(recorded.rows);
  const CircleTestResult found =
      FitCircle(axes, recorded.rows,
                BallBar({recorded.table_m.begin() + static_cast<std::ptrdiff_t>(turns.begin),
                         recorded.table_m.begin() + static_cast<std::ptrdiff_t>(turns.end)}));
  if (const std::string wrong = WhatIsWrong(found, axes); !wrong.empty()) throw std::runtime_error(wrong);
  std::vector<std::string> set;
  for (i = 0; i < kCircleAxes; ++i) {
    ModelConfig model = file.machine.axes.at(axes[i].name).model;
    IntoModel(found.axes[i], model);
    const std::string key = "axes." + axes[i].name + ".model.";
    set.push_back(key + "friction.motor_share_rel=" + Number(model.friction.motor_share_rel));
    set.push_back(key + "uncertainty.motor_share_rel=" + Number(model.uncertainty.at("motor_share_rel")));
    if (const auto& e = model.extensions.lead_wobble)
      set.push_back(key + "extensions.lead_wobble={amplitude_um: " + Number(e->amplitude_um) +
                    ", order_per_rev: 1, phase_rad: " + Number(e->phase_rad) + "}");
  }
  return set;
}

}  // namespace contour
