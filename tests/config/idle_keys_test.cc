#include "config/idle_keys.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "config/load_machine.h"
#include "tests/config/test_files.h"

namespace contour {
namespace {

/// The keys alone, of the example with these on top.
std::vector<std::string> Idle(const std::vector<std::string>& set) {
  const YamlValue tree = OpenMachineFile(ExampleMachine("single_axis.yaml"), set);
  std::vector<std::string> errors;
  YamlValue machine = tree;
  const MachineConfig config = ReadMachine(machine, errors);
  EXPECT_TRUE(errors.empty()) << errors.front();
  std::vector<std::string> keys;
  for (const std::string& sentence : IdleKeys(tree, config)) {
    const std::size_t from = sentence.find(": ") + 2;
    keys.push_back(sentence.substr(from, sentence.find(": ", from) - from));
  }
  return keys;
}

bool Holds(const std::vector<std::string>& keys, const std::string& key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

const std::vector<std::string> kStated{"control.full.contour_bandwidth_Hz=40",
                                       "control.full.lag_bandwidth_Hz=30",
                                       "estimator.bristle_noise_rel=0.005", "estimator.cogging_rate=0.1"};

std::vector<std::string> With(std::vector<std::string> more) {
  more.insert(more.begin(), kStated.begin(), kStated.end());
  return more;
}

std::string Mode(const char* mode) {
  const MachineConfig c = LoadMachine(ExampleMachine("single_axis.yaml"));
  return "axes." + c.axes.begin()->first + ".drive.mode=" + mode;
}

TEST(IdleKeys, OfTheLinearLawInTorqueModeAreThoseOfTheFilterAndTheMpc) {
  const std::vector<std::string> keys = Idle(With({Mode("cst"), "control.friction=linear"}));
  EXPECT_TRUE(Holds(keys, "control.full.contour_bandwidth_Hz"));
  EXPECT_TRUE(Holds(keys, "control.full.lag_bandwidth_Hz"));
  EXPECT_TRUE(Holds(keys, "estimator.bristle_noise_rel"));
  EXPECT_FALSE(Holds(keys, "estimator.cogging_rate")) << "both laws learn cogging";
}

TEST(IdleKeys, ByAScaleInTorqueModeTheMotorsMassIsLearnt) {
  YamlValue tree = OpenMachineFile(ExampleMachine("single_axis.yaml"), {});
  std::vector<std::string> errors;
  MachineConfig config = ReadMachine(tree, errors);
  config.control.friction = FrictionKind::kLinear;
  config.axes.begin()->second.drive.mode = DriveMode::kCst;
  const YamlValue stated = OpenMachineFile(ExampleMachine("single_axis.yaml"), {"estimator.mass_rate=0.1"});
  const auto told = [&] {
    const std::vector<std::string> sentences = IdleKeys(stated, config);
    return std::any_of(sentences.begin(), sentences.end(),
                       [](const std::string& s) { return s.find("mass_rate") != std::string::npos; });
  };
  config.axes.begin()->second.scale_loop.reset();
  EXPECT_TRUE(told());
  config.axes.begin()->second.scale_loop.emplace();
  EXPECT_FALSE(told());
}

TEST(IdleKeys, OfTheFilterInTorqueModeAreThoseOfTheOtherLoop) {
  const std::vector<std::string> keys = Idle(With({Mode("cst"), "control.friction=srukf"}));
  EXPECT_FALSE(Holds(keys, "control.full.contour_bandwidth_Hz"));
  EXPECT_FALSE(Holds(keys, "estimator.bristle_noise_rel"));
}

TEST(IdleKeys, WhereTheDriveClosesTheLoopNoBandwidthIsTheControllers) {
  for (const char* law : {"srukf", "linear"}) {
    const std::vector<std::string> keys = Idle(With({Mode("csp"), std::string("control.friction=") + law}));
    EXPECT_TRUE(Holds(keys, "control.full.contour_bandwidth_Hz")) << law;
    EXPECT_EQ(Holds(keys, "estimator.bristle_noise_rel"), std::string(law) == "linear");
  }
}

TEST(IdleKeys, AreOfFullAlone) {
  EXPECT_TRUE(Idle(With({Mode("cst"), "control.friction=linear", "machine.controller=mpc_srukf7"})).empty());
}

TEST(IdleKeys, SayWhereTheyStandAndWhy) {
  const YamlValue tree =
      OpenMachineFile(ExampleMachine("single_axis.yaml"),
                      {Mode("cst"), "control.friction=linear", "control.full.contour_bandwidth_Hz=40"});
  std::vector<std::string> errors;
  const std::vector<std::string> found = IdleKeys(tree, ReadMachine(tree, errors));
  const auto of = std::find_if(found.begin(), found.end(), [](const std::string& s) {
    return s.find("contour_bandwidth_Hz") != std::string::npos;
  });
  ASSERT_NE(of, found.end());
  EXPECT_EQ(*of,
            "--set control.full.contour_bandwidth_Hz=40: control.full.contour_bandwidth_Hz: no effect with "
            "control.friction: linear in torque mode; the loop is tuned by axes.<name>.loop");
}

}  // namespace
}  // namespace contour
