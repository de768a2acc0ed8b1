// The example machines: what they promise of each other and of model against emulated machine.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "config/yaml_tree.h"
#include "config/yaml_writer.h"
#include "core/mechanics.h"
#include "tests/config/test_files.h"
#include "tools/machine/load_emulated_machine.h"

namespace contour {
namespace {

// Relative distance of what is believed from what is.
double Off(double believed, double is) { return (believed - is) / is; }

void ExpectOff(double believed, double is, double at_least, const std::string& what) {
  EXPECT_GE(std::abs(Off(believed, is)), at_least - 1e-12) << what << ": " << believed << " against " << is;
  EXPECT_LE(std::abs(Off(believed, is)), 0.3) << what << " is too far off for an honest model";
}

double Inertia_kgm2(double lead_mm, double motor_inertia_kgm2, double table_mass_kg) {
  const double r = ScrewRadius_m_rad(lead_mm);
  return motor_inertia_kgm2 + r * r * table_mass_kg;
}

class Examples : public ::testing::TestWithParam<const char*> {};

TEST_P(Examples, ModelIsNoCopyOfTheEmulatedMachine) {
  const EmulatedMachineFile file = LoadEmulatedMachine(ExampleMachine(GetParam()));
  for (const auto& [name, axis] : file.machine.axes) {
    const EmulatedAxisConfig& is = file.emulator.axes.at(name);
    const FrictionConfig& f = axis.model.friction;
    ASSERT_EQ(f.acts_on, FrictionSide::kTable);
    ExpectOff(f.Fs_plus_N, is.friction.Fs_plus_N, 0.1, name + " Fs_plus_N");
    ExpectOff(f.Fs_minus_N, is.friction.Fs_minus_N, 0.1, name + " Fs_minus_N");
    ExpectOff(f.Fc_plus_N, is.friction.Fc_plus_N, 0.1, name + " Fc_plus_N");
    ExpectOff(f.Fc_minus_N, is.friction.Fc_minus_N, 0.1, name + " Fc_minus_N");
    ExpectOff(f.vs_mm_s, is.friction.vs_mm_s, 0.1, name + " vs_mm_s");
    ExpectOff(f.sigma0_N_m, is.friction.sigma0_N_m, 0.1, name + " sigma0_N_m");
    ExpectOff(f.sigma1_Ns_m, is.friction.sigma1_Ns_m, 0.1, name + " sigma1_Ns_m");
    ExpectOff(f.sigma1_decay_mm_s, is.friction.sigma1_decay_mm_s, 0.1, name + " sigma1_decay_mm_s");
    ExpectOff(f.sigma2_Ns_m, is.friction.sigma2_Ns_m, 0.1, name + " sigma2_Ns_m");
    const MechanicsConfig& m = axis.model.mechanics;
    ExpectOff(m.screw_stiffness_N_um, is.screw_stiffness_N_um, 0.1, name + " K");
    ExpectOff(Inertia_kgm2(m.lead_mm, m.motor_inertia_kgm2, m.table_mass_kg),
              Inertia_kgm2(is.lead_mm.value_or(m.lead_mm), is.motor_inertia_kgm2, is.table_mass_kg), 0.05,
              name + " J");
  }
}

TEST_P(Examples, SignsOfTheErrorsAreMixed) {
  const EmulatedMachineFile file = LoadEmulatedMachine(ExampleMachine(GetParam()));
  for (const auto& [name, axis] : file.machine.axes) {
    const EmulatedFrictionConfig& is = file.emulator.axes.at(name).friction;
    const FrictionConfig& f = axis.model.friction;
    EXPECT_LT(Off(f.Fs_plus_N, is.Fs_plus_N) * Off(f.Fs_minus_N, is.Fs_minus_N), 0.0) << name;
    EXPECT_LT(Off(f.Fc_plus_N, is.Fc_plus_N) * Off(f.Fc_minus_N, is.Fc_minus_N), 0.0) << name;
  }
}

// The nominal machine: an engineering estimate of a small table (docs/configuration.md).
TEST_P(Examples, EmulatedMachineIsTheNominalOne) {
  const EmulatorConfig e = LoadEmulatedMachine(ExampleMachine(GetParam())).emulator;
  for (const auto& [name, axis] : e.axes) {
    EXPECT_EQ(axis.motor_inertia_kgm2, 5e-5);
    EXPECT_EQ(axis.table_mass_kg, 10.0);
    EXPECT_EQ(axis.screw_stiffness_N_um, 40.0);
    EXPECT_EQ(axis.screw_damping_Ns_m, 1100.0);
    EXPECT_EQ(axis.encoder_noise_lsb, 0.3);
    const EmulatedFrictionConfig& f = axis.friction;
    EXPECT_EQ(f.law, EmulatedFrictionLaw::kLugre);
    EXPECT_EQ(f.stribeck_exponent, 1);
    EXPECT_EQ(f.Fs_plus_N, name == "x" ? 52.0 : 48.0);
    EXPECT_EQ(f.Fs_minus_N, name == "x" ? 47.0 : 53.0);
    EXPECT_EQ(f.Fc_plus_N, name == "x" ? 42.0 : 37.0);
    EXPECT_EQ(f.Fc_minus_N, name == "x" ? 36.0 : 43.0);
    EXPECT_EQ(f.vs_mm_s, 2.0);
    EXPECT_EQ(f.sigma0_N_m, 5e6);
    EXPECT_EQ(f.sigma1_Ns_m, 3000.0);
    EXPECT_EQ(f.sigma1_decay_mm_s, 2.0);
    EXPECT_EQ(f.sigma2_Ns_m, 500.0);
    EXPECT_EQ(f.position_amplitude_rel, 0.2);
    EXPECT_EQ(f.ripple_amplitude_rel, 0.08);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Examples,
                         ::testing::Values("xy_emulated.yaml", "xy_vcan.yaml", "single_axis.yaml"));

TEST(Examples, VcanDiffersFromLoopbackOnlyInTheBus) {
  EmulatedMachineFile loopback = LoadEmulatedMachine(ExampleMachine("xy_emulated.yaml"));
  const EmulatedMachineFile vcan = LoadEmulatedMachine(ExampleMachine("xy_vcan.yaml"));
  EXPECT_EQ(loopback.machine.buses.at("main").interface, "loopback");
  EXPECT_EQ(vcan.machine.buses.at("main").interface, "vcan0");
  EXPECT_EQ(WriteYaml(loopback.emulator), WriteYaml(vcan.emulator));
  loopback.machine.buses.at("main").interface = "vcan0";
  EXPECT_EQ(WriteYaml(loopback.machine), WriteYaml(vcan.machine));
}

}  // namespace
}  // namespace contour
