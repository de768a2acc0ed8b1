// The margins that `contour check` prints are those of the running loop: a multisine is put on the torque
// between the daemon's own cycle and the emulated drive, while the axis slides and while it rests.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "config/loop_axis.h"
#include "design/loop_report.h"
#include "tests/closed_loop/swept_loop.h"

namespace contour::test {
namespace {

/// An axis of the family with the tuning that `contour tune --from-model` found for it.
struct Tuned {
  const char* machine;
  const char* loop;
  double sliding_N;  ///< of the push: the axis must not turn round, and
  double resting_N;  ///< its bristles must not slip
};
constexpr Tuned kTuned[] = {
    {"base",
     "{regulator_Hz: 23.6, windup_weight: 0.21, velocity_weight: 0.0354, disturbance_Hz: 259, "
     "motor_force_Hz: "
     "964, table_force_Hz: 1090, notch_ratio: 0.773, notch_pole_damping: 0.264, notch_zero_damping: 0.112}",
     20.0, 4.0},
    {"t30",
     "{regulator_Hz: 15.8, windup_weight: 0.0323, velocity_weight: 0.127, disturbance_Hz: 269, "
     "motor_force_Hz: "
     "733, table_force_Hz: 2000, notch_ratio: 0.767, notch_pole_damping: 0.1, notch_zero_damping: 0.0277}",
     20.0, 4.0},
    {"m300",
     "{regulator_Hz: 20.8, windup_weight: 0.698, velocity_weight: 0.259, disturbance_Hz: 247, "
     "motor_force_Hz: "
     "426, table_force_Hz: 614, notch_ratio: 1.59, notch_pole_damping: 1.8, notch_zero_damping: 0.803}",
     300.0, 30.0},
    {"soft",
     "{regulator_Hz: 18.1, windup_weight: 0.0439, velocity_weight: 1.4, disturbance_Hz: 205, motor_force_Hz: "
     "784, table_force_Hz: 808, notch_ratio: 0.521, notch_pole_damping: 1.15, notch_zero_damping: 0.656}",
     20.0, 6.0},
};

/// The machine as its model says, and the model as the machine is: what is compared is the loop.
EmulatedMachineFile AsModelled(const Tuned& tuned, const std::vector<std::string>& more = {}) {
  const std::string path = std::string(CONTOUR_CONFIG_DIR) + "/family/" + tuned.machine + ".yaml";
  const EmulatedMachineFile real = LoadEmulatedMachine(path);
  std::vector<std::string> set{"control.friction=linear", "estimator.adapt=false",
                               "emulator.parameter_variation_rel=0"};
  for (const auto& [name, e] : real.emulator.axes) {
    const std::string axis = "axes." + name + ".", plant = "emulator." + axis;
    const auto model = [&](const char* key, double value) {
      set.push_back(axis + "model." + key + "=" + std::to_string(value));
    };
    set.push_back(axis + "loop=" + tuned.loop);
    set.push_back(axis + "model.motor_inertia_kgm2=" + std::to_string(1e6 * e.motor_inertia_kgm2) + "e-6");
    model("table_mass_kg", e.table_mass_kg);
    model("screw_stiffness_N_um", e.screw_stiffness_N_um);
    model("screw_damping_Ns_m", e.screw_damping_Ns_m);
    model("friction.Fs_plus_N", e.friction.Fs_plus_N);
    model("friction.Fs_minus_N", e.friction.Fs_minus_N);
    model("friction.Fc_plus_N", e.friction.Fc_plus_N);
    model("friction.Fc_minus_N", e.friction.Fc_minus_N);
    model("friction.vs_mm_s", e.friction.vs_mm_s);
    model("friction.sigma0_N_m", e.friction.sigma0_N_m);
    model("friction.sigma1_Ns_m", e.friction.sigma1_Ns_m);
    model("friction.sigma1_decay_mm_s", e.friction.sigma1_decay_mm_s);
    model("friction.sigma2_Ns_m", e.friction.sigma2_Ns_m);
    set.push_back(plant + "friction.position_amplitude_rel=0");
    set.push_back(plant + "friction.ripple_amplitude_rel=0");
  }
  set.insert(set.end(), more.begin(), more.end());
  return LoadEmulatedMachine(path, set);
}

void ExpectSame(const LoopMargins& stated, const SweptLoop& swept, const std::string& where) {
  const LoopMargins found = MarginsOf(swept.open, swept.frequencies_Hz);
  EXPECT_NEAR(found.peak / stated.peak, 1.0, 0.1) << where << ", at " << found.peak_Hz << " Hz";
  EXPECT_NEAR(found.gain_up / stated.gain_up, 1.0, 0.1) << where;
  EXPECT_NEAR(found.phase_deg / stated.phase_deg, 1.0, 0.1) << where;
  std::printf("| %s | %.2f / %.2f | %.2f / %.2f | %.1f / %.1f |\n", where.c_str(), stated.peak, found.peak,
              stated.gain_up, found.gain_up, stated.phase_deg, found.phase_deg);
}

constexpr const char* kLine = "{shape: line, dx_mm: 190, dy_mm: 0, feed_mm_min: 600}";

LoopReport StatedFor(const EmulatedMachineFile& file) {
  const AxisConfig& axis = file.machine.axes.begin()->second;
  return ReportOn(LoopAxisOf(axis), *axis.loop, 1e-6 * file.machine.machine.cycle_us);
}

TEST(SweptMargins, SlidingTheyAreAsCheckPrintsThem) {
  for (const Tuned& tuned : kTuned) {
    const EmulatedMachineFile file = AsModelled(tuned);
    ExpectSame(StatedFor(file).sliding, Sweep(file, {kLine, tuned.sliding_N, 3}),
               std::string(tuned.machine) + ", sliding at 10 mm/s");
  }
}

// A dead time of part of a period, and two whole ones: where the model puts them the running loop has them.
TEST(SweptMargins, DelaysActWhereTheModelPutsThem) {
  std::vector<std::string> dead, late;
  for (const std::string axis : {"x", "y"}) {
    dead.push_back("emulator.axes." + axis + ".effects.input_delay={delay_us: 300}");
    dead.push_back("axes." + axis + ".model.extensions={input_delay: {delay_us: 300}}");
    late.push_back("emulator.axes." + axis + ".delay_cycles=2");
    late.push_back("axes." + axis + ".drive.delay_cycles=2");
  }
  const LoopSweep sweep{kLine, kTuned[0].sliding_N, 3};
  const EmulatedMachineFile with_dead = AsModelled(kTuned[0], dead), with_late = AsModelled(kTuned[0], late);
  ExpectSame(StatedFor(with_dead).sliding, Sweep(with_dead, sweep), "base, 300 us of dead time, sliding");
  ExpectSame(StatedFor(with_late).sliding, Sweep(with_late, sweep), "base, two cycles of delay, sliding");
}

// So little and so slow that friction's bristles are all that gives way; but it is a motion.
TEST(SweptMargins, AtRestTheyAreAsCheckPrintsThem) {
  for (const Tuned& tuned : kTuned) {
    const EmulatedMachineFile file = AsModelled(tuned);
    ExpectSame(StatedFor(file).rest,
               Sweep(file, {"{shape: sine, axis: x, amplitude_mm: 0.00001, frequency_hz: 0.02, cycles: 3}",
                            tuned.resting_N, 10}),
               std::string(tuned.machine) + ", at rest");
  }
}

}  // namespace
}  // namespace contour::test
