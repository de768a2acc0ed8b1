#include "config/load_machine.h"
#include "config/friction_choice.h"

#include <gtest/gtest.h>

#include <sys/stat.h>

#include <filesystem>
#include <string>
#include <vector>

#include "config/config_error.h"
#include "config/yaml_writer.h"
#include "tests/config/test_files.h"
#include "tools/machine/load_emulated_machine.h"

namespace contour {
namespace {

std::vector<std::string> Errors(const std::string& path, const std::vector<std::string>& overrides = {}) {
  try {
    LoadMachine(path, overrides);
  } catch (const ConfigError& e) {
    return e.messages();
  }
  return {};
}

TEST(LoadMachine, ReadsTheExample) {
  const MachineConfig c = LoadMachine(ExampleMachine("xy_emulated.yaml"));
  EXPECT_EQ(c.machine.name, "xy_table");
  EXPECT_EQ(c.machine.cycle_us, 1000);
  EXPECT_EQ(c.machine.controller, ControllerName::kFull);
  EXPECT_EQ(SendDeadline_ns(c), 200000);
  EXPECT_EQ(AxisNames(c), (std::vector<std::string>{"x", "y"}));
  EXPECT_EQ(BusIndex(c, "main"), 0U);
  EXPECT_EQ(c.axes.at("y").drive.node_id, 2);
  EXPECT_EQ(c.axes.at("x").drive.identity->vendor_id, 0xC0DU);
  EXPECT_EQ(c.axes.at("x").limits.position_mm[0], -200.0);
  EXPECT_EQ(c.axes.at("x").model.uncertainty.at("sigma0_N_m"), 0.2);
  EXPECT_EQ(c.io.modbus->port, 1502);
}

TEST(LoadMachine, AFileThatNeverEndsIsRefusedAtOnce) {
  const auto pipe = std::filesystem::path(testing::TempDir()) / "nobody_writes_here.yaml";
  std::filesystem::remove(pipe);
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& endless : {std::string("/dev/zero"), pipe.string()}) {
    EXPECT_EQ(Errors(endless),
              std::vector{endless + ": cannot be read: found a pipe or a device, expected a file"});
    const std::vector<std::string> named =
        Errors(ExampleMachine("xy_emulated.yaml"), {"axes.x.model=" + endless});
    ASSERT_EQ(named.size(), 1U);
    EXPECT_NE(named[0].find("expected a file"), std::string::npos) << named[0];
  }
  std::filesystem::remove(pipe);
  EXPECT_NE(Errors(testing::TempDir()).at(0).find("cannot be read: "), std::string::npos);
}

TEST(LoadMachine, DefaultSendDeadlineIsAFifthOfTheCycle) {
  MachineConfig c;
  c.machine.cycle_us = 2000;
  EXPECT_EQ(SendDeadline_ns(c), 400000);
}

TEST(LoadMachine, WrittenOutAndReadBackItIsTheSame) {
  for (const char* name : {"xy_emulated.yaml", "xy_vcan.yaml", "single_axis.yaml", "xyz_emulated.yaml"}) {
    const MachineConfig c = LoadMachine(
        ExampleMachine(name), {"axes.x.model.extensions={cogging: {amplitude_Nm: 0.1, order_per_rev: 12, "
                               "phase_rad: 1, further: [{amplitude_Nm: 0.05, order_per_rev: 24, phase_rad: "
                               "0}, {amplitude_Nm: 0.02, order_per_rev: 36, phase_rad: 2}]}, pitch_error: "
                               "{position_mm: [0, 1], error_um: [0.5, 2]}}"});
    const std::string written = WriteYaml(c);
    const MachineConfig again = LoadMachine(WriteTestFile(name, written));
    EXPECT_EQ(WriteYaml(again), written);
    EXPECT_NE(written.find("amplitude_Nm: 0.1"), std::string::npos);
    EXPECT_EQ(again.axes.at("x").model.friction.sigma0_N_m, c.axes.at("x").model.friction.sigma0_N_m);
  }
}

TEST(LoadMachine, NeverReadsTheEmulator) {
  const std::string good = ReadText(ExampleMachine("xy_emulated.yaml"));
  const std::string machine = WriteYaml(LoadMachine(ExampleMachine("xy_emulated.yaml")));
  const std::string without = good.substr(0, good.find("\nemulator:")) + "\n";
  EXPECT_EQ(WriteYaml(LoadMachine(WriteTestFile("without.yaml", without))), machine);
  for (const std::string section :
       {"emulator: 5\n", "emulator: [no, machine]\n", "emulator: {axes: {q: {mass: heavy}}}\n",
        "emulator:\n  seed: -3\n  axes: {x: {}, x: {}}\n"}) {
    const std::string path = WriteTestFile("garbage.yaml", without + section);
    EXPECT_EQ(WriteYaml(LoadMachine(path)), machine) << section;
    EXPECT_THROW(LoadEmulatedMachine(path), ConfigError) << section;
  }
  EXPECT_EQ(
      WriteYaml(LoadMachine(ExampleMachine("xy_emulated.yaml"), {"emulator.axes.x.table_mass_kg=1000"})),
      machine);
}

TEST(LoadMachine, ChecksRunAfterReadingAndNameTheLine) {
  const std::string text = Replaced(ReadText(ExampleMachine("single_axis.yaml")), "rated_torque_Nm: 0.637",
                                    "rated_torque_Nm: 6.37");
  const std::string path = WriteTestFile("m.yaml", text);
  const std::vector<std::string> errors = Errors(path);
  ASSERT_EQ(errors.size(), 1U) << ::testing::PrintToString(errors);
  const std::string line = std::to_string(
      std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find("peak_torque_Nm")),
                 '\n') +
      1);
  EXPECT_EQ(errors[0],
            path + ":" + line +
                ": axes.x.drive.peak_torque_Nm: found 1.91, expected at least rated_torque_Nm 6.37");
}

