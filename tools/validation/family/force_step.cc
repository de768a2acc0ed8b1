#include "tools/validation/family/force_step.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <numbers>
#include <optional>

#include "tools/simulate/virtual_machine.h"

namespace contour {
namespace {

constexpr double kMicro = 1e6;
constexpr double kLag_ms = 4.0;
constexpr double kLasts_s = 0.3;
constexpr double kFrom_s = 0.01, kTo_s = 0.2;
constexpr int kTurn = 3;

/// Where the table was, cycle by cycle, in the machine's own time.
struct Drawn {
  struct Instant {
    double time_s = 0.0;
    double turned_rad = 0.0;  ///< by the reference, since the start
    double radial_m = 0.0;    ///< of the table, beyond the radius
  };
  std::vector<Instant> instants;
  std::string failure{};
};

class Turning {
 public:
  double Add(double angle_rad) {
    if (last_) {
      const double step = std::remainder(angle_rad - *last_, 2.0 * std::numbers::pi);
      turned_ += step;
    }
    last_ = angle_rad;
    return turned_;
  }

 private:
  std::optional<double> last_;
  double turned_ = 0.0;
};

Drawn Draw(const EmulatedMachineFile& file) {
  Drawn drawn;
  Turning turning;
  try {
    VirtualMachine machine(file, file.machine.machine.controller);
    machine.BringUp();
    machine.Enable();
    machine.SetObserver([&](const CycleEntry& entry, const TruthRow* truth) {
      const CycleRecord& r = entry.output.record;
      if (r.state != MachineState::kRunning || truth == nullptr || !machine.plan()) return;
      const CommandedCircle circle = *machine.plan()->circle();
      const auto from_centre = [&](double x_m, double y_m) {
        return std::array<double, 2>{x_m - circle.centre_m[0], y_m - circle.centre_m[1]};
      };
      const auto wanted = from_centre(r.axes[0].reference.position_m, r.axes[1].reference.position_m);
      const auto table = from_centre(truth->axes[0].TableByEncoder_m(), truth->axes[1].TableByEncoder_m());
      drawn.instants.push_back({truth->time_s, turning.Add(std::atan2(wanted[1], wanted[0])),
                                std::hypot(table[0], table[1]) - circle.radius_m});
    });
    machine.Run(ParseProgram(FamilyProgram('C'), "C", ProgramFormat::kYaml));
  } catch (const std::exception& e) {
    drawn.failure = e.what();
  }
  return drawn;
}

std::optional<double> TimeAt(const Drawn& drawn, double turned_rad) {
  for (const Drawn::Instant& i : drawn.instants)
    if (i.turned_rad >= turned_rad) return i.time_s;
  return std::nullopt;
}

void Push(EmulatedMachineFile& file, double time_s, double force_N, double phase_rad) {
  const std::array<double, 2> across{std::cos(phase_rad), std::sin(phase_rad)};
  std::size_t i = 0;
  for (auto& [name, axis] : file.emulator.axes) {
    CuttingForceEffect& effect = axis.effects.cutting_force.emplace();
    effect.force_N = force_N * across[i++];
    effect.start_s = time_s;
    effect.end_s = time_s + kLasts_s;
    effect.lag_ms = kLag_ms;
  }
}

void Compare(const Drawn& without, const Drawn& with, double start_s, ForceStepResult& result) {
  double sum_m2 = 0.0, path_m2 = 0.0;
  int count = 0;
  for (std::size_t k = 0; k < std::min(without.instants.size(), with.instants.size()); ++k) {
    const double since_s = with.instants[k].time_s - start_s;
    if (since_s < 0.0 || since_s > kTo_s) continue;
    const double moved_m = with.instants[k].radial_m - without.instants[k].radial_m;
    result.peak_um = std::max(result.peak_um, kMicro * std::abs(moved_m));
    if (since_s < kFrom_s) continue;
    sum_m2 += moved_m * moved_m;
    path_m2 += with.instants[k].radial_m * with.instants[k].radial_m;
    ++count;
  }
  result.rms_um = kMicro * std::sqrt(sum_m2 / std::max(1, count));
  result.path_rms_um = kMicro * std::sqrt(path_m2 / std::max(1, count));
}

}  // namespace

ForceStepResult RunForceStep(const std::string& folder, const FamilyCell& cell, const ForceStepSpec& spec) {
  ForceStepResult result;
  try {
    EmulatedMachineFile file = LoadFamilyCell(folder, cell);
    const auto& [name, axis] = *file.machine.axes.begin();
    const double radius_m = 1e-3 * axis.model.mechanics.lead_mm / (2.0 * std::numbers::pi);
    result.force_N = spec.share * axis.drive.rated_torque_Nm / radius_m;
    result.floor_um = result.force_N / file.emulator.axes.begin()->second.screw_stiffness_N_um;
    const double phase_rad = spec.phase_deg * std::numbers::pi / 180.0;
    const Drawn without = Draw(file);
    result.failure = without.failure;
    const auto start_s = TimeAt(without, 2.0 * std::numbers::pi * (kTurn - 1) + phase_rad);
    if (!start_s) return result;
    Push(file, *start_s, result.force_N, phase_rad);
    const Drawn with = Draw(file);
    result.failure = with.failure;
    Compare(without, with, *start_s, result);
  } catch (const std::exception& e) {
    result.failure = e.what();
  }
  return result;
}

void WriteForceSteps(std::ostream& out, const std::vector<FamilyCell>& cells,
                     const std::vector<ForceStepResult>& results) {
  out << "| | force N | force / K um | peak um | rms 10 to 200 ms um | with the path's own error |\n"
         "|---|---|---|---|---|---|\n";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const ForceStepResult& r = results[i];
    const FamilyCell& c = cells[i];
    char text[160];
    std::snprintf(text, sizeof text, " | %.0f | %.2f | %.2f | %.2f | %.2f |", r.force_N, r.floor_um,
                  r.peak_um, r.rms_um, r.path_rms_um);
    out << "| " << c.setting.machine << (c.setting.variation.empty() ? "" : " ") << c.setting.variation
        << ", " << c.entry.controller << ' ' << c.entry.mode << ", seed " << c.seed << text
        << (r.failure.empty() ? "" : " " + r.failure) << '\n';
  }
}

}  // namespace contour
