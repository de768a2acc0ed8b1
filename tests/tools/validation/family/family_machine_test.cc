#include "tools/validation/family/family_machine.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "config/config_error.h"

namespace contour {
namespace {

/// With or without a loop that keeps its limits.
MaybeEmulatedMachineFile Load(const FamilySetting& setting) {
  return LoadMaybeEmulatedMachine(std::string(FAMILY_DIR) + "/" + setting.machine + ".yaml",
                                  FamilyAssignments(FAMILY_DIR, setting));
}

TEST(FamilyMachine, TheNearModelIsOffByWhatItStates) {
  for (const std::string& name : FamilyMachines(FAMILY_DIR)) {
    const MaybeEmulatedMachineFile file = Load({name});
    EXPECT_EQ(file.emulator.parameter_variation_rel, 0.0);
    for (const auto& [axis, believed] : file.machine.axes) {
      const EmulatedAxisConfig& is = file.emulator.axes.at(axis);
      const MechanicsConfig& m = believed.model.mechanics;
      EXPECT_NEAR(m.screw_stiffness_N_um / is.screw_stiffness_N_um, 0.98, 1e-3) << name;
      EXPECT_NEAR(m.table_mass_kg / is.table_mass_kg, 1.05, 1e-3) << name;
      EXPECT_NEAR(m.motor_inertia_kgm2 / is.motor_inertia_kgm2, 1.05, 1e-3) << name;
      EXPECT_NEAR(believed.model.friction.Fc_plus_N / is.friction.Fc_plus_N, 0.8, 0.01) << name;
      EXPECT_NEAR(believed.model.friction.sigma0_N_m / is.friction.sigma0_N_m, 0.8, 0.01) << name;
    }
  }
}

TEST(FamilyMachine, TheCatalogueIsWrongWithinWhatItStatesAndNowhereRight) {
  for (const std::string& name : FamilyMachines(FAMILY_DIR)) {
    FamilySetting setting{name};
    setting.model = FamilyModel::kCatalogue;
    const MaybeEmulatedMachineFile file = Load(setting);
    EXPECT_GT(file.emulator.parameter_variation_rel, 0.0);
    const AxisConfig& believed = file.machine.axes.at("x");
    const EmulatedAxisConfig& is = file.emulator.axes.at("x");
    const auto expect_within = [&](double ratio, double most, const char* what) {
      EXPECT_LE(ratio, 1.01 * (1.0 + most)) << name << ' ' << what;
      EXPECT_GE(ratio, 0.99 / (1.0 + most)) << name << ' ' << what;
      EXPECT_NE(ratio, 1.0) << name << ' ' << what;
    };
    expect_within(believed.model.mechanics.screw_stiffness_N_um / is.screw_stiffness_N_um, 0.2, "K");
    expect_within(believed.model.mechanics.table_mass_kg / is.table_mass_kg, 0.1, "table");
    // One catalogue for both axes, whose levels differ by up to a tenth.
    const double level_N = 0.25 * (is.friction.Fc_plus_N + is.friction.Fc_minus_N +
                                   file.emulator.axes.at("y").friction.Fc_plus_N +
                                   file.emulator.axes.at("y").friction.Fc_minus_N);
    expect_within(believed.model.friction.Fc_plus_N / level_N, 0.5, "friction");
  }
}

TEST(FamilyMachine, RoughOnesHaveWhatTheirOwnNumbersSay) {
  FamilySetting setting{"m100"};
  setting.plant = FamilyPlant::kRough;
  const MaybeEmulatedMachineFile file = Load(setting);
  const EmulatedAxisConfig& axis = file.emulator.axes.at("x");
  EXPECT_EQ(axis.friction.motor_share_rel, 0.3);
  ASSERT_EQ(axis.side_modes.size(), 1U);
  EXPECT_NEAR(axis.side_modes[0].frequency_Hz, 0.55 * 141.5, 0.5);
  EXPECT_EQ(axis.side_modes[0].mass_share_rel, 0.12);
  EXPECT_EQ(axis.effects.input_delay->delay_us, 60.0);
  EXPECT_EQ(axis.effects.pitch_error->periods_per_stroke, 60.0);  // a period per turn of 10 mm
}

TEST(FamilyMachine, VariationsChangeTheMachineAndNotTheModel) {
  const MaybeEmulatedMachineFile before = Load({"t30"});
  for (const FamilyVariation& v : FamilyVariations()) {
    FamilySetting setting{"t30"};
    setting.variation = v.name;
    const MaybeEmulatedMachineFile after = Load(setting);
    const AxisConfig &is = after.machine.axes.at("y"), &was = before.machine.axes.at("y");
    EXPECT_EQ(is.model.mechanics.table_mass_kg, was.model.mechanics.table_mass_kg);
    EXPECT_EQ(is.model.mechanics.screw_stiffness_N_um, was.model.mechanics.screw_stiffness_N_um);
    const EmulatedAxisConfig &now = after.emulator.axes.at("y"), &then = before.emulator.axes.at("y");
    const bool changed = now.screw_stiffness_N_um != then.screw_stiffness_N_um ||
                         now.table_mass_kg != then.table_mass_kg || now.delay_cycles != then.delay_cycles ||
                         now.friction.Fc_plus_N != then.friction.Fc_plus_N ||
                         is.drive.encoder_counts_per_rev != was.drive.encoder_counts_per_rev;
    EXPECT_TRUE(changed) << v.name;
  }
  FamilySetting heavier{"t30"};
  heavier.variation = "table_plus_30";
  EXPECT_NEAR(Load(heavier).emulator.axes.at("x").table_mass_kg, 39.0, 1e-9);
}

TEST(FamilyMachine, NamesThatDoNotExistAreToldWithThoseThatDo) {
  FamilySetting setting{"t30"};
  setting.variation = "k_plus_31";
  try {
    FamilyAssignments(FAMILY_DIR, setting);
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("k_plus_30"), std::string::npos);
  }
  EXPECT_THROW(FamilyMachines("/nowhere"), ConfigError);
}

TEST(FamilyMachine, WindUpIsTheMeanFrictionOverTheStiffness) {
  EXPECT_NEAR(WindUp_m(Load({"base"}).emulator), 44.75 / 40e6, 1e-9);
  EXPECT_NEAR(WindUp_m(Load({"belt"}).emulator), 15.0 / 1e6, 0.2e-6);
}

}  // namespace
}  // namespace contour
