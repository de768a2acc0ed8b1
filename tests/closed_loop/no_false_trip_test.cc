// A sound machine with everything on that makes motion look odd, run for long: nothing may stop it, warn,
// soften it or fall back. CONTOUR_LONG_TESTS=1 in the environment: an hour of each machine in each mode, as
// the nightly tests have it; one short round else.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/closed_loop/test_machine.h"

namespace contour::test {
namespace {

constexpr double kHour_s = 3600.0;

struct SoundMachine {
  const char* name;
  const char* file;  ///< in the tree
  std::vector<std::string> axes;
  double cogging_Nm;
  double force_N;
  double hour_force_N;  ///< in the nightly form
  double fastest_mm_s;
  double creep_mm;  ///< in which the fastest is reached
};

// 12 N are more than the Coulomb friction of the light axis. In an hour of them its loop does swing once, for
// half a second, and is noticed, rightly; so the hour has less.
const std::vector<SoundMachine> kMachines{
    {"xy_emulated", "config/xy_emulated.yaml", {"x", "y"}, 0.01, 60.0, 60.0, 240.0, 60.0},
    {"heavy_table", "tests/faults/machines/heavy_table.yaml", {"x", "y"}, 0.08, 60.0, 60.0, 290.0, 120.0},
    {"light_axis", "tests/faults/machines/light_axis.yaml", {"z"}, 0.005, 12.0, 6.0, 480.0, 100.0}};

/// Every effect, of a size that a machine in order has: cogging, torque ripple, steps of an outside force,
/// counts misread by one, stick-slip, warm-up, a lead that wobbles, friction along the stroke and per turn.
std::vector<std::string> Overrides(const SoundMachine& machine, bool csp, bool is_long) {
  std::vector<std::string> all;
  for (const std::string& axis : machine.axes) {
    const std::string emulated = "emulator.axes." + axis;
    const std::string effect = emulated + ".effects.";
    if (csp) all.push_back("axes." + axis + ".drive.mode=csp");
    all.push_back(emulated + ".encoder_noise_lsb=1");
    all.push_back(effect + "cogging={amplitude_Nm: " + std::to_string(machine.cogging_Nm) +
                  ", order_per_rev: 12}");
    all.push_back(effect + "torque_ripple={amplitude_rel: 0.02, order_per_rev: 6}");
    all.push_back(effect + "cutting_force={force_N: " +
                  std::to_string(is_long ? machine.hour_force_N : machine.force_N) +
                  ", start_s: 3, end_s: 5.3, every_s: 7.9}");
    all.push_back(effect + "stribeck={Fs_over_Fc: 1.6, vs_rad_s: 2}");
    all.push_back(effect + "friction_drift={change_rel: -0.3, over_s: 1800}");
    all.push_back(effect + "encoder_eccentricity={amplitude_rad: 0.0005}");
    all.push_back(effect + "pitch_error={amplitude_um: 10, periods_per_stroke: 20}");
    all.push_back(effect + "position_friction={amplitude_rel: 0.2, periods_per_stroke: 3}");
    all.push_back(effect + "friction_ripple={amplitude_rel: 0.08, order_per_rev: 1}");
  }
  return all;
}

/// From the slowest feed to the fastest, circles, corners, reversals and rests, at another place in each
/// round.
std::vector<std::string> Round(const SoundMachine& machine, int round, bool is_long) {
  const std::string fastest = std::to_string(machine.fastest_mm_s);
  const std::string far = std::to_string(machine.creep_mm);
  std::vector<std::string> parts;
  for (const std::string& axis : machine.axes) {
    const std::string of_axis = ", axis: " + axis + ", ";
    parts.push_back("{shape: creep" + of_axis + "stroke_mm: " + (is_long ? "0.2" : "0.02") +
                    ", velocities_mm_s: [0.01]}");
    parts.push_back("{shape: creep" + of_axis + "stroke_mm: " + (is_long ? "1" : "0.1") +
                    ", velocities_mm_s: [0.05, 0.2]}");
    parts.push_back("{shape: creep" + of_axis + "stroke_mm: -10, velocities_mm_s: [5, 20]}");
    parts.push_back("{shape: creep" + of_axis + "stroke_mm: " + far + ", velocities_mm_s: [100, " + fastest +
                    "]}");
    parts.push_back("{shape: sine" + of_axis + "amplitude_mm: 0.2, frequency_hz: 0.5, cycles: 2}");
    parts.push_back("{shape: reversals" + of_axis +
                    "amplitudes_mm: [0.001, 0.003, 0.01, 0.1, 1], frequency_hz: 2, cycles: 3}");
  }
  if (machine.axes.size() > 1) {
    parts.push_back("{shape: circle, radius_mm: 0.1, frequency_hz: 0.7853981634, turns: 3}");
    parts.push_back("{shape: circle, radius_mm: 10, feed_mm_min: 3000, turns: 2}");
    parts.push_back("{shape: square, side_mm: 10, feed_mm_min: 600, turns: 1, corners: velocity_jump}");
    parts.push_back("{shape: diamond, side_mm: 5, feed_mm_min: 1200, turns: 1, corners: exact_stop}");
  }
  parts.push_back("{shape: hold, seconds: " + std::string(is_long ? "180" : "5") + "}");
  // To and fro over the stroke, never the same place twice.
  const std::string step_mm = std::to_string(round % 8 < 4 ? 13.7 : -13.7);
  if (machine.axes.size() > 1)
    parts.push_back("{shape: line, dx_mm: " + step_mm + ", dy_mm: " + step_mm + ", feed_mm_min: 2000}");
  return parts;
}

/// What an axis of a machine in order never shows.
bool IsAlarm(Reason limit) { return limit >= Reason::kTorqueConstantChanged; }

struct Case {
  SoundMachine machine;
  bool csp;
  ControllerName controller = ControllerName::kFull;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.machine.name; }

class NoFalseTrip : public ::testing::TestWithParam<Case> {};

TEST_P(NoFalseTrip, WithEveryEffectOn) {
  const bool is_long = std::getenv("CONTOUR_LONG_TESTS") != nullptr;
  const auto& [sound, csp, controller] = GetParam();
  VirtualMachine machine(
      LoadEmulatedMachine(std::string(CONTOUR_SOURCE_DIR) + "/" + sound.file, Overrides(sound, csp, is_long)),
      controller);
  machine.BringUp();
  std::string part = "enable";
  std::map<std::string, std::uint64_t> alarms;
  std::uint64_t cycles = 0;
  double seconds = 0.0;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow*) {
    const CycleRecord& r = entry.output.record;
    if (cycles++ == 0) seconds = -1e-9 * static_cast<double>(r.grid_time_ns);
    for (std::size_t i = 0; i < r.axes.size(); ++i)
      if (IsAlarm(r.axes[i].limit) &&
          alarms[std::string(Name(r.axes[i].limit)) + " of " + sound.axes[i] + " in " + part]++ == 0)
        std::printf("cycle %llu, %.3f s into the part: %s\n", static_cast<unsigned long long>(r.cycle),
                    r.path_time_s, std::string(Name(r.axes[i].limit)).c_str());
  });
  machine.Enable();
  const auto elapsed_s = [&] { return seconds + 1e-9 * static_cast<double>(machine.record().grid_time_ns); };
  for (int round = 0; round == 0 || (is_long && elapsed_s() < kHour_s); ++round)
    for (const std::string& text : Round(sound, round, is_long)) {
      part = text;
      try {
        machine.Run(ParseProgram(text, "part", ProgramFormat::kYaml));
      } catch (const std::runtime_error& error) {
        FAIL() << "after " << elapsed_s() << " s, round " << round << ", in " << part << ": " << error.what();
      }
    }
  std::printf("%.0f s\n", elapsed_s());
  for (const auto& [what, count] : alarms) ADD_FAILURE() << what << ", " << count << " cycles";
}