TEST(LoadMachine, OverrideIsNamedWhenItIsWhatFails) {
  const std::vector<std::string> errors = Errors(
      ExampleMachine("single_axis.yaml"), {"axes.x.limits.torque_Nm=2.5", "axes.x.limits.safe_travel_mm=50"});
  ASSERT_EQ(errors.size(), 1U) << ::testing::PrintToString(errors);
  EXPECT_EQ(errors[0],
            "--set axes.x.limits.torque_Nm=2.5: axes.x.limits.torque_Nm: found 2.5, more than the drive's "
            "peak_torque_Nm of "
            "1.91");
}

TEST(LoadModel, StandsAloneInAFile) {
  const ModelConfig model = LoadMachine(ExampleMachine("xy_emulated.yaml")).axes.at("y").model;
  const std::string keys = WriteYaml(model);
  EXPECT_EQ(WriteYaml(LoadModel(WriteTestFile("bare.yaml", keys))), keys);
  std::string indented = "model:\n";
  std::stringstream lines(keys);
  for (std::string line; std::getline(lines, line);) indented += "  " + line + "\n";
  EXPECT_EQ(WriteYaml(LoadModel(WriteTestFile("under_model.yaml", indented))), keys);
  EXPECT_THROW(LoadModel(WriteTestFile("wrong.yaml", keys + "colour: red\n")), ConfigError);
}

TEST(LoadMachine, AnAxisMayNameALoopFile) {
  const std::string keys =
      "regulator_Hz: 20\nwindup_weight: 0.4\nvelocity_weight: 0.2\ndisturbance_Hz: 200\nmotor_force_Hz: "
      "400\ntable_force_Hz: 400\nnotch_ratio: 0.8\nnotch_pole_damping: 0.7\nnotch_zero_damping: 0.3\n";
  const std::string file = WriteTestFile("loop.yaml", keys);
  const std::string machine =
      WriteTestFile("machine_with_loop.yaml", ReadText(ExampleMachine("single_axis.yaml")));
  const std::string name = file.substr(file.rfind('/') + 1);
  EXPECT_EQ(LoadMachine(machine, {"axes.x.loop=" + name}).axes.at("x").loop->regulator_Hz, 20.0);
  const std::vector<std::string> missing = Errors(machine, {"axes.x.loop=nowhere.yaml"});
  ASSERT_EQ(missing.size(), 1U);
  EXPECT_NE(missing[0].find("axes.x.loop: "), std::string::npos) << missing[0];
}

TEST(LoadModel, AxesWithoutABallScrewAreRefusedByName) {
  for (const char* text : {"mass_kg: 95\n", "model: {mass_kg: 95}\ndrive: {delay_ms: 1}\n",
                           "model: {motor_inertia_kgm2: 1e-4, lead_mm: 5}\n"}) {
    try {
      LoadModel(WriteTestFile("other.yaml", text));
      FAIL() << text;
    } catch (const ConfigError& e) {
      EXPECT_NE(std::string(e.what()).find("expected one with a ball screw"), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find("other.yaml:1"), std::string::npos) << e.what();
    }
  }
}

