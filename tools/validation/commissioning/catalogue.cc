#include "tools/validation/commissioning/catalogue.h"

#include <cmath>
#include <optional>
#include <random>

#include "config/loop_axis.h"

namespace contour {
namespace {

constexpr double kMasses_rel = 0.3;
constexpr double kFactor = 2.0;
constexpr double kBreakAway = 1.25;
constexpr double kDamping = 0.67;

/// With what a vertical axis moves along.
double Moved_kg(const EmulatedAxisConfig& is) {
  return is.table_mass_kg + (is.counterbalance ? is.counterbalance->moving_mass_kg : 0.0);
}

class Draw {
 public:
  explicit Draw(std::uint64_t seed) {
    std::seed_seq all{static_cast<unsigned>(seed), 4711U};
    random_.seed(all);
  }
  double Within(double share) { return 1.0 + share * (2.0 * Uniform() - 1.0); }
  double Factor(double factor) { return std::pow(factor, 2.0 * Uniform() - 1.0); }

 private:
  double Uniform() { return static_cast<double>(random_()) / 4294967296.0; }
  std::mt19937 random_;
};

}  // namespace

ModelConfig CatalogueModel(const EmulatedAxisConfig& is, ModelConfig model, std::uint64_t seed) {
  Draw draw(seed);
  MechanicsConfig& m = model.mechanics;
  m.motor_inertia_kgm2 = is.motor_inertia_kgm2 * draw.Within(kMasses_rel);
  m.table_mass_kg = Moved_kg(is) * draw.Within(kMasses_rel);
  m.screw_stiffness_N_um = is.screw_stiffness_N_um * draw.Factor(kFactor);
  m.screw_damping_Ns_m = kDamping * is.screw_damping_Ns_m;
  FrictionConfig& f = model.friction;
  const double level = draw.Factor(kFactor);
  f.Fc_plus_N = f.Fc_minus_N = level * 0.5 * (is.friction.Fc_plus_N + is.friction.Fc_minus_N);
  f.Fs_plus_N = f.Fs_minus_N = kBreakAway * f.Fc_plus_N;
  f.vs_mm_s = is.friction.vs_mm_s * draw.Factor(kFactor);
  f.sigma0_N_m = is.friction.sigma0_N_m * draw.Factor(kFactor);
  f.sigma1_Ns_m = is.friction.sigma1_Ns_m * draw.Factor(kFactor);
  f.sigma1_decay_mm_s = f.vs_mm_s;
  f.sigma2_Ns_m = is.friction.sigma2_Ns_m * draw.Factor(kFactor);
  const double even = 1.0 / std::sqrt(3.0);
  model.uncertainty.clear();
  for (const char* key : {"motor_inertia_kgm2", "table_mass_kg"}) model.uncertainty[key] = kMasses_rel * even;
  for (const char* key : {"screw_stiffness_N_um", "Fc_plus_N", "Fc_minus_N", "sigma0_N_m", "sigma2_Ns_m"})
    model.uncertainty[key] = std::log(kFactor) * even;
  return model;
}

void StateCatalogue(EmulatedMachineFile& file, std::uint64_t seed, KnownLoops& known) {
  MachineConfig& machine = file.machine;
  machine.machine.controller = ControllerName::kFull;
  machine.control.friction = FrictionKind::kLinear;
  for (auto& [name, axis] : machine.axes) {
    axis.model = CatalogueModel(file.emulator.axes.at(name), axis.model, seed);
    // In csp the drive closes the loop.
    if (axis.drive.mode == DriveMode::kCsp) continue;
    const std::string key = machine.machine.name + " " + std::to_string(seed) + " " +
                            std::to_string(Moved_kg(file.emulator.axes.at(name)));
    if (!known.contains(key))
      known[key] = FindStartLoop(LoopAxisOf(axis), 1e-6 * machine.machine.cycle_us, 1);
    const StartLoop& start = known.at(key);
    axis.loop = start.wrong.empty() ? std::optional(start.found.tuning) : std::nullopt;
  }
}

}  // namespace contour