struct ContestRun {
  const char* name;
  ControllerName controller;
  const char* program;
  std::vector<std::string> machine;
};

// Runs of the contest that were stopped although nothing failed: loops that are badly tuned for the machine,
// and keep within the following error all the same.
const std::vector<ContestRun> kContest{
    {"soft_observer_stiff_bristles",
     ControllerName::kMpcObserver,
     "{shape: circle, radius_mm: 0.1, frequency_hz: 0.7853981634, turns: 2}",
     {"emulator.axes.x.friction.sigma0_N_m=15e6", "emulator.axes.y.friction.sigma0_N_m=15e6"}},
    {"filter_of_a_rival_delay",
     ControllerName::kMpcSrukf4,
     "{shape: square, side_mm: 10, feed_mm_min: 3000, corners: velocity_jump, turns: 6}",
     {"emulator.axes.x.delay_cycles=2", "emulator.axes.y.delay_cycles=2"}},
    {"filter_of_a_rival_inertia",
     ControllerName::kMpcSrukf4,
     "{shape: circle, radius_mm: 10, feed_mm_min: 10000, turns: 12}",
     {"emulator.axes.x.motor_inertia_kgm2=3.5e-5", "emulator.axes.x.table_mass_kg=7",
      "emulator.axes.y.motor_inertia_kgm2=3.5e-5", "emulator.axes.y.table_mass_kg=7"}},
    {"struck_in_corners",
     ControllerName::kPid,
     "{shape: square, side_mm: 10, feed_mm_min: 3000, corners: velocity_jump, turns: 3}",
     {"emulator.axes.x.motor_inertia_kgm2=6.5e-5", "emulator.axes.x.table_mass_kg=13",
      "emulator.axes.y.motor_inertia_kgm2=6.5e-5", "emulator.axes.y.table_mass_kg=13"}},
    {"torque_on_its_way",
     ControllerName::kPid,
     "{shape: square, side_mm: 10, feed_mm_min: 3000, corners: velocity_jump, turns: 15}",
     {"emulator.axes.x.delay_cycles=2", "emulator.axes.y.delay_cycles=2"}},
    {"start_with_a_jump",
     ControllerName::kCsp,
     "{shape: square, side_mm: 10, feed_mm_min: 3000, corners: velocity_jump, turns: 2}",
     {"emulator.axes.x.delay_cycles=2", "emulator.axes.y.delay_cycles=2"}}};

void PrintTo(const ContestRun& run, std::ostream* out) { *out << run.name; }

class NoFalseTripOfRivals : public ::testing::TestWithParam<ContestRun> {};

TEST_P(NoFalseTripOfRivals, RunToTheirEnd) {
  const ContestRun& run = GetParam();
  VirtualMachine machine(ExampleMachine(run.machine), run.controller);
  machine.BringUp();
  machine.Enable();
  EXPECT_NO_THROW(machine.Run(ParseProgram(run.program, run.name, ProgramFormat::kYaml)));
}

INSTANTIATE_TEST_SUITE_P(Contest, NoFalseTripOfRivals, ::testing::ValuesIn(kContest),
                         [](const auto& of) { return std::string(of.param.name); });

std::vector<Case> Cases() {
  std::vector<Case> cases;
  for (const SoundMachine& machine : kMachines)
    for (const bool csp : {false, true}) cases.push_back({machine, csp});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Machines, NoFalseTrip, ::testing::ValuesIn(Cases()), [](const auto& of) {
  return std::string(of.param.machine.name) + (of.param.csp ? "_csp" : "_cst");
});

}  // namespace
}  // namespace contour::test