TEST(LoadModel, AMachineMayNameAModelFile) {
  const ModelConfig model = LoadMachine(ExampleMachine("single_axis.yaml")).axes.at("x").model;
  std::string keys = WriteYaml(model);
  keys = Replaced(keys, "lead_mm: 5", "lead_mm: 4");
  const std::string file = WriteTestFile("model.yaml", keys);
  const std::string name = file.substr(file.rfind('/') + 1);
  const std::string machine = WriteTestFile("machine.yaml", ReadText(ExampleMachine("single_axis.yaml")));
  EXPECT_EQ(LoadMachine(machine, {"axes.x.model=" + name}).axes.at("x").model.mechanics.lead_mm, 4.0);
  EXPECT_EQ(LoadMachine(machine, {"axes.x.model=" + name, "axes.x.model.lead_mm=4.5"})
                .axes.at("x")
                .model.mechanics.lead_mm,
            4.5);
  const std::vector<std::string> missing = Errors(machine, {"axes.x.model=nowhere.yaml"});
  ASSERT_EQ(missing.size(), 1U);
  EXPECT_NE(missing[0].find("nowhere.yaml: cannot be read: No such file or directory"), std::string::npos)
      << missing[0];
}

// As models are, wherever whoever reads it was started.
TEST(LoadMachine, ATableOfToolsIsBesideTheMachineFile) {
  const std::string machine = WriteTestFile("machine.yaml", ReadText(ExampleMachine("single_axis.yaml")));
  const std::string folder = machine.substr(0, machine.rfind('/'));
  EXPECT_EQ(LoadMachine(machine).machine.tool_table, "");
  EXPECT_EQ(LoadMachine(machine, {"machine.tool_table=tools.tbl"}).machine.tool_table, folder + "/tools.tbl");
  EXPECT_EQ(LoadMachine(machine, {"machine.tool_table=/a/tools.tbl"}).machine.tool_table, "/a/tools.tbl");
  EXPECT_EQ(LoadMachine(ReadSource(machine, {"machine.tool_table=tools.tbl"})).machine.tool_table,
            folder + "/tools.tbl");
}

TEST(LoadModel, MotorSideFriction) {
  const std::string model =
      "{lead_mm: 5, motor_inertia_kgm2: 5e-5, table_mass_kg: 10, screw_stiffness_N_um: 40, "
      "screw_damping_Ns_m: 1100,"
      " friction: {acts_on: motor, Fs_plus_Nm: 0.05, Fs_minus_Nm: 0.05, Fc_plus_Nm: 0.04, Fc_minus_Nm: 0.04, "
      "vs_rad_s: 2,"
      " sigma0_Nm_rad: 3, sigma2_Nms_rad: 3e-4}}";
  EXPECT_EQ(LoadModel(WriteTestFile("motor.yaml", model)).friction.Fc_plus_Nm, 0.04);
  try {
    LoadModel(WriteTestFile("mixed.yaml", Replaced(model, "Fc_plus_Nm", "Fc_plus_N")));
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_NE(
        std::string(e.what()).find("friction.Fc_plus_N: unknown key, wrong unit: expected Fc_plus_Nm, in Nm"),
        std::string::npos)
        << e.what();
  }
}

TEST(LoadEmulatedMachine, ReadsBothParts) {
  const EmulatedMachineFile file =
      LoadEmulatedMachine(ExampleMachine("xy_emulated.yaml"), {"emulator.seed=7"});
  EXPECT_EQ(file.emulator.seed, 7U);
  EXPECT_EQ(file.emulator.axes.at("y").friction.Fs_minus_N, 53.0);
  // What it is expected to follow by is added.
  MachineConfig machine = file.machine;
  EXPECT_GT(machine.machine.path_following_mm.value_or(0.0), 0.0);
  machine.machine.path_following_mm.reset();
  EXPECT_EQ(WriteYaml(machine), WriteYaml(LoadMachine(ExampleMachine("xy_emulated.yaml"))));
}

