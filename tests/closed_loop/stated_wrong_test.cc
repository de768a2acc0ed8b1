// What is stated far off: the axis is enabled, stands, moves a little and stands again, and neither swings
// nor trips.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/closed_loop/test_machine.h"
#include "tests/closed_loop/tuned_loops.h"

namespace contour::test {
namespace {

/// Largest excursion of a table over the last of these cycles, and why the machine stopped.
struct Stood {
  double after_enable_m = 0.0, after_motion_m = 0.0;
  std::string failure{};
  int oscillating = 0;  ///< cycles in which the supervisor said so
};

double Range_m(const std::vector<std::array<double, 2>>& table_m, std::size_t cycles) {
  double widest_m = 0.0;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t k = table_m.size() - std::min(cycles, table_m.size()); k < table_m.size(); ++k) {
      low = std::min(low, table_m[k][axis]);
      high = std::max(high, table_m[k][axis]);
    }
    widest_m = std::max(widest_m, high - low);
  }
  return widest_m;
}

Stood Stand(const EmulatedMachineFile& file) {
  Stood stood;
  try {
    VirtualMachine machine(file, ControllerName::kFull);
    machine.BringUp();
    std::vector<std::array<double, 2>> table_m;
    machine.SetObserver([&](const CycleEntry& entry, const TruthRow* truth) {
      for (const AxisRecord& a : entry.output.record.axes)
        stood.oscillating += a.limit == Reason::kOscillationNoticed || a.limit == Reason::kSoftened ? 1 : 0;
      if (truth != nullptr)
        table_m.push_back({truth->axes[0].table_position_m, truth->axes[1].table_position_m});
    });
    machine.Enable();
    const auto run = [&](const char* text) {
      machine.Run(ParseProgram(text, "program of the test", ProgramFormat::kYaml));
    };
    run("{shape: hold, seconds: 6}");
    stood.after_enable_m = Range_m(table_m, 3000);
    run("{sequence: [{shape: circle, radius_mm: 0.1, frequency_hz: 0.785, turns: 1}, {shape: hold, seconds: "
        "6}]}");
    stood.after_motion_m = Range_m(table_m, 3000);
  } catch (const std::runtime_error& e) {
    stood.failure = e.what();
  }
  return stood;
}

/// The example with what is stated of it times these.
struct Stated {
  double sigma0 = 1.0, stiffness = 1.0, masses = 1.0;
};

EmulatedMachineFile Machine(const std::string& mode, const Stated& s) {
  std::vector<std::string> set = TunedExample(mode);
  const EmulatedMachineFile real = ExampleMachine();
  for (const auto& [name, axis] : real.machine.axes) {
    const std::string key = "axes." + name + ".model.";
    const ModelConfig& m = axis.model;
    // The lighter it is said to be the farther it goes, and the heavier the less it brakes.
    set.push_back("axes." + name + ".limits.safe_travel_mm=4");
    set.push_back("axes." + name + ".drive.quick_stop_deceleration_rad_s2=15000");
    set.push_back(key + "friction.sigma0_N_m=" + std::to_string(s.sigma0 * m.friction.sigma0_N_m));
    set.push_back(key +
                  "screw_stiffness_N_um=" + std::to_string(s.stiffness * m.mechanics.screw_stiffness_N_um));
    set.push_back(key + "table_mass_kg=" + std::to_string(s.masses * m.mechanics.table_mass_kg));
    set.push_back(key + "motor_inertia_kgm2=" +
                  std::to_string(1e6 * s.masses * m.mechanics.motor_inertia_kgm2) + "e-6");
  }
  return ExampleMachine(set);
}

constexpr double kWindUp_m = 1.1e-6;  // F / K of the example's axes
constexpr double kThird = 1.0 / 3.0;

// What an axis may move in the last 3 of 6 s of rest, in F / K. With masses off besides, the last
// correction of its torque may come that late (not mended yet). In csp the motor leads by what friction winds
// up: told a third of the stiffness it leads by three times of it, and lets go as friction creeps.
double Allowed(const std::string& mode, const Stated& s) {
  if (mode == "csp" && s.stiffness < 1.0) return 0.8;
  return s.masses != 1.0 ? 0.65 : 0.2;
}

void ExpectStands(const std::string& mode, const Stated& s) {
  const Stood stood = Stand(Machine(mode, s));
  const std::string where = mode + ", sigma0 " + std::to_string(s.sigma0) + ", K " +
                            std::to_string(s.stiffness) + ", masses " + std::to_string(s.masses);
  EXPECT_EQ(stood.failure, "") << where;
  EXPECT_EQ(stood.oscillating, 0) << where;
  EXPECT_LT(stood.after_enable_m, 0.05 * kWindUp_m) << where;
  EXPECT_LT(stood.after_motion_m, Allowed(mode, s) * kWindUp_m) << where;
}

// Before `linear`, sigma0 stated at 0.5 to 0.7 of a stiff presliding ran away within 91 to 166 ms of
// `enable`.
TEST(StatedWrong, StandstillAndEnableAreStable) {
  for (const std::string mode : {"cst", "csp"}) {
    for (const double stiffness : {1.0, kThird, 3.0})
      for (const double sigma0 : {1.0, 0.5, 3.0}) ExpectStands(mode, {sigma0, stiffness, 1.0});
    for (const double masses : {0.7, 1.3}) ExpectStands(mode, {0.5, kThird, masses});
  }
}

// At night.
TEST(StatedWrong, StandstillAndEnableAreStableWhateverIsOff) {
  for (const std::string mode : {"cst", "csp"})
    for (const double masses : {1.0, 0.7, 1.3})
      for (const double sigma0 : {1.0, kThird, 0.5, 0.7, 3.0})
        for (const double stiffness : {1.0, kThird, 3.0}) ExpectStands(mode, {sigma0, stiffness, masses});
}

}  // namespace
}  // namespace contour::test
