#include "tools/validation/commissioning/virtual_commissioning.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "analysis/recording/record_axis.h"
#include "drivers/cia402/mode_for.h"
#include "tools/machine/placements.h"
#include "tools/plant_emulator/axis_parameters.h"
#include "tools/simulate/virtual_machine.h"

namespace contour {
namespace {

constexpr std::uint64_t kStreamsPerAxis = 4;  // of the emulated machine

std::size_t AxisNumber(const MachineConfig& machine, const std::string& axis) {
  const std::vector<std::string> names = AxisNames(machine);
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), axis) - names.begin());
}

}  // namespace

EmulatedMachineFile WrongMachine(unsigned seed, double friction_rel, double inertia_rel) {
  std::mt19937 random(seed * 7919u);
  const auto wrong = [&](double by) { return 1.0 + (random() % 2 == 0 ? by : -by); };
  EmulatedMachineFile file = LoadEmulatedMachine(std::string(CONTOUR_CONFIG_DIR) + "/xy_emulated.yaml",
                                                 {"emulator.seed=" + std::to_string(seed)});
  for (auto& [name, axis] : file.machine.axes) {
    const EmulatedAxisConfig& is = file.emulator.axes.at(name);
    FrictionConfig& f = axis.model.friction;
    const double plus = wrong(friction_rel);
    const double minus = wrong(friction_rel);
    f.Fs_plus_N = is.friction.Fs_plus_N * plus;
    f.Fc_plus_N = is.friction.Fc_plus_N * plus;
    f.Fs_minus_N = is.friction.Fs_minus_N * minus;
    f.Fc_minus_N = is.friction.Fc_minus_N * minus;
    f.vs_mm_s = is.friction.vs_mm_s * wrong(friction_rel);
    f.sigma0_N_m = is.friction.sigma0_N_m * wrong(friction_rel);
    f.sigma1_Ns_m = is.friction.sigma1_Ns_m * wrong(friction_rel);
    f.sigma1_decay_mm_s = is.friction.sigma1_decay_mm_s * wrong(friction_rel);
    f.sigma2_Ns_m = is.friction.sigma2_Ns_m * wrong(friction_rel);
    const double inertia = wrong(inertia_rel);
    axis.model.mechanics.motor_inertia_kgm2 = is.motor_inertia_kgm2 * inertia;
    axis.model.mechanics.table_mass_kg = is.table_mass_kg * inertia;
  }
  return file;
}

std::map<std::string, double> Truth(const EmulatedMachineFile& file, const std::string& axis, double low_m,
                                    double high_m) {
  const std::size_t number = AxisNumber(file.machine, axis);
  const plant::AxisParameters p = plant::MakeAxisParameters(
      file.emulator.axes.at(axis), EmulatedPlacements(file.machine)[number], file.emulator.seed,
      file.emulator.parameter_variation_rel, kStreamsPerAxis * number);
  // Whole turns average out; the stroke's wave does not.
  double mean = 0.0;
  constexpr int kPoints = 20000;
  for (int i = 0; i < kPoints; ++i) {
    const double x = low_m + (high_m - low_m) * (i + 0.5) / kPoints;
    mean += (1.0 + p.stroke.amplitude * std::sin(p.stroke.per_unit * x + p.stroke.phase_rad)) / kPoints;
  }
  const plant::FrictionParameters& f = p.friction.base;
  return {{"motor_inertia_kgm2", p.motor_inertia_kgm2 / (p.radius_m_rad * p.radius_m_rad)},
          {"table_mass_kg", p.table_mass_kg + p.counterbalance_mass_kg},
          {"screw_stiffness_N_um", p.stiffness_N_m},
          {"screw_damping_Ns_m", p.damping_Ns_m},
          {"Fs_plus_N", f.plus.Fs_N * mean},
          {"Fs_minus_N", f.minus.Fs_N * mean},
          {"Fc_plus_N", f.plus.Fc_N * mean},
          {"Fc_minus_N", f.minus.Fc_N * mean},
          {"vs_mm_s", f.vs_m_s},
          {"sigma0_N_m", f.sigma0_N_m},
          {"sigma1_Ns_m", f.sigma1_Ns_m},
          {"sigma1_decay_mm_s", f.sigma1_decay_m_s},
          {"sigma2_Ns_m", f.sigma2_Ns_m}};
}

VirtualCommissioning Commission(const EmulatedMachineFile& file, const std::string& axis,
                                const std::string& controller) {
  ControllerName name{};
  if (!FromName(controller, name)) throw std::invalid_argument("no controller " + controller);
  VirtualCommissioning run;
  VirtualMachine machine(file, name);
  machine.BringUp();
  const std::size_t number = AxisNumber(file.machine, axis);
  const AxisConfig& config = file.machine.axes.at(axis);
  const double start_m = machine.record().axes[number].position_m;
  run.plan = PlanCommissioning(file.machine, axis, start_m * 1e3, DefaultCommissionLimits(config));
  const bool csp = ModeFor(name, config.drive) == DriveMode::kCsp;
  AxisRecorder recorder(
      number, file.machine.machine.cycle_us * 1e-6,
      {csp, static_cast<std::size_t>(config.drive.delay_cycles), 1e-3 * config.drive.lag_ms});
  run.low_m = run.high_m = start_m;
  std::uint64_t cycles = 0;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow* truth) {
    const CycleRecord& r = entry.output.record;
    recorder.Add(r);
    ++cycles;
    const AxisRecord& a = r.axes[number];
    run.largest_torque_Nm =
        std::max(run.largest_torque_Nm, std::fabs(csp ? a.feedback.torque_Nm : a.torque_Nm));
    run.largest_following_error_m = std::max(run.largest_following_error_m, std::fabs(a.following_error_m));
    if (truth == nullptr) return;
    run.low_m = std::min(run.low_m, truth->axes[number].table_position_m);
    run.high_m = std::max(run.high_m, truth->axes[number].table_position_m);
    run.largest_speed_m_s =
        std::max(run.largest_speed_m_s, std::fabs(truth->axes[number].table_velocity_m_s));
  });
  machine.Enable();
  for (const CommissionMotion& motion : run.plan.motions)
    machine.Run(ParseProgram(motion.yaml, motion.what, ProgramFormat::kYaml));
  run.machine_time_s = static_cast<double>(cycles) * file.machine.machine.cycle_us * 1e-6;
  run.log = recorder.Take();
  return run;
}

std::map<std::string, identify::FittedParameter> Found(const identify::Identification& id) {
  std::map<std::string, identify::FittedParameter> found;
  for (const identify::FittedParameter& p : id.fit.parameters) found[p.key] = p;
  return found;
}

}  // namespace contour