TEST(LoadEmulatedMachine, AxesMustMatch) {
  const auto errors = [](const std::vector<std::string>& overrides) {
    try {
      LoadEmulatedMachine(ExampleMachine("single_axis.yaml"), overrides);
    } catch (const ConfigError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(errors({}), "");
  EXPECT_NE(errors({"emulator.axes={}"}).find("emulator.axes.x: missing"), std::string::npos)
      << errors({"emulator.axes={}"});
  EXPECT_NE(errors({"emulator.axes.x.friction.sigma_0=3"}).find("expected sigma0_N_m, in N/m"),
            std::string::npos);
  EXPECT_NE(errors({"emulator.axes.x.friction.sigma9_N_m=3"}).find("did you mean sigma0_N_m?"),
            std::string::npos);
}

TEST(LoadEmulatedMachine, NeedsTheSection) {
  const std::string good = ReadText(ExampleMachine("single_axis.yaml"));
  const std::string path = WriteTestFile("m.yaml", good.substr(0, good.find("\nemulator:")) + "\n");
  EXPECT_THROW(LoadEmulatedMachine(path), ConfigError);
  EXPECT_FALSE(LoadMaybeEmulatedMachine(path).has_emulator);
}

// An example with some things changed, and loops that anything may have.
MachineConfig Changed(std::vector<std::string> set) {
  set.insert(set.end(), {"axes.x.limits.safe_travel_mm=4", "axes.y.limits.safe_travel_mm=4"});
  for (const char* axis : {"x", "y"})
    set.push_back(std::string("axes.") + axis +
                  ".loop_limits={peak_as_stated: 10, peak_far_off: 10, peak_late: 10}");
  return LoadMachine(std::string(SOURCE_DIR) + "/config/xy_emulated.yaml", set);
}

const std::string kCspX = "axes.x.drive.mode=csp", kCspY = "axes.y.drive.mode=csp";
const std::string kCoarse = "axes.x.drive.encoder_counts_per_rev=10000";
const std::string kHeavy = "axes.x.model.table_mass_kg=30", kSoft = "axes.x.model.screw_stiffness_N_um=4";
// One step of the torque, 0.8 N, moves the bristles by 0.53 um, where friction winds the screw up by 0.87.
const std::string kBristle = "axes.x.model.friction.sigma0_N_m=1.5e6";
// Only what knows the table has a use for its scale.
const std::vector<std::string> kScale{kCspX, kCspY, "axes.x.drive.linear_scale={counts_per_mm: 200000}",
                                      "realtime.send_deadline_us=70"};

TEST(LoadMachine, FrictionIsKnownByWhatTheModeAllowsUnlessTheFileSays) {
  const auto friction = [](std::vector<std::string> set) { return Changed(std::move(set)).control.friction; };
  EXPECT_EQ(friction({}), FrictionKind::kLinear);
  EXPECT_EQ(friction({"control.friction=srukf"}), FrictionKind::kSrukf);
  EXPECT_EQ(friction({kHeavy, "control.friction=srukf"}), FrictionKind::kSrukf);
  EXPECT_EQ(friction({kCspX, kCspY}), FrictionKind::kSrukf);
  EXPECT_EQ(friction({kHeavy, kCspX, kCspY}), FrictionKind::kSrukf);
  EXPECT_EQ(friction({kBristle, kCspX, kCspY}), FrictionKind::kSrukf);
  EXPECT_EQ(friction({kSoft, kCspX, kCspY}), FrictionKind::kLinear) << "100 Hz";
  EXPECT_EQ(friction(kScale), FrictionKind::kLinear);
  EXPECT_EQ(friction({"control.friction=linear", kCspX, kCspY}), FrictionKind::kLinear);
  EXPECT_EQ(friction({kCoarse, kCspX, kCspY}), FrictionKind::kLinear) << "500 nm";
  EXPECT_EQ(friction({"axes.x.drive.encoder_counts_per_rev=131072", kCspX, kCspY}), FrictionKind::kSrukf);
}

TEST(LoadMachine, TheFilterServesWhereOneRigidMassIsEnough) {
  const auto serves = [](std::vector<std::string> set) { return FilterServes(Changed(std::move(set))); };
  EXPECT_TRUE(serves({})) << "326 Hz";
  EXPECT_FALSE(serves({kHeavy})) << "216 Hz";
  EXPECT_TRUE(serves({kHeavy, kCspX, kCspY}));
  EXPECT_FALSE(serves({kBristle}));
  EXPECT_TRUE(serves({kBristle, kCspX, kCspY}));
  EXPECT_FALSE(serves({kSoft, kCspX, kCspY}));
  EXPECT_FALSE(serves(kScale));
  EXPECT_FALSE(serves({kCoarse, kCspX, kCspY}));
  EXPECT_TRUE(serves({kCoarse})) << "in torque mode it is known what a drive gives";
}

}  // namespace
}  // namespace contour
